// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

using Constraint = PoseGraphInterface::Constraint;
using LandmarkNode = PoseGraphInterface::LandmarkNode;
using TrajectoryState = PoseGraphInterface::TrajectoryState;
using transform::Rigid2d;
using transform::Rigid3d;

const std::map<int, TrajectoryState> kActive{{0, TrajectoryState::ACTIVE}};

proto::OptimizationProblemOptions Options(const std::string& changes) {
  return test::LoadSlamOptions(changes)
      .map_builder.pose_graph_options()
      .optimization_problem_options();
}

NodeSpec2D Node(const double seconds, const Rigid2d& local,
                const Rigid2d& global) {
  return NodeSpec2D{test::At(seconds), local, global,
                    Eigen::Quaterniond::Identity()};
}

Constraint MakeConstraint(const int node_index, const Rigid2d& pose,
                          const Constraint::Tag tag,
                          const double weight = 100.) {
  return Constraint{SubmapId{0, 0}, NodeId{0, node_index},
                    Constraint::Pose{transform::Embed3D(pose), weight, weight},
                    tag};
}

void ExpectNear(const Rigid2d& actual, const Rigid2d& expected,
                const double tolerance) {
  const Rigid2d error = expected.inverse() * actual;
  EXPECT_LT(error.translation().norm(), tolerance) << actual;
  EXPECT_LT(std::abs(error.normalized_angle()), tolerance) << actual;
}

TEST(OptimizationProblem2DTest, NothingToSolve) {
  OptimizationProblem2D problem(Options(""));
  problem.Solve({}, {}, {});
  problem.AddSubmap(0, Rigid2d({1., 2.}, 3.));
  problem.Solve({}, kActive, {});
  EXPECT_EQ(problem.submap_data().at(SubmapId(0, 0)).global_pose.translation(),
            Eigen::Vector2d(1., 2.));
}

TEST(OptimizationProblem2DTest, TheFirstSubmapStays) {
  OptimizationProblem2D problem(Options(""));
  const Rigid2d submap({1., 2.}, 0.5);
  const Rigid2d relative({0.4, -0.3}, 0.2);
  problem.AddSubmap(0, submap);
  problem.AddTrajectoryNode(0, Node(0., {}, Rigid2d({7., 7.}, -2.)));
  problem.Solve({MakeConstraint(0, relative, Constraint::INTRA_SUBMAP)},
                kActive, {});
  ExpectNear(problem.submap_data().at(SubmapId(0, 0)).global_pose, submap,
             1e-12);
  ExpectNear(problem.node_data().at(NodeId(0, 0)).global_pose_2d,
             submap * relative, 1e-6);
}

TEST(OptimizationProblem2DTest, FrozenTrajectoriesStay) {
  OptimizationProblem2D problem(Options(""));
  const Rigid2d node({7., 7.}, -2.);
  problem.AddSubmap(0, Rigid2d::Identity());
  problem.AddTrajectoryNode(0, Node(0., {}, node));
  const std::vector<Constraint> constraints{
      MakeConstraint(0, Rigid2d::Identity(), Constraint::INTER_SUBMAP)};
  problem.Solve(constraints, {{0, TrajectoryState::FROZEN}}, {});
  ExpectNear(problem.node_data().at(NodeId(0, 0)).global_pose_2d, node, 1e-12);
  problem.Solve(constraints, {{0, TrajectoryState::FINISHED}}, {});
  ExpectNear(problem.node_data().at(NodeId(0, 0)).global_pose_2d,
             Rigid2d::Identity(), 1e-4);
}

// Two loop closures disagree with two constraints from building the map; under
// the Huber loss the latter win.
TEST(OptimizationProblem2DTest, LossOfLoopClosures) {
  const auto solve = [](const Constraint::Tag tag) {
    OptimizationProblem2D problem(Options(""));
    problem.AddSubmap(0, Rigid2d::Identity());
    problem.AddTrajectoryNode(0, Node(0., {}, {}));
    problem.Solve(
        {MakeConstraint(0, Rigid2d::Identity(), Constraint::INTRA_SUBMAP),
         MakeConstraint(0, Rigid2d({10., 0.}, 0.), tag)},
        kActive, {});
    return problem.node_data()
        .at(NodeId(0, 0))
        .global_pose_2d.translation()
        .x();
  };
  EXPECT_NEAR(solve(Constraint::INTRA_SUBMAP), 5., 1e-3);
  // Pulled with the constant force w * huber_scale against w^2 x: 10 / 100.
  EXPECT_NEAR(solve(Constraint::INTER_SUBMAP), 0.1, 1e-3);
}

