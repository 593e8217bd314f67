// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/motion_predictor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

MatchedMotion Matched(const Pose2& motion) {
  MatchedMotion matched;
  matched.motion = motion;
  return matched;
}

TEST(MotionPredictorTest, NothingBeforeTheFirstScan) {
  MotionPredictor predictor((MotionPredictorOptions()));
  const MotionPrediction prediction = predictor.Predict(1.);
  EXPECT_EQ(prediction.source, PredictionSource::kNothing);
  EXPECT_EQ(prediction.motion.x, 0.);
}

TEST(MotionPredictorTest, ConstantVelocityAndItsEnd) {
  MotionPredictorOptions options;
  options.constant_velocity.max_time = 0.6;
  MotionPredictor predictor(options);
  predictor.AddMatch(0., Matched(Pose2()));
  predictor.AddMatch(0.1, Matched(Pose2(0.05, 0., 0.02)));
  const MotionPrediction soon = predictor.Predict(0.3);
  EXPECT_EQ(soon.source, PredictionSource::kConstantVelocity);
  EXPECT_NEAR(soon.motion.x, 0.1, 1e-9);
  // Turns end by themselves.
  EXPECT_NEAR(soon.motion.theta, 0.2 * (1. - std::exp(-0.2)), 1e-9);
  EXPECT_FALSE(soon.is_uncertain);
  // No turn is made up over a long gap.
  const MotionPrediction late = predictor.Predict(3.1);
  EXPECT_EQ(late.source, PredictionSource::kNothing);
  EXPECT_EQ(late.motion.theta, 0.);
  EXPECT_TRUE(late.is_uncertain);
  EXPECT_GT(late.covariance(2, 2), soon.covariance(2, 2));
}

TEST(MotionPredictorTest, OdometryBridgesAGapInTheScans) {
  MotionPredictor predictor((MotionPredictorOptions()));
  // Turns left before the gap, right within it.
  const auto heading = [](const double t) {
    return t < 1. ? 0.5 * t : 0.5 - 0.7 * (t - 1.);
  };
  for (int i = 0; i <= 80; ++i) {
    predictor.AddOdometry(0.05 * i, Pose2(0., 0., heading(0.05 * i)));
  }
  predictor.AddMatch(0.9, Matched(Pose2()));
  predictor.AddMatch(1., Matched(Pose2(0., 0., 0.05)));
  const MotionPrediction prediction = predictor.Predict(4.);
  EXPECT_EQ(prediction.source, PredictionSource::kOdometry);
  EXPECT_NEAR(prediction.motion.theta, -2.1, 1e-9);
  EXPECT_FALSE(prediction.is_uncertain);
}

// A laser that sees a quarter of a circle is trusted less against odometry.
TEST(MotionPredictorTest, TheFieldOfViewWeighsOdometry) {
  const auto covariance = [](const double field_of_view) {
    MotionPredictor predictor((MotionPredictorOptions()));
    predictor.SetFieldOfView(field_of_view);
    for (int i = 0; i <= 40; ++i) {
      predictor.AddOdometry(0.05 * i, Pose2(0.025 * i, 0., 0.));
    }
    predictor.AddMatch(0., Matched(Pose2()));
    const MotionPrediction prediction = predictor.Predict(1.);
    EXPECT_EQ(prediction.source, PredictionSource::kOdometry);
    return prediction.covariance;
  };
  const Eigen::Matrix3d wide = covariance(2. * kPi);
  EXPECT_TRUE(covariance(kPi).isApprox(wide, 1e-12));
  const Eigen::Matrix3d narrow = covariance(0.5 * kPi);
  EXPECT_NEAR(narrow(0, 0), 0.25 * wide(0, 0), 1e-12);
  EXPECT_NEAR(narrow(1, 1), 0.25 * wide(1, 1), 1e-12);
  EXPECT_TRUE(covariance(0.1).isApprox(covariance(1.), 1e-12));
  EXPECT_EQ(narrow(2, 2), wide(2, 2));
}

// A laser of short range crosses a hall without an echo: the robot is where
// odometry says, not where it was last seen.
TEST(MotionPredictorTest, OdometryBridgesMinutes) {
  MotionPredictor predictor((MotionPredictorOptions()));
  predictor.AddOdometry(0., Pose2());
  predictor.AddMatch(0.01, Matched(Pose2()));
  for (int i = 1; i <= 15000; ++i) {
    predictor.AddOdometry(0.02 * i, Pose2(0.01 * i, 0., 0.));
  }
  const MotionPrediction prediction = predictor.Predict(299.99);
  EXPECT_EQ(prediction.source, PredictionSource::kOdometry);
  EXPECT_TRUE(prediction.bridges_gap);
  EXPECT_NEAR(prediction.motion.x, 150., 0.02);
  // Less certain than over one metre.
  EXPECT_GT(prediction.covariance(0, 0), 1.);
}

