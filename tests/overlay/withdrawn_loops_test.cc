// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Withdrawn loops (common/withdrawn_loops.h) in the optimizations of the run
// that withdrew them, after saving and loading, and without the swap.
#include "cartographer_ext/common/withdrawn_loops.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/optimization/dropin/taken_back_loops.h"
#include "cartographer_ext/optimization/selection/switched_loops.h"
#include "cartographer_ext/swaps.h"
#include "gtest/gtest.h"

#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
namespace cartographer_ext {
namespace overlay {
namespace {

namespace mapping = cartographer::mapping;
namespace transform = cartographer::transform;
using mapping::NodeId;
using mapping::PoseGraphInterface;
using mapping::SubmapId;
using transform::Rigid2d;
using Constraint = PoseGraphInterface::Constraint;
using ConstraintProto = mapping::proto::PoseGraph::Constraint;

constexpr int kNodes = 60;
constexpr int kNodesPerSubmap = 10;
constexpr char kRobust[] =
    "POSE_GRAPH.optimization_problem.cartographer_ext = {}";
constexpr char kStock[] = "";

// The wrong loop: node 45 seen in submap 0 at a place 30 m from where it is.
constexpr int kWrongNode = 45;
// Poses that the wrong loop moves differ by more, metres.
constexpr double kVisible = 0.05;

mapping::proto::MapBuilderOptions Options(const std::string& lines) {
  cartographer::common::LuaParameterDictionary dictionary(
      "include 'common_2d.lua'\n" + lines + "\nreturn MAP_BUILDER",
      absl::make_unique<cartographer::common::ConfigurationFileResolver>(
          std::vector<std::string>{"configuration_files"}));
  return mapping::CreateMapBuilderOptions(&dictionary);
}

transform::proto::Rigid3d ToRigid3Proto(const Rigid2d& pose) {
  return transform::ToProto(transform::Embed3D(pose));
}

// One node a metre on a straight line.
Rigid2d NodePose(const int node) { return Rigid2d({1. * node, 0.}, 0.); }
Rigid2d SubmapPose(const int submap) {
  return NodePose(kNodesPerSubmap * submap);
}

void AddConstraint(const int submap, const int node, const Rigid2d& relative,
                   const bool is_loop, const double weight,
                   mapping::proto::PoseGraph* const pose_graph) {
  auto* const constraint = pose_graph->add_constraint();
  constraint->mutable_submap_id()->set_submap_index(submap);
  constraint->mutable_node_id()->set_node_index(node);
  *constraint->mutable_relative_pose() = ToRigid3Proto(relative);
  constraint->set_translation_weight(weight);
  constraint->set_rotation_weight(weight);
  constraint->set_tag(is_loop ? ConstraintProto::INTER_SUBMAP
                              : ConstraintProto::INTRA_SUBMAP);
}

enum class WrongLoop { kAbsent, kInForce, kWithdrawn };

io::Pbstream MakeMap(const WrongLoop wrong_loop) {
  io::Pbstream map;
  map.header.set_format_version(2);
  map.options.add_options_with_sensor_ids()
      ->mutable_trajectory_builder_options();
  auto* const trajectory = map.pose_graph.add_trajectory();
  for (int i = 0; i != kNodes; ++i) {
    const int64_t time = 10000000LL * (i + 1);
    if (i % kNodesPerSubmap == 0) {
      const int index = i / kNodesPerSubmap;
      auto* const submap = trajectory->add_submap();
      submap->set_submap_index(index);
      *submap->mutable_pose() = ToRigid3Proto(SubmapPose(index));
      map.submaps.emplace_back();
      map.submaps.back().mutable_submap_id()->set_submap_index(index);
      auto* const data = map.submaps.back().mutable_submap_2d();
      *data->mutable_local_pose() = ToRigid3Proto(SubmapPose(index));
      data->set_finished(true);
      auto* const grid = data->mutable_grid();
      grid->mutable_limits()->set_resolution(0.05);
      grid->mutable_limits()->mutable_cell_limits()->set_num_x_cells(2);
      grid->mutable_limits()->mutable_cell_limits()->set_num_y_cells(2);
      for (int cell = 0; cell != 4; ++cell) grid->add_cells(0);
      grid->mutable_probability_grid_2d();
      grid->set_min_correspondence_cost(0.1f);
      grid->set_max_correspondence_cost(0.9f);
    }
    auto* const node = trajectory->add_node();
    node->set_node_index(i);
    node->set_timestamp(time);
    *node->mutable_pose() = ToRigid3Proto(NodePose(i));
    map.nodes.emplace_back();
    map.nodes.back().mutable_node_id()->set_node_index(i);
    auto* const data = map.nodes.back().mutable_node_data();
    data->set_timestamp(time);
    data->mutable_gravity_alignment()->set_w(1.);
    *data->mutable_local_pose() = ToRigid3Proto(NodePose(i));
  }
  for (int i = 0; i != kNodes; ++i) {
    for (const int submap : {i / kNodesPerSubmap - 1, i / kNodesPerSubmap}) {
      if (submap < 0) continue;
      AddConstraint(submap, i, SubmapPose(submap).inverse() * NodePose(i),
                    false, 500., &map.pose_graph);
    }
  }
  // A right loop, a bit off.
  AddConstraint(0, 30, Rigid2d({30.1, 0.1}, 0.), true, 1e3, &map.pose_graph);
  const Rigid2d wrong({15., 2.}, 1.);
  if (wrong_loop != WrongLoop::kAbsent) {
    AddConstraint(0, kWrongNode, wrong, true, 1.1e4, &map.pose_graph);
  }
  if (wrong_loop == WrongLoop::kWithdrawn) {
    AddConstraint(0, kWrongNode, wrong, true, 0., &map.pose_graph);
  }
  return map;
}

std::string Write(const io::Pbstream& map, const std::string& name) {
  const std::string filename = ::testing::TempDir() + name;
  EXPECT_TRUE(io::WritePbstream(map, filename).ok());
  return filename;
}

std::vector<Rigid2d> PosesOf(const PoseGraphInterface& pose_graph) {
  std::vector<Rigid2d> poses;
  for (const auto& node : pose_graph.GetTrajectoryNodePoses()) {
    poses.push_back(transform::Project2D(node.data.global_pose));
  }
  return poses;
}

struct Optimized {
  std::vector<Rigid2d> poses;
  int64_t loops = 0;  // that the robust selection saw
};

// Loads the state, optimizes, and saves it under `saved` unless that is empty.
Optimized LoadAndOptimize(const std::string& filename, const std::string& lines,
                          const std::string& saved = "") {
  const auto context = std::make_shared<PoseGraphContext>();
  const ScopedPoseGraphContext scope(context);
  const auto map_builder = mapping::CreateMapBuilder(Options(lines));
  map_builder->LoadStateFromFile(filename, false /* frozen */);
  map_builder->pose_graph()->RunFinalOptimization();
  if (!saved.empty()) {
    EXPECT_TRUE(map_builder->SerializeStateToFile(true, saved));
  }
  Optimized result;
  result.poses = PosesOf(*map_builder->pose_graph());
  result.loops =
      context->Get<optimization::SwitchedLoopRecorder>()->Get().loops;
  return result;
}

double LargestDifference(const std::vector<Rigid2d>& a,
                         const std::vector<Rigid2d>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.;
  for (size_t i = 0; i != std::min(a.size(), b.size()); ++i) {
    largest =
        std::max(largest, (a[i].translation() - b[i].translation()).norm());
  }
  return largest;
}

// The result of the stock problem with the constraints as they are stored: a
// program without the swap.
std::vector<Rigid2d> OptimizeWithoutSwap(const io::Pbstream& map) {
  mapping::optimization::StockOptimizationProblem2D problem(
      Options(kStock).pose_graph_options().optimization_problem_options());
  for (int i = 0; i != kNodes / kNodesPerSubmap; ++i) {
    problem.InsertSubmap(SubmapId(0, i), SubmapPose(i));
  }
  for (int i = 0; i != kNodes; ++i) {
    mapping::optimization::NodeSpec2D spec;
    spec.time = cartographer::common::FromUniversal(10000000LL * (i + 1));
    spec.local_pose_2d = NodePose(i);
    spec.global_pose_2d = NodePose(i);
    spec.gravity_alignment = Eigen::Quaterniond::Identity();
    problem.InsertTrajectoryNode(NodeId(0, i), spec);
  }
  problem.Solve(mapping::FromProto(map.pose_graph.constraint()),
                {{0, PoseGraphInterface::TrajectoryState::ACTIVE}}, {});
  std::vector<Rigid2d> poses;
  for (const auto& node : problem.node_data()) {
    poses.push_back(node.data.global_pose_2d);
  }
  return poses;
}

class WithdrawnLoopsSwapTest : public testing::TestWithParam<const char*> {};

TEST_P(WithdrawnLoopsSwapTest, HaveNoEffectEvenAfterSavingAndLoading) {
  const std::string absent =
      Write(MakeMap(WrongLoop::kAbsent), "loop_absent.pbstream");
  const std::string withdrawn =
      Write(MakeMap(WrongLoop::kWithdrawn), "loop_withdrawn.pbstream");
  const std::string saved = ::testing::TempDir() + "loop_saved.pbstream";
  const Optimized expected = LoadAndOptimize(absent, GetParam());
  const Optimized once = LoadAndOptimize(withdrawn, GetParam(), saved);
  EXPECT_EQ(LargestDifference(once.poses, expected.poses), 0.);
  EXPECT_EQ(once.loops, expected.loops);
  // The host saved the loop and its mark; loaded again, neither acts.
  const Optimized twice = LoadAndOptimize(saved, GetParam());
  const Optimized expected_twice = LoadAndOptimize(
      Write(*io::ReadPbstream(saved), "loop_removed.pbstream"), GetParam());
  EXPECT_EQ(LargestDifference(twice.poses, expected_twice.poses), 0.);
  EXPECT_LT(LargestDifference(twice.poses, expected.poses), 1e-3);
  EXPECT_EQ(twice.loops, expected.loops);
}

INSTANTIATE_TEST_SUITE_P(StockAndRobust, WithdrawnLoopsSwapTest,
                         testing::Values(kStock, kRobust));

TEST(WithdrawnLoopsTest, TheLoopWouldActWithoutItsMark) {
  EXPECT_GT(LargestDifference(
                LoadAndOptimize(
                    Write(MakeMap(WrongLoop::kInForce), "in.pbstream"), kStock)
                    .poses,
                LoadAndOptimize(
                    Write(MakeMap(WrongLoop::kAbsent), "no.pbstream"), kStock)
                    .poses),
            kVisible);
}

TEST(WithdrawnLoopsTest, WithoutTheSwapTheyActUntilOurToolsWriteTheState) {
  const auto expected = OptimizeWithoutSwap(MakeMap(WrongLoop::kAbsent));
  const auto in_force = OptimizeWithoutSwap(MakeMap(WrongLoop::kInForce));
  EXPECT_GT(LargestDifference(in_force, expected), kVisible);
  // The stock problem is not disturbed by the mark, but does not heed it.
  const io::Pbstream withdrawn = MakeMap(WrongLoop::kWithdrawn);
  EXPECT_LT(LargestDifference(OptimizeWithoutSwap(withdrawn), in_force), 1e-6);
  const auto written =
      io::ReadPbstream(Write(withdrawn, "loop_withdrawn.pbstream"));
  ASSERT_TRUE(written.ok()) << written.status();
  EXPECT_EQ(written->num_withdrawn_constraints, 2);
  EXPECT_EQ(LargestDifference(OptimizeWithoutSwap(*written), expected), 0.);
}

TEST(WithdrawnLoopsTest, LoopsTakenBackAreMarkedInThePoseGraph) {
  const auto context = std::make_shared<PoseGraphContext>();
  const ScopedPoseGraphContext scope(context);
  const auto map_builder = mapping::CreateMapBuilder(Options(kStock));
  map_builder->LoadStateFromFile(
      Write(MakeMap(WrongLoop::kInForce), "in.pbstream"), false);
  map_builder->pose_graph()->RunFinalOptimization();  // once it is loaded
  LoopId loop;
  loop.node_index = kWrongNode;
  optimization::MarkTakenBack({}, map_builder->pose_graph());
  optimization::MarkTakenBack({loop}, map_builder->pose_graph());
  auto constraints = map_builder->pose_graph()->constraints();
  RemoveWithdrawnLoops(&constraints);
  size_t loops = 0;
  for (const Constraint& constraint : constraints) {
    if (constraint.tag != Constraint::INTER_SUBMAP) continue;
    ++loops;
    EXPECT_NE(constraint.node_id.node_index, kWrongNode);
  }
  EXPECT_EQ(loops, 1u);
  const std::string saved = ::testing::TempDir() + "loop_taken_back.pbstream";
  EXPECT_TRUE(map_builder->SerializeStateToFile(true, saved));
  const auto written = io::ReadPbstream(saved);
  ASSERT_TRUE(written.ok()) << written.status();
  EXPECT_EQ(written->num_withdrawn_constraints, 2);
}

TEST(WithdrawnLoopsTest, TheContextWithdrawsWithoutAMark) {
  const auto options =
      Options(kStock).pose_graph_options().optimization_problem_options();
  const auto solve = [&options](const bool with_loop, const bool withdraw) {
    const auto context = std::make_shared<PoseGraphContext>();
    const ScopedPoseGraphContext scope(context);
    mapping::optimization::OptimizationProblem2D problem(options);
    problem.AddSubmap(0, Rigid2d::Identity());
    mapping::optimization::NodeSpec2D spec;
    spec.time = cartographer::common::FromUniversal(1);
    spec.global_pose_2d = Rigid2d({0.5, 0.5}, 0.);
    spec.gravity_alignment = Eigen::Quaterniond::Identity();
    problem.AddTrajectoryNode(0, spec);
    const SubmapId submap(0, 0);
    const NodeId node(0, 0);
    std::vector<Constraint> constraints = {
        Constraint{submap,
                   node,
                   {transform::Embed3D(Rigid2d({1., 0.}, 0.)), 10., 10.},
                   Constraint::INTRA_SUBMAP}};
    if (with_loop) {
      constraints.push_back(
          Constraint{submap,
                     node,
                     {transform::Embed3D(Rigid2d::Identity()), 20., 20.},
                     Constraint::INTER_SUBMAP});
    }
    if (withdraw) {
      context->Get<WithdrawnLoops>()->Add(MakeLoopId(submap, node));
    }
    problem.Solve(constraints,
                  {{0, PoseGraphInterface::TrajectoryState::ACTIVE}}, {});
    return problem.node_data().at(node).global_pose_2d.translation();
  };
  EXPECT_GT((solve(true, false) - solve(false, false)).norm(), 0.1);
  EXPECT_EQ((solve(true, true) - solve(false, false)).norm(), 0.);
}

}  // namespace
}  // namespace overlay
}  // namespace cartographer_ext
#endif  // CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