TEST(OptimizationProblem2DTest, LocalSlamHoldsConsecutiveNodesTogether) {
  OptimizationProblem2D problem(Options(""));
  problem.AddSubmap(0, Rigid2d::Identity());
  problem.AddTrajectoryNode(0, Node(0., Rigid2d({5., 5.}, 0.), {}));
  problem.AddTrajectoryNode(
      0, Node(1., Rigid2d({6., 5.}, 0.), Rigid2d({3., 3.}, 1.)));
  problem.Solve(
      {MakeConstraint(0, Rigid2d::Identity(), Constraint::INTRA_SUBMAP)},
      kActive, {});
  ExpectNear(problem.node_data().at(NodeId(0, 1)).global_pose_2d,
             Rigid2d({1., 0.}, 0.), 1e-4);
}

TEST(OptimizationProblem2DTest, NothingHoldsNodesTogetherAcrossAGap) {
  OptimizationProblem2D problem(Options(""));
  problem.AddSubmap(0, Rigid2d::Identity());
  problem.InsertTrajectoryNode(NodeId(0, 0), Node(0., {}, {}));
  problem.InsertTrajectoryNode(
      NodeId(0, 2), Node(1., Rigid2d({1., 0.}, 0.), Rigid2d({3., 3.}, 1.)));
  problem.Solve(
      {MakeConstraint(0, Rigid2d::Identity(), Constraint::INTRA_SUBMAP)},
      kActive, {});
  ExpectNear(problem.node_data().at(NodeId(0, 2)).global_pose_2d,
             Rigid2d({3., 3.}, 1.), 1e-6);
}

