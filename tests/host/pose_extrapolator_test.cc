// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/pose_extrapolator.h"

#include <cmath>
#include <memory>
#include <vector>

#include "cartographer/mapping/imu_tracker.h"
#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

using transform::Rigid3d;

common::Time At(const double seconds) {
  return common::FromUniversal(1000) + common::FromSeconds(seconds);
}

Rigid3d Planar(const double x, const double y, const double yaw) {
  return Rigid3d(Eigen::Vector3d(x, y, 0.),
                 Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                     Eigen::Quaterniond::Identity());
}

void ExpectNear(const Rigid3d& actual, const Rigid3d& expected) {
  EXPECT_LT((actual.translation() - expected.translation()).norm(), 1e-9)
      << actual.DebugString() << " " << expected.DebugString();
  EXPECT_LT(transform::GetAngle(actual.inverse() * expected), 1e-7)
      << actual.DebugString() << " " << expected.DebugString();
}

TEST(ImuTrackerTest, IntegratesRotation) {
  ImuTracker tracker(10., At(0));
  tracker.AddImuLinearAccelerationObservation(Eigen::Vector3d(0., 0., 9.81));
  tracker.AddImuAngularVelocityObservation(Eigen::Vector3d(0., 0., 0.5));
  tracker.Advance(At(2));
  EXPECT_EQ(tracker.time(), At(2));
  EXPECT_NEAR(transform::GetYaw(tracker.orientation()), 1., 1e-9);
}

TEST(ImuTrackerTest, FirstAccelerationCountsFullyLaterOnesByTime) {
  ImuTracker tracker(10., At(0));
  // Tilted by atan(1/2) around y.
  tracker.AddImuLinearAccelerationObservation(Eigen::Vector3d(1., 0., 2.));
  EXPECT_LT((tracker.orientation() * Eigen::Vector3d(1., 0., 2.).normalized() -
             Eigen::Vector3d::UnitZ())
                .norm(),
            1e-9);
  tracker.Advance(At(10));
  tracker.AddImuLinearAccelerationObservation(Eigen::Vector3d(0., 0., 2.));
  // 1 - 1/e of the turn towards the new direction: (1/e, 0, 2).
  EXPECT_LT((tracker.orientation() *
                 Eigen::Vector3d(std::exp(-1.), 0., 2.).normalized() -
             Eigen::Vector3d::UnitZ())
                .norm(),
            1e-9);
}

TEST(ImuTrackerTest, IgnoresReadingsThatSayNothing) {
  ImuTracker tracker(10., At(0));
  tracker.AddImuLinearAccelerationObservation(Eigen::Vector3d::Zero());
  tracker.AddImuLinearAccelerationObservation(
      Eigen::Vector3d::Constant(std::nan("")));
  tracker.AddImuAngularVelocityObservation(Eigen::Vector3d::Constant(INFINITY));
  tracker.Advance(At(1));
  EXPECT_TRUE(tracker.orientation().isApprox(Eigen::Quaterniond::Identity()));
}

TEST(PoseExtrapolatorTest, StandsStillAfterOnePose) {
  PoseExtrapolator extrapolator(common::FromSeconds(0.1), 10.);
  EXPECT_EQ(extrapolator.GetLastPoseTime(), common::Time::min());
  EXPECT_EQ(extrapolator.GetLastExtrapolatedTime(), common::Time::min());
  extrapolator.AddPose(At(1), Planar(1., 2., 0.3));
  EXPECT_EQ(extrapolator.GetLastPoseTime(), At(1));
  ExpectNear(extrapolator.ExtrapolatePose(At(5)), Planar(1., 2., 0.3));
  EXPECT_EQ(extrapolator.GetLastExtrapolatedTime(), At(5));
}

TEST(PoseExtrapolatorTest, ConstantVelocityFromPoses) {
  PoseExtrapolator extrapolator(common::FromSeconds(0.5), 10.);
  for (int i = 0; i <= 10; ++i) {
    extrapolator.AddPose(At(0.1 * i), Planar(0.2 * i, -0.1 * i, 0.05 * i));
  }
  ExpectNear(extrapolator.ExtrapolatePose(At(1.4)), Planar(2.8, -1.4, 0.7));
}

TEST(PoseExtrapolatorTest, VelocitySpansTheQueueOnly) {
  PoseExtrapolator extrapolator(common::FromSeconds(1.), 10.);
  extrapolator.AddPose(At(0), Planar(0., 0., 0.));
  extrapolator.AddPose(At(1), Planar(5., 0., 0.));
  // The pose at 0 is dropped now: one at or before 1 s ago is left.
  extrapolator.AddPose(At(2), Planar(6., 0., 0.));
  ExpectNear(extrapolator.ExtrapolatePose(At(3)), Planar(7., 0., 0.));
}

