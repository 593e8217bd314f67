// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A square that is walked twice, for tests of OptimizationProblem2D.
#ifndef TESTS_HOST_SQUARE_WALK_H_
#define TESTS_HOST_SQUARE_WALK_H_

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/optimization/selection/switched_loops.h"
#include "cartographer_ext/uncertainty/loop_ambiguity.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace optimization {

// A square of 10 m walked twice. Local SLAM turns a little too far at every
// step. A submap begins every ten nodes at its first node and holds twenty.
class SquareWalkTest : public ::testing::Test {
 protected:
  using Constraint = PoseGraphInterface::Constraint;
  using TrajectoryState = PoseGraphInterface::TrajectoryState;
  using Rigid2d = transform::Rigid2d;
  using PoseGraphContext = cartographer_ext::PoseGraphContext;
  using SwitchedLoops = cartographer_ext::optimization::SwitchedLoops;

  static constexpr int kNodes = 80;
  static constexpr int kNodesPerSubmap = 10;
  // Of the square, one node a metre.
  static constexpr int kNodesPerRound = 40;

  SquareWalkTest() {
    Rigid2d truth, local;
    for (int i = 0; i != kNodes; ++i) {
      truth_.push_back(truth);
      local_.push_back(local);
      const double turn = i % 10 == 9 ? M_PI / 2. : 0.;
      truth = truth * Rigid2d({1., 0.}, turn);
      local = local * Rigid2d({1., 0.}, turn + 0.001);
    }
    for (int i = 0; i != kNodes; ++i) {
      for (int submap = i / kNodesPerSubmap - 1; submap <= i / kNodesPerSubmap;
           ++submap) {
        if (submap < 0) continue;
        constraints_.push_back(MakeConstraint(
            submap, i, Origin(local_, submap).inverse() * local_[i],
            Constraint::INTRA_SUBMAP));
      }
    }
  }

  static Rigid2d Origin(const std::vector<Rigid2d>& poses, const int submap) {
    return Rigid2d::Translation(poses[submap * kNodesPerSubmap].translation());
  }

  static Constraint MakeConstraint(const int submap, const int node,
                                   const Rigid2d& pose,
                                   const Constraint::Tag tag) {
    const bool is_loop = tag == Constraint::INTER_SUBMAP;
    return Constraint{
        SubmapId{0, submap}, NodeId{0, node},
        Constraint::Pose{transform::Embed3D(pose), is_loop ? 1.1e4 : 500.,
                         is_loop ? 1e5 : 1600.},
        tag};
  }

  // The node of the second round is where the submap of the first is.
  Constraint RightLoop(const int submap, const int node) const {
    return MakeConstraint(submap, node,
                          Origin(truth_, submap).inverse() * truth_[node],
                          Constraint::INTER_SUBMAP);
  }

  static OptimizationProblem2D MakeProblem(const std::string& block) {
    return OptimizationProblem2D(test::LoadSlamOptions(block)
                                     .map_builder.pose_graph_options()
                                     .optimization_problem_options());
  }

  void Fill(OptimizationProblem2D* const problem, const int first = 0,
            const int end = kNodes) const {
    for (int i = first; i != end; ++i) {
      // Continues from the optimised pose of the node before.
      Rigid2d global = local_[i];
      if (i > 0) {
        global = problem->node_data().at(NodeId{0, i - 1}).global_pose_2d *
                 local_[i - 1].inverse() * local_[i];
      }
      problem->AddTrajectoryNode(0, NodeSpec2D{test::At(i), local_[i], global,
                                               Eigen::Quaterniond::Identity()});
      if (i % kNodesPerSubmap == 0) {
        problem->AddSubmap(0, global * local_[i].inverse() *
                                  Origin(local_, i / kNodesPerSubmap));
      }
    }
  }

  std::vector<Constraint> With(const std::vector<Constraint>& loops) const {
    std::vector<Constraint> result = constraints_;
    result.insert(result.end(), loops.begin(), loops.end());
    return result;
  }

  // Of the first nodes, without loops.
  std::vector<Constraint> ConstraintsOf(const int num_nodes) const {
    std::vector<Constraint> result;
    for (const Constraint& constraint : constraints_) {
      if (constraint.node_id.node_index < num_nodes) {
        result.push_back(constraint);
      }
    }
    return result;
  }

