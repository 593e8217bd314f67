// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/metrics/trajectory_metrics.h"

#include <cmath>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr io::TimeNs kSecond = 1000000000;

Trajectory FromPoses(const std::vector<Pose2>& poses) {
  std::vector<StampedPose> stamped;
  for (size_t i = 0; i < poses.size(); ++i) {
    stamped.push_back(
        {static_cast<io::TimeNs>(i) * kSecond, ToIsometry(poses[i])});
  }
  return Trajectory(stamped);
}

TEST(TrajectoryMetricsTest, AlignmentUndoesARigidMotion) {
  const std::vector<Pose2> truth = {Pose2(0., 0., 0.), Pose2(2., 0., 0.5),
                                    Pose2(3., 1., 1.5), Pose2(2., 4., 3.)};
  const Pose2 motion(5., -3., 2.);
  std::vector<Pose2> moved;
  for (const Pose2& pose : truth) moved.push_back(motion.Inverse() * pose);
  const auto errors = ComputeTrajectoryErrors(
      FromPoses(moved), FromPoses(truth), TrajectoryMetricsOptions());
  ASSERT_TRUE(errors.ok());
  EXPECT_EQ(errors->num_pairs, 4);
  EXPECT_NEAR(errors->alignment.x, motion.x, 1e-9);
  EXPECT_NEAR(errors->alignment.y, motion.y, 1e-9);
  EXPECT_NEAR(errors->alignment.theta, motion.theta, 1e-9);
  EXPECT_NEAR(errors->ate.rmse, 0., 1e-9);
  EXPECT_NEAR(errors->ate_rotation_degrees.max, 0., 1e-6);
  EXPECT_NEAR(errors->rpe.max, 0., 1e-9);
}

TEST(TrajectoryMetricsTest, DoesNotScale) {
  // Twice too long: centred points -2, 0, 2 against -1, 0, 1.
  const auto errors = ComputeTrajectoryErrors(
      FromPoses({Pose2(0., 0., 0.), Pose2(2., 0., 0.), Pose2(4., 0., 0.)}),
      FromPoses({Pose2(0., 0., 0.), Pose2(1., 0., 0.), Pose2(2., 0., 0.)}),
      TrajectoryMetricsOptions());
  ASSERT_TRUE(errors.ok());
  EXPECT_NEAR(errors->ate.rmse, std::sqrt(2. / 3.), 1e-12);
  EXPECT_NEAR(errors->ate.mean, 2. / 3., 1e-12);
  EXPECT_NEAR(errors->ate.max, 1., 1e-12);
  ASSERT_EQ(errors->distances.size(), 3u);
  EXPECT_NEAR(errors->distances[1], 0., 1e-12);
  // One metre of the reference is two of the estimate, twice.
  EXPECT_EQ(errors->rpe.count, 2);
  EXPECT_NEAR(errors->rpe.mean, 1., 1e-12);
}

TEST(TrajectoryMetricsTest, RelativeErrorSeesTheTurnOnlyWhereItHappens) {
  // The estimate misses a turn by 0.1 rad between the poses 1 and 2.
  const auto errors = ComputeTrajectoryErrors(
      FromPoses({Pose2(0., 0., 0.), Pose2(1., 0., 0.), Pose2(2., 0., 0.1),
                 Pose2(2. + std::cos(0.1), std::sin(0.1), 0.1)}),
      FromPoses({Pose2(0., 0., 0.), Pose2(1., 0., 0.), Pose2(2., 0., 0.),
                 Pose2(3., 0., 0.)}),
      TrajectoryMetricsOptions());
  ASSERT_TRUE(errors.ok());
  EXPECT_EQ(errors->rpe.count, 3);
  EXPECT_NEAR(errors->rpe.max, 0., 1e-12);
  EXPECT_NEAR(errors->rpe_rotation_degrees.max, RadToDeg(0.1), 1e-9);
  EXPECT_NEAR(errors->rpe_rotation_degrees.mean, RadToDeg(0.1) / 3., 1e-9);
}

TEST(TrajectoryMetricsTest, AStandingRobotIsAlignedByItsHeading) {
  const auto errors = ComputeTrajectoryErrors(
      FromPoses({Pose2(1., 1., 0.), Pose2(1., 1., 0.5)}),
      FromPoses({Pose2(4., 0., 1.), Pose2(4., 0., 1.5)}),
      TrajectoryMetricsOptions());
  ASSERT_TRUE(errors.ok());
  EXPECT_NEAR(errors->alignment.theta, 1., 1e-12);
  EXPECT_NEAR(errors->ate.max, 0., 1e-12);
  EXPECT_NEAR(errors->ate_rotation_degrees.max, 0., 1e-9);
}

TEST(TrajectoryMetricsTest, ErrorsWithoutOverlap) {
  const Trajectory early = FromPoses({Pose2(), Pose2(1., 0., 0.)});
  const Trajectory late({{100 * kSecond, ToIsometry(Pose2())},
                         {101 * kSecond, ToIsometry(Pose2(1., 0., 0.))}});
  const TrajectoryMetricsOptions options;
  EXPECT_THAT(ComputeTrajectoryErrors(early, late, options).status().message(),
              testing::HasSubstr("covers 0 of the 2 estimated poses"));
  EXPECT_THAT(
      ComputeTrajectoryErrors(Trajectory(), late, options).status().message(),
      testing::HasSubstr("estimated trajectory is empty"));
  EXPECT_THAT(
      ComputeTrajectoryErrors(early, Trajectory(), options).status().message(),
      testing::HasSubstr("reference is empty"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
