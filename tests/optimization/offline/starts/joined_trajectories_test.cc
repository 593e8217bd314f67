// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/starts/joined_trajectories.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

PoseGraphEdge Edge(const int from, const int to, const Pose2& measurement,
                   const bool is_loop) {
  PoseGraphEdge edge;
  edge.from = from;
  edge.to = to;
  edge.measurement = measurement;
  edge.information.diagonal() << 400., 400., 1e4;
  edge.is_loop = is_loop;
  return edge;
}

// Two robots of 20 poses, a metre a step; the second drives back beside the
// first, but its own poses begin at the origin. Loops join them every fifth
// pose.
struct TwoRobots {
  TwoRobots() {
    graph.poses.resize(40);
    for (int i = 0; i != 20; ++i) {
      graph.poses[i] = Pose2(i, 0., 0.);
      graph.poses[20 + i] = Pose2(i, 0., 0.);
      truth.push_back(Pose2(i, 0., 0.));
    }
    const Pose2 second(19., 2., kPi);
    for (int i = 0; i != 20; ++i) truth.push_back(second * Pose2(i, 0., 0.));
    for (int i = 0; i != 40; ++i) {
      graph.ids.push_back(i);
      if (i % 20 != 0)
        graph.edges.push_back(Edge(i - 1, i, Pose2(1., 0., 0.), false));
    }
    for (int i = 0; i < 20; i += 5) {
      graph.edges.push_back(
          Edge(i, 39 - i, Between(truth[i], truth[39 - i]), true));
    }
  }

  double Error(const std::vector<Pose2>& poses) const {
    double largest = 0.;
    for (size_t i = 0; i != poses.size(); ++i) {
      largest = std::max(
          largest, (poses[i].translation() - truth[i].translation()).norm());
    }
    return largest;
  }

  PoseGraph graph;
  std::vector<Pose2> truth;
};

TEST(JoinedTrajectoriesTest, LoopsPlaceTheSecondTrajectory) {
  const TwoRobots robots;
  std::vector<Pose2> poses;
  ASSERT_TRUE(JoinTrajectories(robots.graph, SmootherOptions(), &poses));
  EXPECT_LT(robots.Error(poses), 1e-3);
}

// Three right ones agree with each other, two wrong ones with nobody.
TEST(JoinedTrajectoriesTest, WrongLoopsDoNotPlaceIt) {
  TwoRobots robots;
  robots.graph.edges.push_back(Edge(3, 25, Pose2(), true));
  robots.graph.edges.push_back(Edge(12, 38, Pose2(1., -4., 1.), true));
  std::vector<Pose2> poses;
  ASSERT_TRUE(JoinTrajectories(robots.graph, SmootherOptions(), &poses));
  EXPECT_LT(robots.Error(poses), 0.05);
}

TEST(JoinedTrajectoriesTest, OneTrajectoryIsLeftAlone) {
  TwoRobots robots;
  robots.graph.edges.push_back(
      Edge(19, 20, Between(robots.truth[19], robots.truth[20]), false));
  std::vector<Pose2> poses = {Pose2(7., 0., 0.)};
  EXPECT_FALSE(JoinTrajectories(robots.graph, SmootherOptions(), &poses));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].x, 7.);
}

// Sixteen right loops against six groups of six wrong ones that agree with each
// other, by which kernels that are wide enough fold the map.
struct RobotsWithGroups : TwoRobots {
  RobotsWithGroups() {
    for (int i = 0; i != 20; ++i) {
      if (i % 5 == 0) continue;
      graph.edges.push_back(
          Edge(i, 39 - i, Between(truth[i], truth[39 - i]), true));
    }
    for (int group = 0; group != 6; ++group) {
      for (int k = 0; k != 6; ++k) {
        graph.edges.push_back(Edge(2 * group + k, 20 + (5 * group) % 14 + k,
                                   Pose2(0.1 * group, -0.1, 0.), true));
      }
    }
  }
};

TEST(JoinedTrajectoriesTest, GrowthPlacesTheSecondTrajectoryAmongWrongGroups) {
  const RobotsWithGroups robots;
  const LoopSupport support =
      FindLoopSupport(robots.graph, LoopSupportOptions());
  std::vector<Pose2> poses;
  ASSERT_TRUE(
      GrowTrajectories(robots.graph, SmootherOptions(), support, &poses));
  EXPECT_LT(robots.Error(poses), 0.01);
}

TEST(JoinedTrajectoriesTest, GrowthLeavesOneTrajectoryAlone) {
  TwoRobots robots;
  robots.graph.edges.push_back(
      Edge(19, 20, Between(robots.truth[19], robots.truth[20]), false));
  const LoopSupport support =
      FindLoopSupport(robots.graph, LoopSupportOptions());
  std::vector<Pose2> poses = {Pose2(7., 0., 0.)};
  EXPECT_FALSE(
      GrowTrajectories(robots.graph, SmootherOptions(), support, &poses));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].x, 7.);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
