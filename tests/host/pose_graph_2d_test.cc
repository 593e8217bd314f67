// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/pose_graph_2d.h"

#include <cmath>
#include <memory>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace {

using transform::Rigid2d;
using transform::Rigid3d;

constexpr char kChanges[] = R"(
  TRAJECTORY_BUILDER_2D.submaps.num_range_data = 1
  POSE_GRAPH.optimize_every_n_nodes = 1000
  POSE_GRAPH.global_sampling_ratio = 0.01
  POSE_GRAPH.constraint_builder.sampling_ratio = 1.
  POSE_GRAPH.constraint_builder.max_constraint_distance = 6.
  POSE_GRAPH.constraint_builder.min_score = 0.5
  POSE_GRAPH.constraint_builder.log_matches = false
  POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher = {
    linear_search_window = 3.,
    angular_search_window = 0.1,
    branch_and_bound_depth = 3,
  }
  POSE_GRAPH.optimization_problem.huber_scale = 1.
  -- What local SLAM says is wrong here on purpose.
  POSE_GRAPH.optimization_problem.local_slam_pose_translation_weight = 0.
  POSE_GRAPH.optimization_problem.local_slam_pose_rotation_weight = 0.
)";

// A ring of 32 points around the robot, a bit dented so that there are no
// symmetries.
sensor::PointCloud Ring() {
  sensor::PointCloud cloud;
  for (int i = 0; i < 32; ++i) {
    const float angle = 2.f * M_PI * i / 32;
    const float radius = 0.5f + 0.1f * std::sin(3.f * angle) + 0.02f * (i % 3);
    cloud.push_back({Eigen::Vector3f(radius * std::cos(angle),
                                     radius * std::sin(angle), 0.f)});
  }
  return cloud;
}

// Moves a robot that believes what `odometry` says, in an environment fixed to
// the world, and keeps the truth.
class PoseGraph2DTest : public ::testing::Test {
 protected:
  PoseGraph2DTest() : pool_(1) {
    const auto options = test::LoadSlamOptions(kChanges);
    active_submaps_ = absl::make_unique<ActiveSubmaps2D>(
        options.trajectory_builder.trajectory_builder_2d_options()
            .submaps_options());
    graph_options_ = options.map_builder.pose_graph_options();
    pose_graph_ = absl::make_unique<PoseGraph2D>(
        graph_options_,
        absl::make_unique<optimization::OptimizationProblem2D>(
            graph_options_.optimization_problem_options()),
        &pool_);
    world_ = Ring();
  }

  void Move(const Rigid2d& movement, const Rigid2d& noise = Rigid2d()) {
    // The world, seen from the robot, goes the other way.
    true_pose_ = true_pose_ * movement;
    believed_pose_ = believed_pose_ * movement * noise;
    const sensor::PointCloud seen = sensor::TransformPointCloud(
        world_, transform::Embed3D(true_pose_.inverse().cast<float>()));
    const Rigid3d pose = transform::Embed3D(believed_pose_);
    const sensor::RangeData in_local = sensor::TransformRangeData(
        sensor::RangeData{Eigen::Vector3f::Zero(), seen, {}},
        pose.cast<float>());
    TrajectoryNode::Data data;
    time_ += common::FromSeconds(1.);
    data.time = time_;
    data.gravity_alignment = Eigen::Quaterniond::Identity();
    data.filtered_gravity_aligned_point_cloud = seen;
    data.local_pose = pose;
    truth_.push_back(true_pose_);
    pose_graph_->AddNode(std::make_shared<const TrajectoryNode::Data>(data), 0,
                         active_submaps_->InsertRangeData(in_local));
  }

  // Farthest and mean distance of nodes from the truth, relative to the first.
  std::pair<double, double> Errors() {
    const auto nodes = pose_graph_->GetTrajectoryNodes();
    EXPECT_EQ(nodes.SizeOfTrajectoryOrZero(0), truth_.size());
    const Rigid2d first =
        transform::Project2D(nodes.at(NodeId(0, 0)).global_pose);
    double largest = 0.;
    double sum = 0.;
    for (size_t i = 0; i < truth_.size(); ++i) {
      const Rigid2d moved =
          first.inverse() *
          transform::Project2D(nodes.at(NodeId(0, i)).global_pose);
      const double error = (moved.translation() -
                            (truth_[0].inverse() * truth_[i]).translation())
                               .norm();
      largest = std::max(largest, error);
      sum += error / truth_.size();
    }
    return {largest, sum};
  }

  common::ThreadPool pool_;
  proto::PoseGraphOptions graph_options_;
  std::unique_ptr<ActiveSubmaps2D> active_submaps_;
  std::unique_ptr<PoseGraph2D> pose_graph_;
  sensor::PointCloud world_;
  Rigid2d true_pose_;
  Rigid2d believed_pose_;
  std::vector<Rigid2d> truth_;
  common::Time time_ = common::FromUniversal(0);
};