TEST(OptimizationProblem2DTest, OdometryBetweenNodes) {
  OptimizationProblem2D problem(Options(R"(
    POSE_GRAPH.optimization_problem.local_slam_pose_translation_weight = 0.
    POSE_GRAPH.optimization_problem.local_slam_pose_rotation_weight = 0.)"));
  problem.AddSubmap(0, Rigid2d::Identity());
  problem.AddTrajectoryNode(0, Node(1., {}, {}));
  problem.AddTrajectoryNode(0, Node(2., {}, {}));
  // 2 m/s along x from t = 0.5 on; heading to the left in its own frame.
  for (const double t : {0.5, 1.5, 2.5}) {
    problem.AddOdometryData(0,
                            {test::At(t), test::Planar(-1., 2. * t, M_PI / 2)});
  }
  // Out of order: dropped.
  problem.AddOdometryData(0, {test::At(1.7), test::Planar(50., 0., 0.)});
  problem.Solve(
      {MakeConstraint(0, Rigid2d::Identity(), Constraint::INTRA_SUBMAP)},
      kActive, {});
  ExpectNear(problem.node_data().at(NodeId(0, 1)).global_pose_2d,
             Rigid2d({2., 0.}, 0.), 1e-4);
}

TEST(OptimizationProblem2DTest, OdometryMustCoverBothNodes) {
  OptimizationProblem2D problem(Options(""));
  problem.AddSubmap(0, Rigid2d::Identity());
  problem.AddTrajectoryNode(0, Node(1., {}, {}));
  problem.AddTrajectoryNode(0, Node(2., Rigid2d({1., 0.}, 0.), {}));
  problem.AddOdometryData(0, {test::At(0.), test::Planar(0., 0., 0.)});
  problem.AddOdometryData(0, {test::At(1.9), test::Planar(50., 0., 0.)});
  problem.Solve(
      {MakeConstraint(0, Rigid2d::Identity(), Constraint::INTRA_SUBMAP)},
      kActive, {});
  ExpectNear(problem.node_data().at(NodeId(0, 1)).global_pose_2d,
             Rigid2d({1., 0.}, 0.), 1e-4);
}

class LandmarkTest : public ::testing::Test {
 protected:
  LandmarkTest() : problem_(Options("")) {
    problem_.AddSubmap(0, Rigid2d::Identity());
    problem_.AddTrajectoryNode(0, Node(0., {}, {}));
    problem_.AddTrajectoryNode(
        0, Node(2., Rigid2d({2., 0.}, 0.), Rigid2d({2., 0.}, 0.)));
  }

  LandmarkNode Observed(const double seconds, const int trajectory_id = 0) {
    LandmarkNode landmark;
    landmark.landmark_observations.push_back(
        {trajectory_id, test::At(seconds),
         Rigid3d::Translation(Eigen::Vector3d(0., 3., 1.)), 100., 100.});
    return landmark;
  }

  void Solve(const LandmarkNode& landmark) {
    problem_.Solve(
        {MakeConstraint(0, Rigid2d::Identity(), Constraint::INTRA_SUBMAP),
         MakeConstraint(1, Rigid2d({2., 0.}, 0.), Constraint::INTRA_SUBMAP)},
        kActive, {{"tree", landmark}});
  }

  OptimizationProblem2D problem_;
};

TEST_F(LandmarkTest, ComesToWhereItWasSeen) {
  Solve(Observed(1.));
  EXPECT_LT((problem_.landmark_data().at("tree").translation() -
             Eigen::Vector3d(1., 3., 1.))
                .norm(),
            1e-6);
}

TEST_F(LandmarkTest, MovesFromAnEarlierPose) {
  LandmarkNode landmark = Observed(0.);
  landmark.global_landmark_pose =
      Rigid3d::Translation(Eigen::Vector3d(0.1, 3.1, 1.));
  Solve(landmark);
  EXPECT_LT((problem_.landmark_data().at("tree").translation() -
             Eigen::Vector3d(0., 3., 1.))
                .norm(),
            1e-3);
}

TEST_F(LandmarkTest, AFrozenOneMovesTheRobotInstead) {
  LandmarkNode landmark = Observed(2.);
  landmark.landmark_observations[0].translation_weight = 1e5;
  landmark.global_landmark_pose =
      Rigid3d::Translation(Eigen::Vector3d(2.05, 3., 1.));
  landmark.frozen = true;
  Solve(landmark);
  EXPECT_EQ(problem_.landmark_data().at("tree").translation(),
            Eigen::Vector3d(2.05, 3., 1.));
  EXPECT_GT(
      problem_.node_data().at(NodeId(0, 1)).global_pose_2d.translation().x(),
      2.01);
}

TEST_F(LandmarkTest, ObservationsOutsideOfTheTrajectoryDoNotCount) {
  for (const double seconds : {-1., 2.5}) {
    Solve(Observed(seconds));
    EXPECT_EQ(problem_.landmark_data().count("tree"), 0);
  }
  Solve(Observed(1., 5));
  EXPECT_EQ(problem_.landmark_data().count("tree"), 0);
}

TEST(OptimizationProblem2DTest, FixedFrame) {
  for (const bool use_tolerant_loss : {false, true}) {
    auto options = Options("");
    options.set_fixed_frame_pose_use_tolerant_loss(use_tolerant_loss);
    OptimizationProblem2D problem(options);
    problem.AddSubmap(0, Rigid2d::Identity());
    for (int i = 0; i < 3; ++i) {
      const Rigid2d pose({1. * i, 0.}, 0.);
      problem.AddTrajectoryNode(0, Node(i, pose, pose));
    }
    // The frame's origin is at (10, 0).
    problem.AddFixedFramePoseData(0,
                                  {test::At(0.), test::Planar(-10., 0., 0.)});
    problem.AddFixedFramePoseData(0, {test::At(1.), absl::nullopt});
    problem.AddFixedFramePoseData(0, {test::At(2.), test::Planar(-8., 0., 0.)});
    problem.AddFixedFramePoseData(0, {test::At(2.), test::Planar(9., 9., 0.)});
    std::vector<Constraint> constraints;
    for (int i = 0; i < 3; ++i) {
      constraints.push_back(MakeConstraint(i, Rigid2d({1. * i, 0.}, 0.),
                                           Constraint::INTRA_SUBMAP));
    }
    problem.Solve(constraints, kActive, {});
    const auto& origin =
        problem.trajectory_data().at(0).fixed_frame_origin_in_map;
    ASSERT_TRUE(origin.has_value());
    EXPECT_LT((origin->translation() - Eigen::Vector3d(10., 0., 0.)).norm(),
              0.05);
  }
}

TEST(OptimizationProblem2DTest, TrimmingForgetsWhatOnlyANodeNeeded) {
  OptimizationProblem2D problem(Options(""));
  for (int i = 0; i < 3; ++i) problem.AddTrajectoryNode(0, Node(i, {}, {}));
  for (int i = 0; i <= 20; ++i) {
    problem.AddOdometryData(0, {test::At(0.1 * i), Rigid3d::Identity()});
  }
  problem.TrimTrajectoryNode(NodeId(0, 1));
  int num_left = 0;
  for (const auto& unused : problem.odometry_data().trajectory(0)) {
    static_cast<void>(unused);
    ++num_left;
  }
  EXPECT_EQ(num_left, 2);
  EXPECT_EQ(problem.trajectory_data().count(0), 1);
  problem.TrimTrajectoryNode(NodeId(0, 0));
  problem.TrimTrajectoryNode(NodeId(0, 2));
  EXPECT_EQ(problem.trajectory_data().count(0), 0);
  EXPECT_TRUE(problem.node_data().empty());
}

TEST(OptimizationProblem2DTest, PosesThatAreNoPosesStopNothing) {
  OptimizationProblem2D problem(Options(""));
  problem.AddSubmap(0, Rigid2d::Identity());
  problem.AddTrajectoryNode(0, Node(0., {}, Rigid2d({NAN, 0.}, 0.)));
  problem.Solve(
      {MakeConstraint(0, Rigid2d::Identity(), Constraint::INTRA_SUBMAP)},
      kActive, {});
  EXPECT_EQ(problem.submap_data().at(SubmapId(0, 0)).global_pose.translation(),
            Eigen::Vector2d(0., 0.));
}

}  // namespace
}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
