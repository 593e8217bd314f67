// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/velocity_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr double kTranslationSigma = 0.01;
constexpr double kRotationSigma = 0.005;

VelocityFilter Filter(
    const ConstantVelocityOptions& options = ConstantVelocityOptions()) {
  return VelocityFilter(options, kTranslationSigma, kRotationSigma);
}

TEST(VelocityFilterTest, KnowsNothingAtFirst) {
  const VelocityFilter filter = Filter();
  EXPECT_EQ(filter.velocity().x, 0.);
  EXPECT_EQ(filter.Motion(2.).x, 0.);
  const Eigen::Matrix3d covariance = filter.MotionCovariance(0.1);
  // (0.5 m/s)^2 and (1 m/s^2 * 0.1 s)^2 over 0.1 s, and a pose.
  EXPECT_NEAR(covariance(0, 0), 0.01 * (0.25 + 0.01) + 1e-4, 1e-12);
  EXPECT_NEAR(covariance(1, 1), covariance(0, 0), 1e-12);
  // (0.2 rad/s)^2 and (1 rad/s^2 * 0.1 s)^2.
  EXPECT_NEAR(covariance(2, 2), 0.01 * (0.04 + 0.01) + 25e-6, 1e-12);
  EXPECT_EQ(covariance(0, 1), 0.);
}

TEST(VelocityFilterTest, TheChangeOfSpeedIsLimited) {
  VelocityFilter filter = Filter();
  filter.Restart(1., Pose2());
  // 2 * (0.01 m)^2 / s^2 of two poses; not 1 m/s^2 * 0.8 s but 0.5 m/s.
  EXPECT_NEAR(filter.MotionCovariance(0.8)(0, 0), 0.64 * (2e-4 + 0.25) + 1e-4,
              1e-9);
}

TEST(VelocityFilterTest, AMatchWithoutDoubtIsTakenByItsGain) {
  VelocityFilter filter = Filter();
  filter.AddMatch(0.1, Pose2(0.03, 0., 0.), Eigen::Matrix3d::Zero());
  // K = V dt / P.
  const double v = 0.25 + 0.01, p = 0.01 * v + 1e-4;
  EXPECT_NEAR(filter.velocity().x, 0.1 * v / p * 0.03, 1e-12);
  EXPECT_NEAR(filter.velocity().x, 0.289, 1e-3);
  EXPECT_EQ(filter.velocity().y, 0.);
  EXPECT_EQ(filter.velocity().theta, 0.);
  const double left = v - 0.01 * v * v / p;
  EXPECT_NEAR(filter.MotionCovariance(0.1)(0, 0), 0.01 * (left + 0.01) + 1e-4,
              1e-12);
}

TEST(VelocityFilterTest, AMatchThatTellsNothingChangesNothing) {
  VelocityFilter filter = Filter();
  filter.Restart(0.1, Pose2(0.04, 0.01, 0.));
  const Eigen::Matrix3d before = filter.MotionCovariance(0.1);
  filter.AddMatch(0.1, filter.Motion(0.1), before);
  EXPECT_NEAR(filter.velocity().x, 0.4, 1e-12);
  EXPECT_NEAR(filter.velocity().y, 0.1, 1e-12);
  // Only time has passed.
  EXPECT_NEAR(filter.MotionCovariance(0.1)(0, 0), before(0, 0) + 1e-4, 1e-12);
}

TEST(VelocityFilterTest, FollowsASteadyDrive) {
  VelocityFilter filter = Filter();
  const Eigen::Matrix3d certain = 1e-6 * Eigen::Matrix3d::Identity();
  for (int i = 0; i < 10; ++i) {
    filter.AddMatch(0.1, Pose2(0.05, 0., 0.03), certain);
  }
  EXPECT_NEAR(filter.velocity().x, 0.5, 0.005);
  // The dying away of a tenth a scan is made up for.
  EXPECT_NEAR(filter.velocity().theta, 0.3, 0.03);
}