  std::vector<Constraint> UpTo(const int num_nodes) const {
    std::vector<Constraint> result = ConstraintsOf(num_nodes);
    for (const Constraint& loop : RightLoops()) {
      if (loop.node_id.node_index < num_nodes) result.push_back(loop);
    }
    return result;
  }

  // How far the poses of the first nodes, as at the start of the run, moved.
  static double Moved(const MapById<NodeId, NodeSpec2D>& before,
                      const OptimizationProblem2D& problem,
                      const int num_nodes) {
    double result = 0.;
    for (int i = 0; i != num_nodes; ++i) {
      const NodeId id(0, i);
      result = std::max(
          result, (before.at(id).global_pose_2d.translation() -
                   problem.node_data().at(id).global_pose_2d.translation())
                      .norm());
    }
    return result;
  }

  std::vector<Constraint> RightLoops() const {
    std::vector<Constraint> result;
    for (int node = kNodesPerRound + 2; node < kNodes; node += 5) {
      result.push_back(
          RightLoop((node - kNodesPerRound) / kNodesPerSubmap, node));
    }
    return result;
  }

  // Four of every node of the second round.
  std::vector<Constraint> AllRightLoops() const {
    std::vector<Constraint> result;
    for (int node = kNodesPerRound; node < kNodes; ++node) {
      result.insert(result.end(), 4,
                    RightLoop((node - kNodesPerRound) / kNodesPerSubmap, node));
    }
    return result;
  }

  // The wheels slip: for local SLAM the robot advanced by a metre less. Submaps
  // hold their nodes as if there were sixteen times as many of these.
  void SlipBefore(const int node) {
    const Rigid2d slipped = local_[node - 1] * Rigid2d::Translation({-1., 0.}) *
                            local_[node - 1].inverse();
    for (int i = node; i != kNodes; ++i) local_[i] = slipped * local_[i];
    for (Constraint& constraint : constraints_) {
      constraint.pose.zbar_ij = transform::Embed3D(
          Origin(local_, constraint.submap_id.submap_index).inverse() *
          local_[constraint.node_id.node_index]);
      constraint.pose.translation_weight *= 4.;
      constraint.pose.rotation_weight *= 4.;
    }
  }

  static double StepLength(const OptimizationProblem2D& problem,
                           const int first) {
    return (problem.node_data().at({0, first}).global_pose_2d.inverse() *
            problem.node_data().at({0, first + 1}).global_pose_2d)
        .translation()
        .norm();
  }

  // Two that agree with each other: the opposite sides of the square.
  std::vector<Constraint> WrongLoops() const {
    return {MakeConstraint(0, 25, Rigid2d({5., 0.2}, 0.1),
                           Constraint::INTER_SUBMAP),
            MakeConstraint(1, 72, Rigid2d({0.1, 0.1}, 0.),
                           Constraint::INTER_SUBMAP)};
  }

  static double LargestDifference(const OptimizationProblem2D& a,
                                  const OptimizationProblem2D& b) {
    double result = 0.;
    for (const auto& node : a.node_data()) {
      const Rigid2d difference = node.data.global_pose_2d.inverse() *
                                 b.node_data().at(node.id).global_pose_2d;
      result = std::max({result, difference.translation().norm(),
                         std::abs(difference.normalized_angle())});
    }
    return result;
  }

  double LargestError(const OptimizationProblem2D& problem) const {
    double result = 0.;
    for (const auto& node : problem.node_data()) {
      const Rigid2d difference =
          truth_[node.id.node_index].inverse() * node.data.global_pose_2d;
      result = std::max(result, difference.translation().norm());
    }
    return result;
  }

  // Of the matches of the loop closure.
  void SetShareWrong(const double share) const {
    context_->Get<cartographer_ext::uncertainty::LoopAmbiguity>()->Set(share);
  }

  SwitchedLoops LastSwitchedLoops() const {
    return context_->Get<cartographer_ext::optimization::SwitchedLoopRecorder>()
        ->Get();
  }

  const std::shared_ptr<PoseGraphContext> context_ =
      std::make_shared<PoseGraphContext>();
  const cartographer_ext::ScopedPoseGraphContext scope_{context_};
  const std::map<int, TrajectoryState> active_{{0, TrajectoryState::ACTIVE}};
  std::vector<Rigid2d> truth_, local_;
  std::vector<Constraint> constraints_;
};

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer

#endif  // TESTS_HOST_SQUARE_WALK_H_
