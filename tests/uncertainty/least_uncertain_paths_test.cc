// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/least_uncertain_paths.h"

#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

// Straight on, a node every metre; one unit of variance per metre.
class LeastUncertainPathsTest : public testing::Test {
 protected:
  LeastUncertainPathsTest() : paths_(Noise(), 1000), least_(2., &paths_) {
    for (int i = 0; i <= 300; ++i) {
      paths_.Add(NodeId{0, i}, Pose2(i, 0., 0.));
    }
  }

  static PathNoiseOptions Noise() {
    PathNoiseOptions options = RandomWalk();
    options.translation_per_metre = 1.;
    options.translation_per_radian = 0.;
    options.rotation_per_metre = 1e-9;
    options.rotation_per_radian = 0.;
    options.jump_threshold_metres = 5.;
    return options;
  }

  // Node b is where node a was.
  void AddLoop(int a, int b) {
    LoopEdge loop;
    loop.a = NodeId{0, a};
    loop.b = NodeId{0, b};
    loop.pose.covariance = Eigen::Vector3d(0.25, 0.25, 0.).asDiagonal();
    least_.Add(loop);
  }

  double Variance(int a, int b) {
    const auto path = least_.Between(NodeId{0, a}, NodeId{0, b});
    return path.has_value() ? path->covariance(0, 0) : -1.;
  }

  PathUncertainty paths_;
  LeastUncertainPaths least_;
};

TEST_F(LeastUncertainPathsTest, PathCostIsMetresOfDriving) {
  EXPECT_NEAR(*paths_.PathCost(NodeId{0, 10}, NodeId{0, 30}), 20., 1e-6);
  EXPECT_NEAR(*paths_.PathCost(NodeId{0, 30}, NodeId{0, 10}), 20., 1e-6);
  EXPECT_FALSE(paths_.PathCost(NodeId{0, 10}, NodeId{1, 10}).has_value());
  EXPECT_FALSE(paths_.PathCost(NodeId{0, 10}, NodeId{0, 999}).has_value());
  // A jump of 10 m beyond the threshold of 5 m: 10 m driven and 5^2 of
  // variance.
  paths_.Add(NodeId{0, 301}, Pose2(310., 0., 0.));
  EXPECT_NEAR(*paths_.PathCost(NodeId{0, 300}, NodeId{0, 301}), 35., 1e-6);
  EXPECT_NEAR(paths_.PathCostOf(Eigen::Vector3d(4., 4., 0.).asDiagonal()), 4.,
              1e-12);
}

TEST_F(LeastUncertainPathsTest, WithoutLoopsThePathIsTheTrajectory) {
  EXPECT_NEAR(Variance(10, 50), 40., 1e-6);
  EXPECT_NEAR(Variance(50, 10), 40., 1e-6);
  EXPECT_EQ(Variance(10, 400), -1.);
}

TEST_F(LeastUncertainPathsTest, PathsThatDoNotLeadOverSomeLoops) {
  AddLoop(0, 100);
  AddLoop(90, 200);
  LeastUncertainPaths without =
      least_.Without([](const LoopEdge& loop) { return loop.a.index() == 90; });
  EXPECT_EQ(without.num_loops(), 1u);
  // 100 <- 200: 100 m of driving; 0 <- 100: the loop that is left.
  const auto path = without.Between(NodeId{0, 0}, NodeId{0, 200});
  ASSERT_TRUE(path.has_value());
  EXPECT_NEAR(path->covariance(0, 0), 0.25 + 100., 1e-6);
  // It is not added again near itself.
  LoopEdge near;
  near.a = NodeId{0, 1};
  near.b = NodeId{0, 101};
  without.Add(near);
  EXPECT_EQ(without.num_loops(), 1u);
  EXPECT_NEAR(Variance(0, 200), 0.25 + 10. + 0.25, 1e-6);
}

