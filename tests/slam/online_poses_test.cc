// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/online_poses.h"

#include <thread>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

std::vector<StampedPose> Scans() {
  std::vector<StampedPose> scans;
  for (int i = 0; i < 6; ++i) {
    scans.push_back({100 * i, ToIsometry(Pose2(i, 0., 0.))});
  }
  return scans;
}

TEST(OnlinePosesTest, WithoutOptimizationTheStartHolds) {
  OnlinePoses poses;
  EXPECT_TRUE(poses.At({}).empty());
  for (const StampedPose& pose : poses.At(Scans())) {
    EXPECT_NEAR(pose.pose.translation().x(), pose.time / 100., 1e-12);
  }
  // A quarter turn: the translation along x becomes one along y.
  poses.Start(ToIsometry(Pose2(10., 20., kPi / 2.)));
  const auto moved = poses.At(Scans());
  ASSERT_EQ(moved.size(), 6u);
  EXPECT_EQ(moved[3].time, 300);
  const Pose2 third = ToPose2(moved[3].pose);
  EXPECT_NEAR(third.x, 10., 1e-12);
  EXPECT_NEAR(third.y, 23., 1e-12);
  EXPECT_NEAR(third.theta, kPi / 2., 1e-12);
}

TEST(OnlinePosesTest, AnOptimizationShowsInTheScansAfterItsNode) {
  OnlinePoses poses;
  poses.AddNode(0, 100);
  poses.AddNode(1, 300);
  // The later one came first; of node 1 the second holds.
  poses.AddOptimization(1, ToIsometry(Pose2(0., 5., 0.)));
  poses.AddOptimization(0, ToIsometry(Pose2(0., 1., 0.)));
  poses.AddOptimization(1, ToIsometry(Pose2(0., 7., 0.)));
  // Of a node that nobody knows.
  poses.AddOptimization(9, ToIsometry(Pose2(0., 99., 0.)));
  const double expected[] = {0., 0., 1., 1., 7., 7.};
  const auto online = poses.At(Scans());
  ASSERT_EQ(online.size(), 6u);
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(online[i].pose.translation().x(), i, 1e-12);
    EXPECT_NEAR(online[i].pose.translation().y(), expected[i], 1e-12) << i;
  }
}

TEST(OnlinePosesTest, LocalizedIsTheFirstScanBehindTheNode) {
  OnlinePoses poses;
  EXPECT_FALSE(poses.is_localized());
  EXPECT_FALSE(poses.LocalizedAt(Scans()).has_value());
  poses.AddNode(1, 300);
  poses.AddNode(2, 400);
  poses.AddOptimization(1, ToIsometry(Pose2(0., 5., 0.)));
  poses.SetLocalized(1);
  poses.SetLocalized(2);  // too late to count
  EXPECT_TRUE(poses.is_localized());
  const auto pose = poses.LocalizedAt(Scans());
  ASSERT_TRUE(pose.has_value());
  EXPECT_EQ(pose->time, 400);
  EXPECT_NEAR(pose->pose.translation().y(), 5., 1e-12);
  // The last scan is the node itself.
  EXPECT_FALSE(poses.LocalizedAt({Scans()[0], Scans()[3]}).has_value());
}

TEST(OnlinePosesTest, TakesWordFromSeveralThreads) {
  OnlinePoses poses;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&poses, t]() {
      for (int i = t; i < 400; i += 4) {
        poses.AddOptimization(i, ToIsometry(Pose2(0., i + 1., 0.)));
        poses.AddNode(i, i);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  const auto online = poses.At(Scans());
  // The scan at 100 comes after node 99, the last one after all.
  EXPECT_NEAR(online[1].pose.translation().y(), 100., 1e-12);
  EXPECT_NEAR(online[5].pose.translation().y(), 400., 1e-12);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
