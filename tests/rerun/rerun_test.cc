// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/rerun.h"

#include <string>

#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/rerun/loop_comparison.h"
#include "cartographer_ext/rerun/rerun_configuration.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/slam/room_map.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::PoseGraphOptions;

class RerunTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    pbstream_ = new io::Pbstream(
        test::MakeRoomMap(testing::TempDir() + "/rerun_test.pbstream"));
    graph_ = new MapGraph(MakeMapGraph(*pbstream_));
  }
  static void TearDownTestSuite() {
    delete pbstream_;
    delete graph_;
  }
  static PoseGraphOptions Options() {
    return test::RoomConfiguration().map_builder_options.pose_graph_options();
  }

  static io::Pbstream* pbstream_;
  static MapGraph* graph_;
};

io::Pbstream* RerunTest::pbstream_ = nullptr;
MapGraph* RerunTest::graph_ = nullptr;

TEST_F(RerunTest, FindsTheStoredLoopsAgain) {
  ASSERT_GT(graph_->num_loops(), 10);
  const auto rerun = RerunPoseGraph(*pbstream_, Options(), {});
  ASSERT_TRUE(rerun.ok()) << rerun.status();
  EXPECT_EQ(rerun->nodes, graph_->nodes.size());
  EXPECT_EQ(rerun->graph.nodes.size(), graph_->nodes.size());
  EXPECT_EQ(rerun->graph.submaps.size(), graph_->submaps.size());
  const LoopComparison comparison = CompareLoops(*graph_, rerun->graph, {});
  EXPECT_GT(comparison.fraction_of_first, 0.95);
  EXPECT_GT(comparison.fraction_of_second, 0.95);
  // Where two places in the room match equally well, rounding decides.
  EXPECT_GT(comparison.common_same_pose, 0.9 * comparison.common);
  EXPECT_EQ(rerun->matches, rerun->graph.num_loops());
  EXPECT_GE(rerun->searches, rerun->matches);
  EXPECT_GT(rerun->cpu_seconds, 0.);
#ifdef CARTOGRAPHER_EXT_HOST_TELLS_SEARCH_CPU
  EXPECT_GT(rerun->loop_cpu.search, 0.);
#else
  EXPECT_EQ(rerun->loop_cpu.search, 0.);
#endif
  EXPECT_TRUE(rerun->decisions.empty());
  for (const auto& node : graph_->nodes) {
    const Pose2 difference = Between(
        node.second.global_pose, rerun->graph.nodes.at(node.first).global_pose);
    ASSERT_LT(difference.translation().norm(), 0.05);
  }
}

TEST_F(RerunTest, NeverTiesANodeToItsOwnSubmap) {
  const auto rerun = RerunPoseGraph(*pbstream_, Options(), {});
  ASSERT_TRUE(rerun.ok()) << rerun.status();
  const auto inserted = graph_->InsertedNodes();
  for (const GraphConstraint& constraint : rerun->graph.constraints) {
    if (!constraint.is_loop) continue;
    EXPECT_THAT(inserted.at(constraint.submap_id),
                testing::Not(testing::Contains(constraint.node_id)));
  }
}

TEST_F(RerunTest, SameForAnyNumberOfThreads) {
  RerunOptions one, three;
  one.num_background_threads = 1;
  three.num_background_threads = 3;
  const auto first = RerunPoseGraph(*pbstream_, Options(), one);
  const auto second = RerunPoseGraph(*pbstream_, Options(), three);
  ASSERT_TRUE(first.ok() && second.ok());
  ASSERT_EQ(first->graph.constraints.size(), second->graph.constraints.size());
  for (const auto& node : first->graph.nodes) {
    const Pose2& other = second->graph.nodes.at(node.first).global_pose;
    ASSERT_EQ(node.second.global_pose.x, other.x);
    ASSERT_EQ(node.second.global_pose.theta, other.theta);
  }
}

TEST_F(RerunTest, StricterThresholdFindsFewerLoops) {
  PoseGraphOptions options = Options();
  options.mutable_constraint_builder_options()->set_min_score(0.99);
  int64_t fed = 0;
  RerunOptions rerun_options;
  rerun_options.on_progress = [&](const int64_t nodes, const int64_t total) {
    fed = nodes;
    EXPECT_EQ(total, graph_->nodes.size());
  };
  const auto rerun = RerunPoseGraph(*pbstream_, options, rerun_options);
  ASSERT_TRUE(rerun.ok()) << rerun.status();
  EXPECT_EQ(fed, graph_->nodes.size());
  EXPECT_LT(rerun->graph.num_loops(), graph_->num_loops());
  EXPECT_GT(rerun->searches, rerun->matches);
}

TEST_F(RerunTest, StoredPosesPlayNoPart) {
  io::Pbstream moved = *pbstream_;
  for (auto& trajectory : *moved.pose_graph.mutable_trajectory()) {
    for (auto& node : *trajectory.mutable_node()) {
      node.mutable_pose()->mutable_translation()->set_x(77.);
    }
    for (auto& submap : *trajectory.mutable_submap()) {
      submap.mutable_pose()->mutable_translation()->set_y(-55.);
    }
  }
  const auto rerun = RerunPoseGraph(*pbstream_, Options(), {});
  const auto other = RerunPoseGraph(moved, Options(), {});
  ASSERT_TRUE(rerun.ok() && other.ok());
  EXPECT_EQ(rerun->graph.nodes.rbegin()->second.global_pose.x,
            other->graph.nodes.rbegin()->second.global_pose.x);
}

TEST_F(RerunTest, UnfinishedSubmapsMayBeMissing) {
  io::Pbstream cut = *pbstream_;
  int removed = 0;
  for (auto it = cut.submaps.begin(); it != cut.submaps.end();) {
    if (it->submap_2d().finished()) {
      ++it;
      continue;
    }
    it = cut.submaps.erase(it);
    ++removed;
  }
  ASSERT_GT(removed, 0);
  auto* const constraints = cut.pose_graph.mutable_constraint();
  const auto known = MakeMapGraph(cut).submaps;
  for (int i = constraints->size() - 1; i >= 0; --i) {
    const auto& id = constraints->Get(i).submap_id();
    if (known.count({id.trajectory_id(), id.submap_index()}) == 0) {
      constraints->DeleteSubrange(i, 1);
    }
  }
  const auto rerun = RerunPoseGraph(cut, Options(), {});
  ASSERT_TRUE(rerun.ok()) << rerun.status();
  EXPECT_EQ(rerun->placeholders, removed);
  EXPECT_GT(CompareLoops(*graph_, rerun->graph, {}).fraction_of_first, 0.95);
}

TEST(RerunSharedDataTest, FindsTheLoopsOfARealMapAgain) {
  // Made with stock's defaults, as it turns out.
  const std::string filename = test::SharedData("pbstream/legndy-map.pbstream");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(filename);
  const auto pbstream = io::ReadPbstream(filename);
  ASSERT_TRUE(pbstream.ok()) << pbstream.status();
  const MapGraph graph = MakeMapGraph(*pbstream);
  const auto configuration =
      LoadRerunConfiguration({"configuration_files"}, "", "", graph);
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  const auto rerun = RerunPoseGraph(*pbstream, configuration->stock, {});
  ASSERT_TRUE(rerun.ok()) << rerun.status();
  const LoopComparison comparison = CompareLoops(graph, rerun->graph, {});
  EXPECT_GT(comparison.fraction_of_first, 0.9);
  EXPECT_GT(comparison.fraction_of_second, 0.9);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
