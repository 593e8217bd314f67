// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/matched_motion.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// A corridor along x: nothing along it, a standard deviation of 0.01 m across
// and of 0.01 rad in heading.
LocalMatch InCorridor(const Pose2& pose) {
  LocalMatch match;
  match.pose = match.report.match = pose;
  match.report.covariance = Eigen::Vector3d(1., 1e-4, 1e-4).asDiagonal();
  match.report.scan_information = Eigen::Vector3d(0., 1e4, 1e4).asDiagonal();
  match.report.degeneracy.eigenvalues << 0., 1e4;
  match.report.degeneracy.translation_weights << 0., 1.;
  return match;
}

MotionPrediction ByWheels(const Pose2& motion) {
  MotionPrediction prediction;
  prediction.source = PredictionSource::kOdometry;
  prediction.motion = motion;
  prediction.covariance = Eigen::Vector3d(0.04, 0.01, 0.0025).asDiagonal();
  prediction.heading_by_wheels = true;
  return prediction;
}

TEST(MatchedMotionTest, MotionAndCovarianceAreThoseOfTheLastRobot) {
  const Pose2 last(0., 0., M_PI / 2.);
  cartographer::sensor::PointCloud cloud;
  cloud.push_back({Eigen::Vector3f(3.f, 4.f, 9.f)});
  cloud.push_back({Eigen::Vector3f(0.f, 1.f, 0.f)});
  const MatchedMotion matched =
      ToMatchedMotion(last, ByWheels(Pose2()),
                      InCorridor(Pose2(0., 0.5, M_PI / 2. + 0.1)), cloud);
  EXPECT_NEAR(matched.motion.x, 0.5, 1e-12);
  EXPECT_NEAR(matched.motion.y, 0., 1e-12);
  EXPECT_NEAR(matched.motion.theta, 0.1, 1e-12);
  // Along the corridor is to the side of that robot.
  EXPECT_NEAR(matched.covariance(0, 0), 1e-4, 1e-12);
  EXPECT_NEAR(matched.covariance(1, 1), 1., 1e-12);
  EXPECT_TRUE(matched.translation_observable);  // it drove across
  EXPECT_TRUE(matched.rotation_observable);
  EXPECT_NEAR(matched.scan_heading_sigma, 1. / std::sqrt(1e4 + 1.), 1e-12);
  EXPECT_NEAR(matched.mean_range, 3., 1e-6);
  EXPECT_FALSE(matched.from_velocity);
}

TEST(MatchedMotionTest, AlongACorridorTheTranslationIsNotObservable) {
  const auto observable = [](const Pose2& to) {
    return ToMatchedMotion(Pose2(), ByWheels(Pose2()), InCorridor(to), {})
        .translation_observable;
  };
  EXPECT_FALSE(observable(Pose2(0.5, 0., 0.)));
  EXPECT_FALSE(observable(Pose2(0.5, 0.4, 0.)));  // weight 0.39
  EXPECT_TRUE(observable(Pose2(0.4, 0.5, 0.)));   // weight 0.61
  // A robot that stands counts by where it looks.
  EXPECT_FALSE(observable(Pose2(0.001, 0., 0.)));
  EXPECT_TRUE(observable(Pose2(0.001, 0., M_PI / 2.)));
}

TEST(MatchedMotionTest, VelocityIsAPredictionUnlessTheMatchWasRelocated) {
  MotionPrediction prediction;
  prediction.source = PredictionSource::kConstantVelocity;
  LocalMatch match = InCorridor(Pose2());
  EXPECT_TRUE(ToMatchedMotion(Pose2(), prediction, match, {}).from_velocity);
  match.relocated = true;
  EXPECT_FALSE(ToMatchedMotion(Pose2(), prediction, match, {}).from_velocity);
}

TEST(MatchedMotionTest, InnovationsAreAcrossTheCorridorAndOfTheHeading) {
  const LocalMatch match = InCorridor(Pose2(1.3, 0.2, 0.05));
  const MatchInnovation innovation =
      InnovationOf(Pose2(), ByWheels(Pose2(1., 0., 0.)), match, 10.);
  EXPECT_NEAR(innovation.along.squared, 0.04, 1e-12);
  EXPECT_NEAR(innovation.along.match_variance, 1e-4, 1e-12);
  EXPECT_NEAR(innovation.along.prediction_variance, 0.01, 1e-12);
  EXPECT_NEAR(innovation.heading.squared, 0.0025, 1e-12);
  EXPECT_NEAR(innovation.heading.prediction_variance, 0.0025, 1e-12);
}

TEST(MatchedMotionTest, NothingIsLearntFromOtherPredictionsAndDoubtfulMatches) {
  const auto squared = [](const MotionPrediction& prediction,
                          const LocalMatch& match) {
    return InnovationOf(Pose2(), prediction, match, 10.).along.squared;
  };
  LocalMatch match = InCorridor(Pose2(1., 0.2, 0.));
  MotionPrediction prediction = ByWheels(Pose2(1., 0., 0.));
  ASSERT_GT(squared(prediction, match), 0.);
  match.report.mahalanobis = 11.;  // of a match that was not searched
  EXPECT_GT(squared(prediction, match), 0.);
  match.searched = true;
  EXPECT_EQ(squared(prediction, match), 0.);
  match.searched = false;
  prediction.is_uncertain = true;
  EXPECT_EQ(squared(prediction, match), 0.);
  prediction.is_uncertain = false;
  prediction.source = PredictionSource::kImu;
  EXPECT_EQ(squared(prediction, match), 0.);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