TEST_F(LeastUncertainPathsTest, PathsLeadOverSeveralLoops) {
  AddLoop(0, 100);
  AddLoop(90, 200);
  // 90 <- 200: a loop; 100 <- 90: 10 m of driving; 0 <- 100: a loop.
  EXPECT_NEAR(Variance(0, 200), 0.25 + 10. + 0.25, 1e-6);
  EXPECT_NEAR(Variance(200, 0), 0.25 + 10. + 0.25, 1e-6);
  EXPECT_NEAR(Variance(3, 197), 3. + 0.25 + 10. + 0.25 + 3., 1e-6);
  // Poses as well: node 197 is 3 m before 200, which is where 90 was, which is
  // 10 m before 100, which is where 0 was.
  const auto path = least_.Between(NodeId{0, 3}, NodeId{0, 197});
  ASSERT_TRUE(path.has_value());
  EXPECT_NEAR(path->pose.x, -3. - 10. - 3., 1e-9);
  // Along the trajectory where that is shorter.
  EXPECT_NEAR(Variance(150, 160), 10., 1e-6);
}

TEST_F(LeastUncertainPathsTest, NewLoopsCountAtOnce) {
  AddLoop(0, 100);
  EXPECT_NEAR(Variance(0, 110), 10.25, 1e-6);
  AddLoop(0, 108);
  EXPECT_NEAR(Variance(0, 110), 2.25, 1e-6);
  least_.RemoveIf([](const LoopEdge& loop) { return loop.b.index() > 100; });
  EXPECT_NEAR(Variance(0, 110), 10.25, 1e-6);
  EXPECT_EQ(least_.num_loops(), 1u);
}

TEST_F(LeastUncertainPathsTest, LoopsBesideOthersAreNotStored) {
  AddLoop(0, 100);
  AddLoop(1, 101);
  AddLoop(2, 98);
  EXPECT_EQ(least_.num_loops(), 1u);
  AddLoop(3, 100);
  AddLoop(0, 103);
  EXPECT_EQ(least_.num_loops(), 3u);
}

TEST_F(LeastUncertainPathsTest, OtherTrajectoriesAreReachedOverLoops) {
  paths_.Add(NodeId{1, 0}, Pose2());
  paths_.Add(NodeId{1, 1}, Pose2(1., 0., 0.));
  EXPECT_FALSE(least_.Between(NodeId{1, 1}, NodeId{0, 7}).has_value());
  LoopEdge loop;
  loop.a = NodeId{1, 0};
  loop.b = NodeId{0, 5};
  loop.pose.covariance.setZero();
  least_.Add(loop);
  const auto path = least_.Between(NodeId{1, 1}, NodeId{0, 7});
  ASSERT_TRUE(path.has_value());
  EXPECT_NEAR(path->covariance(0, 0), 3., 1e-6);
  EXPECT_NEAR(path->pose.x, 1., 1e-9);
}

TEST(LeastUncertainPathsOfOneLoopTest, ALoopShortensThePath) {
  PathNoiseOptions options = RandomWalk();
  options.translation_per_metre = 0.1;
  options.translation_per_radian = 0.;
  options.rotation_per_metre = 0.01;
  options.rotation_per_radian = 0.1;
  PathUncertainty paths(options, 200);
  const auto key = [](const int index) { return NodeId{0, index}; };
  const auto path_over = [&paths](const std::vector<LoopEdge>& loops,
                                  const VertexId& a, const VertexId& b) {
    LeastUncertainPaths least(0., &paths);
    for (const LoopEdge& loop : loops) least.Add(loop);
    return least.Between(a, b);
  };
  for (int i = 0; i <= 100; ++i) paths.Add(key(i), Pose2(i, 0., 0.));
  const UncertainPose direct = *path_over({}, key(1), key(99));
  EXPECT_NEAR(direct.pose.x, 98., 1e-12);
  LoopEdge loop;
  loop.a = key(100);
  loop.b = key(0);
  loop.pose.pose = Pose2(0.5, 0., 0.);
  loop.pose.covariance = 0.001 * Eigen::Matrix3d::Identity();
  // 1 -> 0 along the trajectory, 0 -> 100 over the loop, 100 -> 99 along it.
  const UncertainPose path = *path_over({loop}, key(1), key(99));
  EXPECT_NEAR(path.pose.x, -1. - 0.5 - 1., 1e-12);
  EXPECT_LT(path.covariance(0, 0), 0.03);
  // Between trajectories a loop is the only path.
  paths.Add(NodeId{1, 0}, Pose2());
  EXPECT_FALSE(path_over({loop}, key(1), NodeId{1, 0}).has_value());
  loop.b = NodeId{1, 0};
  EXPECT_TRUE(path_over({loop}, key(1), NodeId{1, 0}).has_value());
}