TEST_F(PoseGraph2DTest, EmptyMap) {
  pose_graph_->RunFinalOptimization();
  EXPECT_TRUE(pose_graph_->GetTrajectoryNodes().empty());
  EXPECT_TRUE(pose_graph_->GetAllSubmapData().empty());
  EXPECT_TRUE(pose_graph_->constraints().empty());
  EXPECT_TRUE(pose_graph_->GetTrajectoryStates().empty());
  EXPECT_EQ(pose_graph_->GetSubmapData(SubmapId{3, 4}).submap, nullptr);
}

TEST_F(PoseGraph2DTest, NoMovement) {
  for (int i = 0; i < 3; ++i) Move(Rigid2d::Identity());
  pose_graph_->RunFinalOptimization();
  const auto nodes = pose_graph_->GetTrajectoryNodes();
  ASSERT_EQ(nodes.size(), 3);
  for (const auto& node : nodes) {
    EXPECT_LT(node.data.global_pose.translation().norm(), 1e-2);
    EXPECT_LT(transform::GetAngle(node.data.global_pose), 1e-2);
  }
}

TEST_F(PoseGraph2DTest, NoOverlappingNodes) {
  // Nothing of the world is seen from two places.
  for (int i = 0; i < 4; ++i) {
    world_ = test::Planar(5. * i, 0., 0.).translation().isZero()
                 ? Ring()
                 : sensor::TransformPointCloud(
                       Ring(), transform::Rigid3f::Translation(
                                   Eigen::Vector3f(5.f * i, 0.f, 0.f)));
    Move(i == 0 ? Rigid2d() : Rigid2d::Translation(Eigen::Vector2d(5., 0.)));
  }
  pose_graph_->RunFinalOptimization();
  EXPECT_LT(Errors().first, 1e-2);
}

TEST_F(PoseGraph2DTest, ConsecutivelyOverlappingNodes) {
  for (int i = 0; i < 5; ++i) {
    Move(Rigid2d::Translation(Eigen::Vector2d(0.23, 0.11)));
  }
  pose_graph_->RunFinalOptimization();
  EXPECT_LT(Errors().first, 1e-2);
}

TEST_F(PoseGraph2DTest, OverlappingNodes) {
  cartographer_ext::Random random(7);
  const auto noise = [&random]() {
    return Rigid2d(
        {0.1 * random.Uniform(-1., 1.), 0.1 * random.Uniform(-1., 1.)},
        0.02 * random.Uniform(-1., 1.));
  };
  Move(Rigid2d());
  for (int i = 0; i < 5; ++i) {
    Move(Rigid2d({0.15, 0.1}, 0.05), noise());
  }
  pose_graph_->WaitForAllComputations();
  const double mean_before = Errors().second;
  pose_graph_->RunFinalOptimization();
  EXPECT_LT(Errors().second, 0.6 * mean_before);
}

TEST_F(PoseGraph2DTest, StateAfterNodes) {
  for (int i = 0; i < 4; ++i) Move(Rigid2d());
  pose_graph_->RunFinalOptimization();
  // A submap is complete after two scans, and a new one begins with every scan.
  const auto submaps = pose_graph_->GetAllSubmapData();
  EXPECT_EQ(submaps.size(), 4);
  int num_intra = 0;
  int num_inter = 0;
  for (const auto& constraint : pose_graph_->constraints()) {
    if (constraint.tag == PoseGraph::Constraint::INTRA_SUBMAP) {
      ++num_intra;
      EXPECT_EQ(constraint.pose.translation_weight, 5e2);
      EXPECT_EQ(constraint.pose.rotation_weight, 1.6e3);
    } else {
      ++num_inter;
    }
  }
  // The first node is in one submap, the others are in two.
  EXPECT_EQ(num_intra, 7);
  // Submaps 0, 1 and 2 are complete and hold two nodes each, of four.
  EXPECT_EQ(num_inter, 6);
  EXPECT_EQ(pose_graph_->GetTrajectoryStates().at(0),
            PoseGraphInterface::TrajectoryState::ACTIVE);
  EXPECT_EQ(pose_graph_->GetConnectedTrajectories(),
            (std::vector<std::vector<int>>{{0}}));
  EXPECT_EQ(pose_graph_->GetTrajectoryNodePoses().size(), 4);
  EXPECT_EQ(pose_graph_->GetAllSubmapPoses().at(SubmapId(0, 0)).version, 2);
}

