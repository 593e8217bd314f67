// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a match that ends a contest with the odometry tells of the velocity.
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

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