TEST(VelocityFilterTest, ChanceDoesNotAddUp) {
  VelocityFilter filter = Filter();
  Random random(1);
  // The turn rate if every chance were taken for a change of it.
  double plain = 0., largest_plain = 0., largest = 0.;
  for (int i = 0; i < 100; ++i) {
    const Pose2 motion = filter.Motion(0.1);
    const Eigen::Matrix3d hardly_less = 0.95 * filter.MotionCovariance(0.1);
    const double chance = random.Normal(0., 0.003);
    filter.AddMatch(0.1, Pose2(motion.x, motion.y, motion.theta + chance),
                    hardly_less);
    plain += chance / 0.1;
    largest_plain = std::max(largest_plain, std::abs(plain));
    largest = std::max(largest, std::abs(filter.velocity().theta));
  }
  EXPECT_LT(largest, 0.6 * largest_plain) << largest_plain;
}

TEST(VelocityFilterTest, ATurnEndsByItself) {
  VelocityFilter filter = Filter();
  filter.Restart(0.1, Pose2(0.05, 0., 0.02));
  EXPECT_NEAR(filter.Motion(0.2).x, 0.1, 1e-12);
  EXPECT_NEAR(filter.Motion(0.2).theta, 0.2 * (1. - std::exp(-0.2)), 1e-12);
  ConstantVelocityOptions options;
  options.turn_time = 1e6;
  VelocityFilter turning = Filter(options);
  turning.Restart(0.1, Pose2(0.05, 0., 0.02));
  EXPECT_NEAR(turning.Motion(0.2).theta, 0.04, 1e-7);
}

TEST(VelocityFilterTest, NumbersThatAreNoneAreSurvived) {
  VelocityFilter filter = Filter();
  filter.AddMatch(
      0.1, Pose2(0.05, 0., 0.),
      Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_NEAR(filter.velocity().x, 0.5, 1e-12);
  EXPECT_TRUE(filter.MotionCovariance(0.1).allFinite());
  // A covariance that grew during the match.
  filter.AddMatch(0.1, Pose2(0.05, 0., 0.), Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d covariance = filter.MotionCovariance(0.1);
  EXPECT_NEAR(covariance(0, 0), 0.01 * (0.25 + 0.01) + 1e-4, 1e-12);
}

// 0.5 m/s and 0.8 rad/s; a scan comes 0.7 s after the one before and shows 0.1 s of
// that.
TEST(VelocityFilterTest, AScanAfterAGapMayBeLate) {
  VelocityFilter filter(ConstantVelocityOptions(), 0.01, 0.01);
  const Pose2 step = Pose2(0., 0., 0.04) * Pose2(0.05, 0., 0.04);
  filter.Restart(0.1, step);
  EXPECT_FALSE(filter.may_be_late());  // there was no interval before
  filter.Restart(0.1, step);
  EXPECT_FALSE(filter.may_be_late());
  filter.Restart(0.7, step);
  ASSERT_TRUE(filter.may_be_late());
  const Pose2 motion = filter.MotionAfterLateScan(0.1);
  EXPECT_NEAR(motion.theta, 0.56, 1e-9);
  EXPECT_NEAR(motion.translation().norm(), 0.35, 0.01);
  // It was: what the scan after it shows beyond the gap is the velocity.
  filter.Restart(0.1, motion);
  EXPECT_FALSE(filter.may_be_late());
  EXPECT_NEAR(filter.velocity().theta, 0.8, 1e-9);
  EXPECT_NEAR(filter.velocity().x, 0.5, 5e-3);
}

TEST(VelocityFilterTest, ARobotThatStopsInAGapHasStopped) {
  VelocityFilter filter(ConstantVelocityOptions(), 0.01, 0.01);
  for (int i = 0; i < 2; ++i) filter.Restart(0.1, Pose2(0.05, 0., 0.));
  filter.Restart(0.7, Pose2(0.06, 0., 0.));
  EXPECT_TRUE(filter.may_be_late());
  filter.Restart(0.1, Pose2(0.001, 0., 0.));
  EXPECT_FALSE(filter.may_be_late());
  EXPECT_NEAR(filter.velocity().x, 0.01, 1e-9);
  // A little less motion is no sign, nor is a gap of many seconds.
  for (int i = 0; i < 2; ++i) filter.Restart(0.1, Pose2(0.05, 0., 0.));
  filter.Restart(0.7, Pose2(0.25, 0., 0.));
  EXPECT_FALSE(filter.may_be_late());
  for (int i = 0; i < 2; ++i) filter.Restart(0.1, Pose2(0.05, 0., 0.));
  filter.Restart(3., Pose2(0.25, 0., 0.));
  EXPECT_FALSE(filter.may_be_late());
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
