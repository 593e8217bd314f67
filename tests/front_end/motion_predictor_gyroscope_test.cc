// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// MotionPredictor over gaps, and with a gyroscope whose proof is at stake.
#include <cmath>
#include <memory>

#include "cartographer_ext/front_end/motion_predictor.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Half a metre a second; to and fro by 0.5 rad/s for 2 s every 5 s.
double Rate(const double time) {
  const double phase = std::fmod(time, 10.);
  if (phase >= 3. && phase < 5.) return 0.5;
  if (phase >= 8. && phase < 10.) return -0.5;
  return 0.;
}

class MotionPredictorGyroscopeTest : public testing::Test {
 protected:
  MotionPredictorGyroscopeTest() { Restart(); }

  void Restart() {
    predictor_.reset(new MotionPredictor(MotionPredictorOptions()));
    time_ = 0.;
    true_ = wheels_ = Pose2();
  }

  // With a scan every tenth of a second that has the right motion.
  void Drive(const double seconds, const double wheel_drift,
             const bool has_scans, const int scans_in_map) {
    const double end = time_ + seconds;
    Pose2 since;
    for (int i = 1; time_ < end - 0.005; ++i) {
      const Pose2 step(0.005, 0., 0.01 * Rate(time_));
      since = since * step;
      true_ = true_ * step;
      wheels_ = wheels_ * Pose2(0.005, 0., step.theta + 0.01 * wheel_drift);
      predictor_->AddImu({time_, Eigen::Vector2d::Zero(), Rate(time_)});
      time_ += 0.01;
      predictor_->AddImu(
          {time_ - 1e-6, Eigen::Vector2d::Zero(), Rate(time_ - 0.01)});
      if (i % 5 == 0) predictor_->AddOdometry(time_, wheels_);
      if (!has_scans || i % 10 != 0) continue;
      MatchedMotion matched;
      matched.motion = since;
      matched.scans_in_map = scans_in_map;
      predictor_->AddMatch(time_, matched);
      predictor_->AddInsertion();
      since = Pose2();
    }
  }

  std::unique_ptr<MotionPredictor> predictor_;
  double time_ = 0.;
  Pose2 true_, wheels_;
};

// Wheels that turn by 0.3 rad/s too much never agree with it.
TEST_F(MotionPredictorGyroscopeTest, AMapOfAFewScansIsNoEvidence) {
  Drive(30., 0.3, true, 5);
  EXPECT_EQ(predictor_->gyroscope().state(), GyroscopeState::kUnproven);
  Drive(30., 0.3, true, 50);
  EXPECT_EQ(predictor_->gyroscope().state(), GyroscopeState::kProven);
}

TEST_F(MotionPredictorGyroscopeTest, AGapIsBridgedByDeadReckoning) {
  for (const bool has_scans : {true, false}) {
    SCOPED_TRACE(has_scans);
    Restart();
    Drive(1., 0.02, true, 5);
    Drive(30., 0.02, has_scans, 50);
    Drive(0.1, 0.02, true, 50);
    const Pose2 start = true_, wheels_start = wheels_;
    Drive(40., 0.02, false, 0);
    const MotionPrediction prediction = predictor_->Predict(time_);
    EXPECT_EQ(prediction.source, PredictionSource::kOdometry);
    const Pose2 expected = Between(start, true_);
    const Pose2 by_wheels = Between(wheels_start, wheels_);
    ASSERT_GT(std::abs(NormalizeAngle(by_wheels.theta - expected.theta)), 0.5);
    EXPECT_NEAR(prediction.motion.theta, expected.theta, 0.05);
    EXPECT_LT((prediction.motion.translation() - expected.translation()).norm(),
              0.05 * 20.);
  }
}

// The heading is that of the gyroscope either way, and it counts once. Straight on,
// as the accelerometer says.
TEST_F(MotionPredictorGyroscopeTest, DoubtfulMetresMakeNoHeadingMoreCertain) {
  double variances[2];
  for (const bool jumps : {false, true}) {
    Restart();
    Drive(30., 0., true, 50);
    if (jumps) wheels_ = wheels_ * Pose2(20., 0., 0.);
    Drive(2.5, 0., false, 0);
    const MotionPrediction prediction = predictor_->Predict(time_);
    EXPECT_EQ(prediction.is_uncertain, jumps);
    variances[jumps] = prediction.covariance(2, 2);
  }
  EXPECT_GT(variances[1], 0.9 * variances[0]);
}

// Where odometry jumped, the robot may have stood for seconds, not for minutes.
TEST(MotionPredictorGapTest, StandingStillIsAnAlternativeForAWhile) {
  MotionPredictor predictor((MotionPredictorOptions()));
  for (int i = 0; i <= 400; ++i) {
    predictor.AddOdometry(0.05 * i, Pose2(0.02 * i + (i > 60), 0., 0.));
  }
  predictor.AddMatch(0.9, MatchedMotion());
  predictor.AddMatch(1., MatchedMotion());
  ASSERT_EQ(predictor.Predict(4.).alternatives.size(), 1u);
  EXPECT_EQ(predictor.Predict(4.).alternatives[0].x, 0.);
  EXPECT_TRUE(predictor.Predict(8.).alternatives.empty());
}

// Scans a metre apart: that the robot stood is no explanation of steady wheels,
// however rare their readings are.
TEST(MotionPredictorGapTest, SteadyWheelsDidNotJump) {
  for (const int readings_per_scan : {1, 15}) {
    MotionPredictor predictor((MotionPredictorOptions()));
    Pose2 odometry;
    for (int scan = 0; scan < 4; ++scan) {
      for (int i = 0; i < readings_per_scan; ++i) {
        const int count = scan * readings_per_scan + i + 1;
        odometry.x = 1. * count / readings_per_scan;
        predictor.AddOdometry(1.5 * odometry.x, odometry);
      }
      MatchedMotion match;
      match.motion.x = 1.;
      predictor.AddMatch(1.5 * (scan + 1), match);
    }
    ASSERT_EQ(predictor.odometry_state(), OdometryState::kOk);
    // One of twice the distance, as far as a single reading tells, is a jump.
    for (const double distance : {1., 2.}) {
      MotionPredictor next = predictor;
      for (int i = 1; i <= readings_per_scan; ++i) {
        next.AddOdometry(6. + 1.5 * i / readings_per_scan,
                         Pose2(4. + distance * i / readings_per_scan, 0., 0.));
      }
      const bool is_steady = distance == 1. || readings_per_scan > 1;
      EXPECT_EQ(next.Predict(7.5).alternatives.empty(), is_steady);
      EXPECT_EQ(next.Predict(7.5).hints.empty(), !is_steady);
    }
  }
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