TEST_F(PoseGraph2DTest, CallsBackAfterOptimization) {
  int num_calls = 0;
  pose_graph_->SetGlobalSlamOptimizationCallback(
      [this, &num_calls](const std::map<int, SubmapId>& submaps,
                         const std::map<int, NodeId>& nodes) {
        ++num_calls;
        EXPECT_EQ(submaps.at(0), SubmapId(0, 2));
        EXPECT_EQ(nodes.at(0), NodeId(0, 2));
        // Must not wait for itself.
        pose_graph_->WaitForAllComputations();
        EXPECT_EQ(pose_graph_->GetTrajectoryNodes().size(), 3);
      });
  for (int i = 0; i < 3; ++i) Move(Rigid2d());
  pose_graph_->RunFinalOptimization();
  EXPECT_EQ(num_calls, 1);
}

TEST_F(PoseGraph2DTest, FinishAndDelete) {
  for (int i = 0; i < 3; ++i) Move(Rigid2d());
  EXPECT_FALSE(pose_graph_->IsTrajectoryFinished(0));
  // Nothing happens to a trajectory that is still alive, or never was.
  pose_graph_->DeleteTrajectory(0);
  pose_graph_->DeleteTrajectory(17);
  pose_graph_->FinishTrajectory(0);
  pose_graph_->FinishTrajectory(0);
  pose_graph_->WaitForAllComputations();
  EXPECT_TRUE(pose_graph_->IsTrajectoryFinished(0));
  EXPECT_EQ(pose_graph_->GetTrajectoryNodes().size(), 3);
  // Odometry that comes too late is dropped.
  pose_graph_->AddOdometryData(0, {time_, Rigid3d::Identity()});
  pose_graph_->DeleteTrajectory(0);
  pose_graph_->RunFinalOptimization();
  EXPECT_FALSE(pose_graph_->GetOdometryData().HasTrajectory(0));
  EXPECT_EQ(pose_graph_->GetTrajectoryStates().at(0),
            PoseGraphInterface::TrajectoryState::DELETED);
  EXPECT_TRUE(pose_graph_->GetTrajectoryNodes().empty());
  EXPECT_TRUE(pose_graph_->GetAllSubmapData().empty());
  EXPECT_TRUE(pose_graph_->constraints().empty());
  EXPECT_TRUE(pose_graph_->GetTrajectoryData().empty());
  EXPECT_TRUE(pose_graph_->ToProto(true).trajectory().empty());
}

TEST_F(PoseGraph2DTest, LeavesOutUnfinishedSubmaps) {
  for (int i = 0; i < 3; ++i) Move(Rigid2d());
  pose_graph_->RunFinalOptimization();
  const proto::PoseGraph all = pose_graph_->ToProto(true);
  const proto::PoseGraph finished = pose_graph_->ToProto(false);
  ASSERT_EQ(all.trajectory_size(), 1);
  ASSERT_EQ(finished.trajectory_size(), 1);
  EXPECT_EQ(all.trajectory(0).submap_size(), 3);
  EXPECT_EQ(finished.trajectory(0).submap_size(), 2);
  EXPECT_EQ(finished.trajectory(0).node_size(), 3);
  for (const auto& constraint : finished.constraint()) {
    EXPECT_LT(constraint.submap_id().submap_index(), 2);
  }
  EXPECT_EQ(all.constraint_size() - finished.constraint_size(), 1);
}

TEST_F(PoseGraph2DTest, LandmarksAreOptimized) {
  for (int i = 0; i < 3; ++i) Move(Rigid2d());
  pose_graph_->AddLandmarkData(
      0, {common::FromUniversal(0) + common::FromSeconds(1.5),
          {{"tree", Rigid3d::Translation(Eigen::Vector3d(2., 1., 0.)), 1e3,
            1e3}}});
  pose_graph_->SetLandmarkPose(
      "rock", Rigid3d::Translation(Eigen::Vector3d(9., 9., 0.)), true);
  pose_graph_->RunFinalOptimization();
  const auto poses = pose_graph_->GetLandmarkPoses();
  ASSERT_EQ(poses.size(), 2);
  EXPECT_LT(
      (poses.at("tree").translation() - Eigen::Vector3d(2., 1., 0.)).norm(),
      1e-2);
  EXPECT_EQ(poses.at("rock").translation(), Eigen::Vector3d(9., 9., 0.));
  EXPECT_TRUE(pose_graph_->GetLandmarkNodes().at("rock").frozen);
}

TEST_F(PoseGraph2DTest, InterpolatedPoses) {
  Move(Rigid2d());
  Move(Rigid2d::Translation(Eigen::Vector2d(0.2, 0.)));
  pose_graph_->RunFinalOptimization();
  const auto at = [this](const double seconds) {
    return pose_graph_
        ->GetInterpolatedGlobalTrajectoryPose(
            0, common::FromUniversal(0) + common::FromSeconds(seconds))
        .translation()
        .x();
  };
  const double first = at(1.);
  const double second = at(2.);
  EXPECT_NEAR(second - first, 0.2, 1e-2);
  EXPECT_NEAR(at(1.25), first + 0.25 * (second - first), 1e-9);
  EXPECT_EQ(at(0.), first);
  EXPECT_EQ(at(9.), second);
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
