// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/localization_monitor.h"

#include <cmath>
#include <memory>

#include "absl/memory/memory.h"
#include "gtest/gtest.h"
#include "tests/navigation/test_maps.h"

namespace cartographer_ext {
namespace navigation {
namespace {

class LocalizationMonitorTest : public testing::Test {
 protected:
  LocalizationMonitorTest() : map_(RoomMap(8., 6.)) {
    FillBox(5., 0., 6., 2., 1.f, &map_);
    costmap_ = absl::make_unique<Costmap>(MakeCostmap(map_));
    echoes_ = ScanOf(map_, true_pose_);
  }

  io::OccupancyMap map_;
  std::unique_ptr<Costmap> costmap_;
  const Pose2 true_pose_{3., 3., 0.4};
  std::vector<Eigen::Vector2d> echoes_;
  const Pose2 wrong_pose_{4.2, 3.7, 1.4};
};

TEST_F(LocalizationMonitorTest, ShareIsHighAtTheRightPoseOnly) {
  EXPECT_GT(ShareAtWalls(*costmap_, echoes_, true_pose_, 0.15), 0.98);
  EXPECT_LT(ShareAtWalls(*costmap_, echoes_, wrong_pose_, 0.15), 0.4);
  EXPECT_EQ(ShareAtWalls(*costmap_, {}, true_pose_, 0.15), 0.);
  EXPECT_EQ(ShareAtWalls(*costmap_, echoes_, Pose2(std::nan(""), 0., 0.), 0.15),
            0.);
  EXPECT_EQ(ShareAtWalls(*costmap_, {{std::nan(""), 1.}}, true_pose_, 0.15),
            0.);
}

TEST_F(LocalizationMonitorTest, RefinesARoughGuess) {
  Random random(8);
  for (int trial = 0; trial != 5; ++trial) {
    const Pose2 guess(true_pose_.x + random.Uniform(-0.4, 0.4),
                      true_pose_.y + random.Uniform(-0.4, 0.4),
                      true_pose_.theta + random.Uniform(-0.15, 0.15));
    const Pose2 refined = RefinePose(*costmap_, echoes_, guess);
    EXPECT_LT((refined.translation() - true_pose_.translation()).norm(), 0.05);
    EXPECT_NEAR(refined.theta, true_pose_.theta, 0.02);
  }
  const Pose2 unchanged = RefinePose(*costmap_, {}, wrong_pose_);
  EXPECT_EQ(unchanged.x, wrong_pose_.x);
}

TEST_F(LocalizationMonitorTest, IsLostAfterASecondOfContradiction) {
  LocalizationMonitor monitor((LocalizationMonitorOptions()));
  EXPECT_TRUE(monitor.IsLost(0.));
  double time = 0.;
  const auto add = [&](const Pose2& pose, const double seconds) {
    for (const double end = time + seconds; time < end - 1e-9; time += 0.1) {
      monitor.AddScan(*costmap_, echoes_, pose, Pose2(), time);
    }
  };
  add(true_pose_, 0.5);
  EXPECT_FALSE(monitor.IsLost(time));
  EXPECT_EQ(monitor.Reason(time), "");
  // Slides away, without a jump.
  for (double share = 0.1; share < 1.; share += 0.1) {
    add(Interpolate(true_pose_, wrong_pose_, share), 0.1);
  }
  add(wrong_pose_, 1.5);
  EXPECT_TRUE(monitor.IsLost(time));
  EXPECT_NE(monitor.Reason(time).find("at walls"), std::string::npos);
  add(wrong_pose_, 5.);
  EXPECT_TRUE(monitor.IsLost(time));
}

TEST_F(LocalizationMonitorTest, AJumpIsALoss) {
  LocalizationMonitor monitor((LocalizationMonitorOptions()));
  monitor.AddScan(*costmap_, echoes_, true_pose_, Pose2(), 0.);
  EXPECT_FALSE(monitor.IsLost(0.));
  monitor.AddScan(*costmap_, echoes_, wrong_pose_, Pose2(), 0.1);
  EXPECT_TRUE(monitor.IsLost(0.1));
  EXPECT_EQ(monitor.Reason(0.1), "the pose jumped");
  // Back at the right place, believed after a second.
  double time = 0.2;
  for (; time < 1.15; time += 0.1) {
    monitor.AddScan(*costmap_, echoes_, true_pose_, Pose2(), time);
    EXPECT_TRUE(monitor.IsLost(time));
  }
  for (; time < 2.; time += 0.1) {
    monitor.AddScan(*costmap_, echoes_, true_pose_, Pose2(), time);
  }
  EXPECT_FALSE(monitor.IsLost(2.));
}

TEST_F(LocalizationMonitorTest, SilenceIsALoss) {
  LocalizationMonitor monitor((LocalizationMonitorOptions()));
  monitor.AddScan(*costmap_, echoes_, true_pose_, Pose2(), 0.);
  EXPECT_FALSE(monitor.IsLost(0.4));
  EXPECT_TRUE(monitor.IsLost(0.6));
  EXPECT_NE(monitor.Reason(0.6).find("silent"), std::string::npos);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