TEST(PoseExtrapolatorTest, OdometryReplacesVelocityOfPoses) {
  PoseExtrapolator extrapolator(common::FromSeconds(0.1), 10.);
  extrapolator.AddPose(At(0), Planar(0., 0., M_PI / 2));
  extrapolator.AddPose(At(1), Planar(1., 0., M_PI / 2));
  // Odometry has another origin, and moves forward at 2 m/s.
  extrapolator.AddOdometryData({At(1.0), Planar(7., 7., 0.)});
  extrapolator.AddOdometryData({At(1.5), Planar(8., 7., 0.)});
  ExpectNear(extrapolator.ExtrapolatePose(At(2.)), Planar(1., 2., M_PI / 2));
}

TEST(PoseExtrapolatorTest, TurningOdometry) {
  PoseExtrapolator extrapolator(common::FromSeconds(0.1), 10.);
  extrapolator.AddPose(At(0), Planar(0., 0., 0.));
  extrapolator.AddOdometryData({At(0), Planar(0., 0., 0.)});
  extrapolator.AddOdometryData({At(1), Planar(0., 0., 0.5)});
  extrapolator.AddPose(At(1), Planar(0., 0., 0.5));
  extrapolator.AddOdometryData({At(2), Planar(0., 0., 1.)});
  ExpectNear(extrapolator.ExtrapolatePose(At(3)), Planar(0., 0., 1.5));
}

TEST(PoseExtrapolatorTest, DropsLateAndRepeatedReadings) {
  PoseExtrapolator extrapolator(common::FromSeconds(0.1), 10.);
  extrapolator.AddPose(At(1), Planar(0., 0., 0.));
  extrapolator.AddOdometryData({At(0.5), Planar(100., 0., 0.)});
  extrapolator.AddImuData(
      {At(0.5), Eigen::Vector3d(9., 0., 0.), Eigen::Vector3d(0., 0., 9.)});
  extrapolator.AddOdometryData({At(1), Planar(0., 0., 0.)});
  extrapolator.AddOdometryData({At(1), Planar(50., 0., 0.)});
  extrapolator.AddOdometryData({At(2), Planar(1., 0., 0.)});
  ExpectNear(extrapolator.ExtrapolatePose(At(3)), Planar(2., 0., 0.));
}

TEST(PoseExtrapolatorTest, GyroscopeTellsTheTurn) {
  const sensor::ImuData first{At(0), Eigen::Vector3d(0., 0., 9.8),
                              Eigen::Vector3d(0., 0., 1.)};
  const auto extrapolator =
      PoseExtrapolator::InitializeWithImu(common::FromSeconds(0.1), 10., first);
  ExpectNear(extrapolator->ExtrapolatePose(At(0)), Rigid3d::Identity());
  extrapolator->AddImuData(
      {At(1), Eigen::Vector3d(0., 0., 9.8), Eigen::Vector3d(0., 0., -1.)});
  // One second at 1 rad/s, then half a second back.
  ExpectNear(extrapolator->ExtrapolatePose(At(1.5)), Planar(0., 0., 0.5));
}

TEST(PoseExtrapolatorTest, StartsUpright) {
  const sensor::ImuData tilted{At(0), Eigen::Vector3d(3., 0., 4.),
                               Eigen::Vector3d::Zero()};
  const auto extrapolator = PoseExtrapolator::InitializeWithImu(
      common::FromSeconds(0.1), 10., tilted);
  const Eigen::Quaterniond gravity =
      extrapolator->EstimateGravityOrientation(At(0));
  EXPECT_LT((gravity * Eigen::Vector3d(0.6, 0., 0.8) - Eigen::Vector3d::UnitZ())
                .norm(),
            1e-9);
}

TEST(PoseExtrapolatorTest, ExtrapolatesManyAtOnce) {
  PoseExtrapolator extrapolator(common::FromSeconds(0.1), 10.);
  extrapolator.AddPose(At(0), Planar(0., 0., 0.));
  extrapolator.AddPose(At(1), Planar(1., 0., 0.));
  const auto result =
      extrapolator.ExtrapolatePosesWithGravity({At(1), At(1.5), At(2)});
  ASSERT_EQ(result.previous_poses.size(), 2);
  EXPECT_NEAR(result.previous_poses[1].translation().x(), 1.5, 1e-6);
  ExpectNear(result.current_pose, Planar(2., 0., 0.));
  EXPECT_LT((result.current_velocity - Eigen::Vector3d(1., 0., 0.)).norm(),
            1e-9);
}

TEST(PoseExtrapolatorDeathTest, TheImuBasedMethodIsRefused) {
  proto::PoseExtrapolatorOptions options;
  options.set_use_imu_based(true);
  EXPECT_DEATH(
      PoseExtrapolatorInterface::CreateWithImuData(
          options, {{At(0), Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()}},
          {}),
      "use_imu_based");
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
