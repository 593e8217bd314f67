// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_ways.h"

#include <cmath>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Straight on, a node every metre; one unit of variance a metre.
class LoopWaysTest : public testing::Test {
 protected:
  LoopWaysTest() : paths_(Noise(), 1000), ways_(2., &paths_) {
    for (int i = 0; i <= 300; ++i) {
      paths_.Add(NodeKey{0, i}, Pose2(i, 0., 0.));
    }
  }

  static PathNoiseOptions Noise() {
    PathNoiseOptions options;
    options.translation_per_metre = 1.;
    options.translation_per_radian = 0.;
    options.rotation_per_metre = 1e-9;
    options.rotation_per_radian = 0.;
    options.free_metres = 5.;
    return options;
  }

  // Node b is where node a was.
  void AddLoop(int a, int b) {
    LoopEdge loop;
    loop.a = NodeKey{0, a};
    loop.b = NodeKey{0, b};
    loop.pose.covariance = Eigen::Vector3d(0.25, 0.25, 0.).asDiagonal();
    ways_.Add(loop);
  }

  double Variance(int a, int b) {
    const auto way = ways_.Between(NodeKey{0, a}, NodeKey{0, b});
    return way.has_value() ? way->covariance(0, 0) : -1.;
  }

  PathUncertainty paths_;
  LoopWays ways_;
};

TEST_F(LoopWaysTest, EffortIsMetresOfDriving) {
  EXPECT_NEAR(*paths_.Effort(NodeKey{0, 10}, NodeKey{0, 30}), 20., 1e-6);
  EXPECT_NEAR(*paths_.Effort(NodeKey{0, 30}, NodeKey{0, 10}), 20., 1e-6);
  EXPECT_FALSE(paths_.Effort(NodeKey{0, 10}, NodeKey{1, 10}).has_value());
  EXPECT_FALSE(paths_.Effort(NodeKey{0, 10}, NodeKey{0, 999}).has_value());
  // A jump of 10 m where 5 m are free: 10 m driven and 5^2 of variance.
  paths_.Add(NodeKey{0, 301}, Pose2(310., 0., 0.));
  EXPECT_NEAR(*paths_.Effort(NodeKey{0, 300}, NodeKey{0, 301}), 35., 1e-6);
  EXPECT_NEAR(paths_.EffortOf(Eigen::Vector3d(4., 4., 0.).asDiagonal()), 4.,
              1e-12);
}

TEST_F(LoopWaysTest, WithoutLoopsTheWayIsTheTrajectory) {
  EXPECT_NEAR(Variance(10, 50), 40., 1e-6);
  EXPECT_NEAR(Variance(50, 10), 40., 1e-6);
  EXPECT_EQ(Variance(10, 400), -1.);
}

TEST_F(LoopWaysTest, WaysLeadOverSeveralLoops) {
  AddLoop(0, 100);
  AddLoop(90, 200);
  // 200 <- 90: 10 back along the way, loop. 0 <- 90 the same once more.
  EXPECT_NEAR(Variance(0, 200), 0.25 + 10. + 0.25, 1e-6);
  EXPECT_NEAR(Variance(200, 0), 0.25 + 10. + 0.25, 1e-6);
  EXPECT_NEAR(Variance(3, 197), 3. + 0.25 + 10. + 0.25 + 3., 1e-6);
  // Poses as well: node 197 is 3 m before 200, which is where 90 was, which is
  // 10 m before 100, which is where 0 was.
  const auto way = ways_.Between(NodeKey{0, 3}, NodeKey{0, 197});
  ASSERT_TRUE(way.has_value());
  EXPECT_NEAR(way->pose.x, -3. - 10. - 3., 1e-9);
  // Along the trajectory where that is shorter.
  EXPECT_NEAR(Variance(150, 160), 10., 1e-6);
}

TEST_F(LoopWaysTest, NewLoopsCountAtOnce) {
  AddLoop(0, 100);
  EXPECT_NEAR(Variance(0, 110), 10.25, 1e-6);
  AddLoop(0, 108);
  EXPECT_NEAR(Variance(0, 110), 2.25, 1e-6);
  ways_.RemoveIf([](const LoopEdge& loop) { return loop.b.node_index > 100; });
  EXPECT_NEAR(Variance(0, 110), 10.25, 1e-6);
  EXPECT_EQ(ways_.num_loops(), 1u);
}

TEST_F(LoopWaysTest, LoopsBesideOthersAreLeftOut) {
  AddLoop(0, 100);
  AddLoop(1, 101);
  AddLoop(2, 98);
  EXPECT_EQ(ways_.num_loops(), 1u);
  AddLoop(3, 100);
  AddLoop(0, 103);
  EXPECT_EQ(ways_.num_loops(), 3u);
}

TEST_F(LoopWaysTest, OtherTrajectoriesAreReachedOverLoops) {
  paths_.Add(NodeKey{1, 0}, Pose2());
  paths_.Add(NodeKey{1, 1}, Pose2(1., 0., 0.));
  EXPECT_FALSE(ways_.Between(NodeKey{1, 1}, NodeKey{0, 7}).has_value());
  LoopEdge loop;
  loop.a = NodeKey{1, 0};
  loop.b = NodeKey{0, 5};
  loop.pose.covariance.setZero();
  ways_.Add(loop);
  const auto way = ways_.Between(NodeKey{1, 1}, NodeKey{0, 7});
  ASSERT_TRUE(way.has_value());
  EXPECT_NEAR(way->covariance(0, 0), 3., 1e-6);
  EXPECT_NEAR(way->pose.x, 1., 1e-9);
}

TEST(LoopWaysOfOneLoopTest, ALoopMakesTheWayShort) {
  PathNoiseOptions options;
  options.translation_per_metre = 0.1;
  options.translation_per_radian = 0.;
  options.rotation_per_metre = 0.01;
  options.rotation_per_radian = 0.1;
  PathUncertainty paths(options, 200);
  const auto key = [](const int index) { return NodeKey{0, index}; };
  const auto way_over = [&paths](const std::vector<LoopEdge>& loops,
                                 const NodeKey& a, const NodeKey& b) {
    LoopWays ways(0., &paths);
    for (const LoopEdge& loop : loops) ways.Add(loop);
    return ways.Between(a, b);
  };
  for (int i = 0; i <= 100; ++i) paths.Add(key(i), Pose2(i, 0., 0.));
  const UncertainPose direct = *way_over({}, key(1), key(99));
  EXPECT_NEAR(direct.pose.x, 98., 1e-12);
  LoopEdge loop;
  loop.a = key(100);
  loop.b = key(0);
  loop.pose.pose = Pose2(0.5, 0., 0.);
  loop.pose.covariance = 0.001 * Eigen::Matrix3d::Identity();
  // 1 -> 0 along the way, 0 -> 100 over the loop, 100 -> 99 along the way.
  const UncertainPose way = *way_over({loop}, key(1), key(99));
  EXPECT_NEAR(way.pose.x, -1. - 0.5 - 1., 1e-12);
  EXPECT_LT(way.covariance(0, 0), 0.03);
  // Between trajectories a loop is the only way.
  paths.Add(NodeKey{1, 0}, Pose2());
  EXPECT_FALSE(way_over({loop}, key(1), NodeKey{1, 0}).has_value());
  loop.b = NodeKey{1, 0};
  EXPECT_TRUE(way_over({loop}, key(1), NodeKey{1, 0}).has_value());
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