TEST_F(LeastUncertainPathsTest, SubmapsAreVerticesOfTheirOwn) {
  paths_.Add(SubmapId{0, 0}, Pose2(100., 0., 0.));
  paths_.Add(SubmapId{0, 1}, Pose2(104., 0., 0.));
  // Local SLAM alone does not relate a submap to a node, not even one of the
  // same index.
  EXPECT_FALSE(least_.Between(SubmapId{0, 0}, NodeId{0, 0}).has_value());
  LoopEdge loop;
  loop.a = SubmapId{0, 0};
  loop.b = NodeId{0, 50};
  loop.pose.covariance = Eigen::Vector3d(0.25, 0.25, 0.).asDiagonal();
  least_.Add(loop);
  const auto path = least_.Between(SubmapId{0, 1}, NodeId{0, 53});
  ASSERT_TRUE(path.has_value());
  EXPECT_NEAR(path->pose.x, -4. + 3., 1e-9);
  EXPECT_NEAR(path->covariance(0, 0), 4. + 0.25 + 3., 1e-6);
}

TEST_F(LeastUncertainPathsTest, ManyLoopsAreThinnedNotForgotten) {
  LeastUncertainPaths bounded(2., &paths_, 10);
  // Every third node of the second 150 m lies where one of the first does.
  for (int i = 0; i < 50; ++i) {
    LoopEdge loop;
    loop.a = NodeId{0, 3 * i};
    loop.b = NodeId{0, 150 + 3 * i};
    loop.pose.covariance = Eigen::Vector3d(0.25, 0.25, 0.).asDiagonal();
    bounded.Add(loop);
    ASSERT_LE(bounded.num_loops(), 10u);
  }
  EXPECT_GE(bounded.num_loops(), 5u);
  // The next loop is at most half the spacing of those kept (16 m) away, at
  // either end.
  for (const int i : {0, 40, 75, 110, 140}) {
    const auto path = bounded.Between(NodeId{0, i}, NodeId{0, 150 + i});
    ASSERT_TRUE(path.has_value());
    EXPECT_LE(path->covariance(0, 0), 16. + 16. + 0.25 + 1e-6) << i;
  }
}

TEST_F(LeastUncertainPathsTest, LoopsThatAreFarFromEachOtherAreForgotten) {
  // Nodes of other trajectories are at no distance from each other.
  LeastUncertainPaths bounded(2., &paths_, 4);
  for (int i = 1; i <= 6; ++i) {
    paths_.Add(NodeId{i, 0}, Pose2());
    LoopEdge loop;
    loop.a = NodeId{0, 0};
    loop.b = NodeId{i, 0};
    loop.pose.covariance = Eigen::Vector3d(0.25, 0.25, 0.).asDiagonal();
    bounded.Add(loop);
  }
  EXPECT_EQ(bounded.num_loops(), 4u);
  EXPECT_FALSE(bounded.Between(NodeId{0, 0}, NodeId{2, 0}).has_value());
  EXPECT_TRUE(bounded.Between(NodeId{0, 0}, NodeId{6, 0}).has_value());
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