TEST(MotionPredictorTest, OdometryThatWillTellOfAGapIsMissed) {
  MotionPredictor predictor((MotionPredictorOptions()));
  predictor.AddMatch(0., Matched(Pose2()));
  // There was none before.
  EXPECT_FALSE(predictor.Predict(3.).odometry_pending);
  for (int i = 1; i <= 10; ++i) {
    predictor.AddOdometry(0.1 * i, Pose2(0.05 * i, 0., 0.));
    predictor.AddMatch(0.1 * i, Matched(Pose2(0.05, 0., 0.)));
  }
  EXPECT_FALSE(predictor.Predict(1.1).odometry_pending);
  // Velocity will do.
  EXPECT_FALSE(predictor.Predict(1.5).odometry_pending);
  const MotionPrediction prediction = predictor.Predict(4.);
  EXPECT_EQ(prediction.source, PredictionSource::kNothing);
  EXPECT_TRUE(prediction.odometry_pending);
  predictor.AddOdometry(4.05, Pose2(0.5, 0., 0.8));
  const MotionPrediction later = predictor.Predict(4.1);
  EXPECT_FALSE(later.odometry_pending);
  EXPECT_EQ(later.source, PredictionSource::kOdometry);
  EXPECT_NEAR(later.motion.theta, 0.8, 1e-9);
  // A match without it means that it is gone.
  MotionPredictor other((MotionPredictorOptions()));
  other.AddMatch(0., Matched(Pose2()));
  for (int i = 0; i <= 10; ++i) other.AddOdometry(0.1 * i, Pose2());
  other.AddMatch(1., Matched(Pose2()));
  other.AddMatch(4., Matched(Pose2()));
  EXPECT_FALSE(other.Predict(7.).odometry_pending);
}

TEST(MotionPredictorTest, AJumpWidensThePredictionAndOffersTheVelocity) {
  MotionPredictor predictor((MotionPredictorOptions()));
  for (int i = 0; i <= 10; ++i) {
    predictor.AddOdometry(0.1 * i, Pose2(0.05 * i, 0., 0.));
    predictor.AddMatch(0.1 * i, Matched(Pose2(i == 0 ? 0. : 0.05, 0., 0.)));
  }
  predictor.AddOdometry(1.1, Pose2(1.55, 0., 0.));
  const MotionPrediction prediction = predictor.Predict(1.1);
  EXPECT_TRUE(prediction.is_uncertain);
  ASSERT_EQ(prediction.alternatives.size(), 1);
  EXPECT_NEAR(prediction.alternatives[0].x, 0.05, 1e-9);
  EXPECT_GT(prediction.covariance(0, 0), 0.5);
}

// Stands for two seconds and turns at 0.3 rad/s; the last half second the wheels
// turn by two thirds of it.
TEST(MotionPredictorTest, TheTurnIsWeighedBetweenOdometryAndImuOnceItIsProven) {
  for (const double end : {2.5, 7.}) {
    MotionPredictor predictor((MotionPredictorOptions()));
    double wheels = 0.;
    for (int i = 0; i <= 100 * end; ++i) {
      const double time = 0.01 * i;
      const double rate = i < 200 ? 0. : 0.3;
      predictor.AddImu({time, Eigen::Vector2d::Zero(), rate});
      predictor.AddOdometry(time, Pose2(0., 0., wheels));
      wheels += 0.01 * (time < end - 0.5 ? rate : rate / 1.5);
      if (i % 10 == 0 && time < end - 0.45) {
        predictor.AddMatch(time,
                           Matched(Pose2(0., 0., i <= 200 ? 0. : 0.1 * rate)));
      }
    }
    const MotionPrediction prediction = predictor.Predict(end);
    EXPECT_EQ(prediction.source, PredictionSource::kOdometry);
    const bool is_proven = end > 5.;  // after more than a radian
    EXPECT_NEAR(prediction.motion.theta, is_proven ? 0.15 : 0.1, 0.01);
    // The gyroscope is far surer than the wheels.
    EXPECT_EQ(prediction.covariance(2, 2) < 3e-5, is_proven);
  }
}

