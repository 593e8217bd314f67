// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a match that ends a contest with the odometry tells of the velocity, what
// follows a jump, and what follows wheels that slip unseen.
#include "cartographer_ext/front_end/motion_predictor.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Of a scan that also makes up for those before, only its own part counts.
TEST(MotionPredictorContestTest, TheVelocityIsThatOfTheRival) {
  for (const bool ends_contest : {false, true}) {
    MotionPredictor predictor((MotionPredictorOptions()));
    predictor.AddMatch(0., MatchedMotion());
    MatchedMotion matched;
    matched.motion = Pose2(-0.3, 0., 0.);
    matched.ends_contest = ends_contest;
    matched.rival_motion = Pose2(0.05, 0.01, 0.);
    predictor.AddMatch(0.1, matched);
    const MotionPrediction prediction = predictor.Predict(0.2);
    EXPECT_EQ(prediction.source, PredictionSource::kConstantVelocity);
    EXPECT_NEAR(prediction.motion.x, ends_contest ? 0.05 : -0.3, 1e-9);
    EXPECT_NEAR(prediction.motion.y, ends_contest ? 0.01 : 0., 1e-9);
  }
}

// The driver of the laser held a scan back for 0.7 s: while the robot turned by 0.7
// rad, the scan shows 0.1. What the next one shows is known by the odometry since
// the scan before.
TEST(MotionPredictorContestTest, AJumpMayBeALateScan) {
  MotionPredictor predictor((MotionPredictorOptions()));
  for (int i = 0; i <= 19; ++i) {
    predictor.AddOdometry(0.1 * i, Pose2(0., 0., 0.1 * i));
    if (i > 10 && i < 18) continue;
    MatchedMotion matched;
    matched.motion = Pose2(0., 0., i == 0 ? 0. : 0.1);
    if (i <= 18) predictor.AddMatch(0.1 * i, matched);
  }
  EXPECT_EQ(predictor.odometry_state(), OdometryState::kJumping);
  const MotionPrediction prediction = predictor.Predict(1.9);
  EXPECT_TRUE(prediction.is_uncertain);
  EXPECT_NEAR(prediction.motion.theta, 0.1, 1e-9);
  ASSERT_FALSE(prediction.alternatives.empty());
  EXPECT_NEAR(prediction.alternatives[0].theta, 0.8, 1e-9);
}

// In a corridor without features the match follows the wheels, which spin from 5 s
// to 7 s: 0.9 m/s instead of 0.5.
TEST(MotionPredictorContestTest, TheVelocityBeforeTheWheelsSlipped) {
  MotionPredictor predictor((MotionPredictorOptions()));
  double odometry = 0.;
  MotionPrediction prediction;
  for (int i = 0; i <= 70; ++i) {
    const double speed = i > 50 ? 0.9 : 0.5;
    odometry += i == 0 ? 0. : 0.1 * speed;
    predictor.AddOdometry(0.1 * i, Pose2(odometry, 0., 0.));
    prediction = predictor.Predict(0.1 * i);
    MatchedMotion matched;
    matched.motion = prediction.motion;
    if (i > 0 && i <= 40) matched.motion = Pose2(0.05, 0., 0.);
    matched.translation_observable = i <= 40;
    matched.covariance = prediction.covariance;
    matched.from_velocity =
        prediction.source == PredictionSource::kConstantVelocity;
    predictor.AddMatch(0.1 * i, matched);
    if (i <= 52) continue;  // it has to last
    EXPECT_EQ(predictor.odometry_state(), OdometryState::kSlipping) << i;
    EXPECT_EQ(prediction.source, PredictionSource::kConstantVelocity) << i;
    EXPECT_NEAR(prediction.motion.x, 0.05, 1e-3) << i;
  }
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