// Where the rotation is hardly observable in the scan, the matches of a
// stationary robot jitter; the wheels show that it is stationary, and the
// gyroscope's bias is estimated.
TEST(MotionPredictorTest, StationaryWheelsLetTheImuEstimateItsBias) {
  for (const bool wheels_turn : {false, true}) {
    MotionPredictorOptions options;
    options.imu.yaw_rate_bias_noise = 1e-4;
    MotionPredictor predictor(options);
    const double bias = 0.01;
    for (int i = 0; i <= 40; ++i) {
      const double t = 0.1 * i;
      for (int k = 0; k < 10; ++k) {
        PlanarImuReading reading;
        reading.time = t + 0.01 * k;
        reading.yaw_rate = bias;
        predictor.AddImu(reading);
      }
      predictor.AddOdometry(t, Pose2(0., 0., wheels_turn ? 0.002 * i : 0.));
      // 0.05 rad/s alone do not look stationary.
      predictor.AddMatch(t, Matched(Pose2(0., 0., i % 2 ? 0.005 : -0.005)));
    }
    predictor.AddOdometry(4.05, Pose2(0., 0., wheels_turn ? 0.081 : 0.));
    const MotionPrediction prediction = predictor.Predict(4.05);
    if (wheels_turn) {
      EXPECT_GT(std::abs(prediction.motion.theta), 2e-4);
    } else {
      EXPECT_NEAR(prediction.motion.theta, 0., 1e-5);
    }
  }
}

// Without odometry the translation comes from the velocity of the matches.
// Accelerations within the uncertainty of the bias are ignored, braking is not.
TEST(MotionPredictorTest, SmallAccelerationsAreTakenForBias) {
  for (const double acceleration : {-0.05, -1.}) {
    MotionPredictor predictor((MotionPredictorOptions()));
    for (int i = 0; i <= 420; ++i) {
      PlanarImuReading reading;
      reading.time = 0.01 * i;
      // Stationary for two seconds.
      reading.acceleration.x() = i < 400 ? 0.02 : 0.02 + acceleration;
      predictor.AddImu(reading);
    }
    MatchedMotion matched = Matched(Pose2());
    matched.from_velocity = true;
    matched.covariance = 1e-6 * Eigen::Matrix3d::Identity();
    for (int i = 0; i <= 40; ++i) {
      if (i > 20) matched.motion.x = 0.05;
      predictor.AddMatch(0.1 * i, matched);
    }
    EXPECT_NEAR(predictor.velocity().x, 0.5, 0.01);
    const MotionPrediction prediction = predictor.Predict(4.1);
    EXPECT_EQ(prediction.source, PredictionSource::kImu);
    EXPECT_NEAR(prediction.motion.x, acceleration < -0.5 ? 0.045 : 0.05, 1e-3);
  }
}

TEST(MotionPredictorTest, ImuAloneWhereThereIsNoOdometry) {
  MotionPredictor predictor((MotionPredictorOptions()));
  for (int i = 0; i <= 200; ++i) {
    PlanarImuReading reading;
    reading.time = 0.01 * i;
    reading.yaw_rate = 0.2;
    predictor.AddImu(reading);
  }
  predictor.AddMatch(0., Matched(Pose2()));
  predictor.AddMatch(0.1, Matched(Pose2(0.1, 0., 0.02)));
  const MotionPrediction prediction = predictor.Predict(0.5);
  EXPECT_EQ(prediction.source, PredictionSource::kImu);
  EXPECT_NEAR(prediction.motion.theta, 0.08, 1e-9);
  EXPECT_NEAR(std::hypot(prediction.motion.x, prediction.motion.y), 0.4, 0.01);
}

TEST(MotionPredictorTest, OdometryCanBeSwitchedOff) {
  MotionPredictorOptions options;
  options.use_odometry = false;
  MotionPredictor predictor(options);
  for (int i = 0; i <= 20; ++i) {
    predictor.AddOdometry(0.1 * i, Pose2(0.1 * i, 0., 0.));
  }
  predictor.AddMatch(0.5, Matched(Pose2()));
  EXPECT_EQ(predictor.AddMatch(0.6, Matched(Pose2())), OdometryState::kAbsent);
  EXPECT_EQ(predictor.Predict(0.7).motion.x, 0.);
}

// Matches that fall short by 40 % of every step: the prediction starts from the
// last inserted scan, not from them.
TEST(MotionPredictorTest, OdometryPredictsFromTheLastInsertion) {
  MotionPredictor predictor((MotionPredictorOptions()));
  for (int i = 0; i <= 10; ++i) {
    predictor.AddOdometry(0.1 * i, Pose2(0.02 * i, 0., 0.01 * i));
  }
  predictor.AddMatch(0.2, Matched(Pose2()));
  const double variance = predictor.Predict(0.3).covariance(0, 0);
  predictor.AddMatch(0.3, Matched(Pose2(0.012, 0., 0.)));
  predictor.AddMatch(0.4, Matched(Pose2(0.012, 0., 0.)));
  const MotionPrediction behind = predictor.Predict(0.5);
  EXPECT_NEAR(behind.motion.theta, 0.03, 1e-9);
  // 6 cm of chords of a gentle arc, of which the matches had 2.4 cm.
  EXPECT_NEAR(behind.motion.x, 0.06 - 0.024, 1e-4);
  EXPECT_GT(behind.covariance(0, 0), variance);
  predictor.AddInsertion();
  const MotionPrediction from_map = predictor.Predict(0.5);
  EXPECT_NEAR(from_map.motion.x, 0.02, 1e-4);
  EXPECT_NEAR(from_map.motion.theta, 0.01, 1e-9);
  EXPECT_NEAR(from_map.covariance(0, 0), variance, 1e-6);
}

TEST(MotionPredictorTest, AMapThatNeverGrowsDoesNotBindOdometryForEver) {
  MotionPredictor predictor((MotionPredictorOptions()));
  for (int i = 0; i <= 300; ++i) {
    const double time = 0.1 * i;
    predictor.AddOdometry(time, Pose2(0.05 * i, 0., 0.));
    if (i > 0) {
      const MotionPrediction prediction = predictor.Predict(time);
      // Each match is 1 mm short; twenty of them make a metre.
      EXPECT_NEAR(prediction.motion.x, 0.05, 0.03);
    }
    predictor.AddMatch(time, Matched(Pose2(i == 0 ? 0. : 0.049, 0., 0.)));
  }
}

// One reading every 0.4 s, that of the moment of a scan always after the scan.
TEST(MotionPredictorTest, SlowOdometryIsExtrapolatedAndComparedLater) {
  MotionPredictor predictor((MotionPredictorOptions()));
  for (int i = 0; i <= 20; ++i) {
    const double time = 0.4 * i;
    if (i > 2) {
      const MotionPrediction prediction = predictor.Predict(time);
      EXPECT_EQ(prediction.source, PredictionSource::kOdometry);
      EXPECT_NEAR(prediction.motion.x, 0.2, 1e-9);
      EXPECT_FALSE(prediction.is_uncertain);
      // Hardly more certain than by velocity.
      EXPECT_GT(prediction.covariance(0, 0), 0.2 * 0.2);
    }
    const OdometryState state =
        predictor.AddMatch(time, Matched(Pose2(i == 0 ? 0. : 0.2, 0., 0.)));
    if (i > 2) {
      EXPECT_EQ(state, OdometryState::kOk);
    }
    predictor.AddInsertion();
    predictor.AddOdometry(time, Pose2(0.2 * i, 0., 0.));
  }
  // Later than usual by far: odometry has stopped.
  EXPECT_NE(predictor.Predict(9.2).source, PredictionSource::kOdometry);
}

TEST(MotionPredictorTest, WhatIsUnknownGrowsWithTheGap) {
  MotionPredictor predictor((MotionPredictorOptions()));
  predictor.AddMatch(0., Matched(Pose2()));
  EXPECT_EQ(predictor.Predict(0.3).search_radius, 0.);
  EXPECT_NEAR(predictor.Predict(2.).search_radius, 1., 1e-9);
  EXPECT_NEAR(predictor.Predict(2.).search_angle, 2., 1e-9);
  EXPECT_NEAR(predictor.Predict(20.).search_angle, kPi, 1e-9);
}

// A drive of 60 s with a scan every 0.1 s and odometry every 0.05 s, on which
// the matcher is right within a centimetre and independent of odometry.
struct DriveResult {
  int faults_in = 0;   // detected faults during the fault
  int scans_in = 0;    // scans during the fault
  int faults_out = 0;  // false detections, without a second of recovery
  int scans_out = 0;
  double mean_error = 0.;  // of the predicted translation between scans, metres
};

DriveResult SimulateDrive(const double fault_start, const double fault_end,
                          const std::function<Pose2(double)>& odometry_at) {
  const auto truth = [](const double t) {
    return Pose2(3. * std::sin(0.2 * t), 2. * std::sin(0.4 * t),
                 0.8 * std::sin(0.3 * t));
  };
  MotionPredictor predictor((MotionPredictorOptions()));
  Random random(11);
  DriveResult result;
  double next_odometry = 0.;
  int predictions = 0;
  for (int i = 0; i < 600; ++i) {
    const double t = 0.1 * i;
    while (next_odometry <= t) {
      predictor.AddOdometry(next_odometry, odometry_at(next_odometry));
      next_odometry += 0.05;
    }
    const Pose2 motion = i == 0 ? Pose2() : Between(truth(t - 0.1), truth(t));
    if (i > 1) {
      const MotionPrediction prediction = predictor.Predict(t);
      result.mean_error += std::hypot(prediction.motion.x - motion.x,
                                      prediction.motion.y - motion.y);
      ++predictions;
    }
    const Pose2 matched(motion.x + random.Normal(0., 0.003),
                        motion.y + random.Normal(0., 0.003),
                        motion.theta + random.Normal(0., 0.001));
    const OdometryState state = predictor.AddMatch(t, Matched(matched));
    predictor.AddInsertion();
    const bool is_fault = state != OdometryState::kOk;
    if (t > fault_start + 0.6 && t <= fault_end) {
      ++result.scans_in;
      result.faults_in += is_fault;
    } else if (t <= fault_start || t > fault_end + 1.5) {
      ++result.scans_out;
      result.faults_out += is_fault;
    }
  }
  result.mean_error /= predictions;
  return result;
}

Pose2 Truth(const double t) {
  return Pose2(3. * std::sin(0.2 * t), 2. * std::sin(0.4 * t),
               0.8 * std::sin(0.3 * t));
}

TEST(MotionPredictorTest, FaultFreeDrive) {
  const DriveResult result = SimulateDrive(1e9, 1e9, Truth);
  EXPECT_EQ(result.faults_out, 0);
  EXPECT_LT(result.mean_error, 0.002);
}

TEST(MotionPredictorTest, SlipIsToldAndNotBelieved) {
  // For three seconds odometry runs twice as far.
  const auto odometry = [](const double t) {
    if (t < 30.) return Truth(t);
    const double inside = std::min(t, 33.) - 30.;
    const Pose2 doubled = Truth(30. + 2. * inside);
    return t < 33. ? doubled : doubled * Between(Truth(33.), Truth(t));
  };
  const DriveResult result = SimulateDrive(30., 33., odometry);
  EXPECT_GT(result.faults_in, 0.8 * result.scans_in);
  EXPECT_EQ(result.faults_out, 0);
  EXPECT_LT(result.mean_error, 0.01);
}

TEST(MotionPredictorTest, AStaleBurstIsToldAndBridged) {
  const auto odometry = [](const double t) {
    return Truth(t > 20. && t < 22. ? 20. : t);
  };
  const DriveResult result = SimulateDrive(20., 22., odometry);
  EXPECT_GT(result.faults_in, 0.9 * result.scans_in);
  EXPECT_EQ(result.faults_out, 0);
  EXPECT_LT(result.mean_error, 0.01);
}

// 0.5 m/s, odometry 3 % short, scans every 0.1 s, in which the translation is
// `observable` or not.
double PredictedTranslation(const bool observable) {
  MotionPredictor predictor((MotionPredictorOptions()));
  double odometry_time = 0.;
  for (int i = 0; i <= 500; ++i) {
    for (; odometry_time <= 0.1 * i + 0.06; odometry_time += 0.05) {
      predictor.AddOdometry(odometry_time,
                            Pose2(0.5 * odometry_time / 1.03, 0., 0.));
    }
    MatchedMotion matched = Matched(Pose2(0.05, 0., 0.));
    matched.translation_observable = observable;
    matched.covariance = Eigen::Vector3d(1e-5, 1e-5, 1e-6).asDiagonal();
    predictor.AddMatch(0.1 * i, matched);
    predictor.AddInsertion();
  }
  for (; odometry_time <= 51.1; odometry_time += 0.05) {
    predictor.AddOdometry(odometry_time,
                          Pose2(0.5 * odometry_time / 1.03, 0., 0.));
  }
  return predictor.Predict(51.).motion.x;
}

TEST(MotionPredictorTest, TheScaleOfOdometryIsLearnt) {
  EXPECT_NEAR(PredictedTranslation(true), 0.5, 0.0015);
  // A match that is odometry's own does not confirm it, nor deny it.
  EXPECT_NEAR(PredictedTranslation(false), 0.5 / 1.03, 1e-9);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
