// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_calibration.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr double kStep = 0.1;  // seconds

OdometryCalibrationOptions TranslationAndRotation() {
  OdometryCalibrationOptions options;
  options.estimate_rotation = true;
  return options;
}

// A robot whose odometry is wrong by constant factors.
class Robot {
 public:
  Robot(const uint64_t seed, const double translation_scale,
        const double rotation_scale, const double rotation_per_metre,
        const double noise = 1.)
      : random_(seed),
        noise_(noise),
        translation_scale_(translation_scale),
        rotation_scale_(rotation_scale),
        rotation_per_metre_(rotation_per_metre) {}

  // 0.5 m/s on a winding path; odometry goes `slip` times as far.
  CalibrationInterval Step(const double slip = 1., const double step = kStep) {
    time_ += step;
    const double distance = 0.5 * step;
    const double turn = 0.5 * step * std::sin(0.3 * time_);
    CalibrationInterval interval;
    interval.time = time_;
    interval.interval = step;
    // The errors of the matched poses are not those of motions.
    const double translation_error = random_.Normal(0., 0.004 * noise_);
    const double rotation_error = random_.Normal(0., 0.001 * noise_);
    interval.match = Arc(distance + translation_error - translation_error_,
                         turn + rotation_error - rotation_error_);
    translation_error_ = translation_error;
    rotation_error_ = rotation_error;
    const double odometry_translation =
        distance / translation_scale_ * slip +
        random_.Normal(0., 0.003 * noise_ * std::sqrt(distance));
    interval.odometry = Arc(
        odometry_translation,
        (turn - rotation_per_metre_ * odometry_translation) / rotation_scale_ +
            random_.Normal(0., 0.01 * noise_ * std::sqrt(distance)));
    interval.covariance = Eigen::Vector3d(1.6e-5, 1.6e-5, 1e-6).asDiagonal();
    return interval;
  }

 private:
  static Pose2 Arc(const double distance, const double turn) {
    return Pose2(distance * std::cos(0.5 * turn),
                 distance * std::sin(0.5 * turn), turn);
  }

  Random random_;
  const double noise_;  // factor
  const double translation_scale_;
  const double rotation_scale_;
  const double rotation_per_metre_;
  double time_ = 100.;
  double translation_error_ = 0.;
  double rotation_error_ = 0.;
};

// Means of the squared errors by their variances, of many runs over 50 m.
struct SquaredErrors {
  double translation = 0., rotation = 0., per_metre = 0.;
};
SquaredErrors ErrorsOfManyRuns(const double noise) {
  SquaredErrors errors;
  constexpr int kRuns = 30;
  for (int run = 0; run < kRuns; ++run) {
    Robot robot(run + 1, 1.03, 0.97, -0.02, noise);
    OdometryCalibration calibration(TranslationAndRotation());
    for (int i = 0; i < 1000; ++i) calibration.Add(robot.Step());
    EXPECT_NEAR(calibration.translation_scale(), 1.03, 0.004 * noise);
    EXPECT_NEAR(calibration.rotation_scale(), 0.97, 0.02 * noise);
    EXPECT_NEAR(calibration.rotation_per_metre(), -0.02, 0.006 * noise);
    EXPECT_LT(calibration.translation_scale_sigma(), 0.002 * noise);
    errors.translation += std::pow((calibration.translation_scale() - 1.03) /
                                       calibration.translation_scale_sigma(),
                                   2) /
                          kRuns;
    errors.rotation += std::pow((calibration.rotation_scale() - 0.97) /
                                    calibration.rotation_scale_sigma(),
                                2) /
                       kRuns;
    errors.per_metre += std::pow((calibration.rotation_per_metre() + 0.02) /
                                     calibration.rotation_per_metre_sigma(),
                                 2) /
                        kRuns;
  }
  return errors;
}

TEST(OdometryCalibrationTest, FindsTheScalesAndHowSureTheyAre) {
  const SquaredErrors errors = ErrorsOfManyRuns(1.);
  // Not surer than it may be; it reckons with worse wheels and matches.
  EXPECT_LT(errors.translation, 1.2);
  EXPECT_LT(errors.rotation, 1.2);
  EXPECT_LT(errors.per_metre, 1.2);
}

TEST(OdometryCalibrationTest, LessSureOfWorseWheelsAndMatches) {
  // One factor for wheels and matches, whose variances are eleven and six times as
  // large as assumed for rotations.
  const SquaredErrors errors = ErrorsOfManyRuns(5.);
  EXPECT_LT(errors.translation, 1.6);
  EXPECT_LT(errors.rotation, 2.5);
  EXPECT_LT(errors.per_metre, 2.5);
}

// On a straight way wheels turn by their noise alone, which tells nothing about
// the scale of rotations.
TEST(OdometryCalibrationTest, NoiseOfTheWheelsDoesNotDiluteTheScale) {
  Random random(4);
  OdometryCalibration calibration(TranslationAndRotation());
  double error = 0.;
  for (int i = 0; i < 2000; ++i) {  // 100 m
    CalibrationInterval interval;
    interval.time = 100. + kStep * i;
    interval.interval = kStep;
    const double last_error = error;
    error = random.Normal(0., 0.001);
    interval.match = Pose2(0.05, 0., error - last_error);
    interval.odometry = Pose2(
        0.05, 0., 0.02 * 0.05 + random.Normal(0., 0.015 * std::sqrt(0.05)));
    interval.covariance = Eigen::Vector3d(1.6e-5, 1.6e-5, 1e-6).asDiagonal();
    calibration.Add(interval);
  }
  EXPECT_NEAR(calibration.rotation_scale(), 1., 0.01);
  EXPECT_NEAR(calibration.rotation_scale_sigma(), 0.03, 0.002);
  EXPECT_NEAR(calibration.rotation_per_metre(), -0.02, 0.01);
}

TEST(OdometryCalibrationTest, ASlipIsKeptOut) {
  Robot robot(5, 1., 1., 0.), same(5, 1., 1., 0.);
  OdometryCalibration calibration(TranslationAndRotation());
  OdometryCalibration warned(TranslationAndRotation());
  for (int i = 0; i < 800; ++i) {
    // Every 20 s wheels slip for 2 s by a tenth, and nothing is said until it
    // has lasted a second.
    const int phase = i % 200;
    CalibrationInterval interval = robot.Step(phase >= 180 ? 1.1 : 1.);
    calibration.Add(interval);
    interval.is_sound = phase < 190;
    warned.Add(interval);
  }
  EXPECT_NEAR(warned.translation_scale(), 1., 0.003);
  // So it was the warning that helped.
  EXPECT_LT(calibration.translation_scale(), 0.995);
}

TEST(OdometryCalibrationTest, WhereTheScanDoesNotTellNothingIsLearnt) {
  Robot robot(6, 1.03, 0.97, 0.01);
  const OdometryCalibrationOptions options = TranslationAndRotation();
  OdometryCalibration no_translation(options), no_rotation(options),
      uncertain(options);
  for (int i = 0; i < 600; ++i) {
    CalibrationInterval interval = robot.Step();
    interval.translation_observable = i % 5 != 0;
    no_translation.Add(interval);
    interval.translation_observable = true;
    interval.rotation_observable = i % 5 != 0;
    no_rotation.Add(interval);
    interval.rotation_observable = true;
    interval.covariance.diagonal().setConstant(0.01);
    uncertain.Add(interval);
  }
  EXPECT_EQ(no_translation.translation_scale(), 1.);
  EXPECT_NEAR(no_translation.translation_scale_sigma(),
              options.translation_scale_sigma, 1e-12);
  EXPECT_LT(no_translation.rotation_scale(), 0.99);
  EXPECT_GT(no_rotation.translation_scale(), 1.02);
  EXPECT_EQ(no_rotation.rotation_scale(), 1.);
  EXPECT_EQ(no_rotation.rotation_per_metre(), 0.);
  EXPECT_EQ(uncertain.translation_scale(), 1.);
  EXPECT_EQ(uncertain.rotation_scale(), 1.);
}

TEST(OdometryCalibrationTest, GapsAndStandingTellNothing) {
  Robot robot(7, 1.03, 1., 0.);
  OdometryCalibration gaps(TranslationAndRotation());
  OdometryCalibration stationary(TranslationAndRotation());
  Random random(8);
  for (int i = 0; i < 600; ++i) {
    CalibrationInterval interval = robot.Step();
    if (i % 15 == 0) interval.interval = 1.5;
    gaps.Add(interval);
    interval.interval = kStep;
    interval.odometry = Pose2();
    interval.match = Pose2(random.Normal(0., 0.001), 0., 0.);
    stationary.Add(interval);
  }
  EXPECT_EQ(gaps.translation_scale(), 1.);
  EXPECT_EQ(stationary.translation_scale(), 1.);
}

// A recording with a scan every metre.
TEST(OdometryCalibrationTest, ScansThatAreAlwaysFarApartAreNoGaps) {
  Robot robot(3, 1.03, 0.97, -0.02);
  OdometryCalibration calibration(TranslationAndRotation());
  for (int i = 0; i < 200; ++i) calibration.Add(robot.Step(1., 2.));
  EXPECT_NEAR(calibration.translation_scale(), 1.03, 0.004);
  EXPECT_NEAR(calibration.rotation_scale(), 0.97, 0.02);
  EXPECT_NEAR(calibration.rotation_per_metre(), -0.02, 0.006);
  // A gap, in which the wheels slipped, is one there as well.
  const double before = calibration.translation_scale();
  for (int i = 0; i < 10; ++i) {
    calibration.Add(robot.Step(0.5, 5.));
    for (int k = 0; k < 9; ++k) calibration.Add(robot.Step(1., 2.));
  }
  EXPECT_NEAR(calibration.translation_scale(), before, 0.002);
  EXPECT_NEAR(calibration.translation_scale(), 1.03, 0.004);
}

// A driver that was given the wheels and the wheel base of another robot.
TEST(OdometryCalibrationTest, WheelsOfAnotherSize) {
  for (const double scale : {0.8, 0.87, 1.15, 1.25}) {
    Robot robot(5, scale, 1. / scale, 0.01);
    OdometryCalibration calibration(TranslationAndRotation());
    for (int i = 0; i < 4000; ++i) calibration.Add(robot.Step());
    EXPECT_NEAR(calibration.translation_scale(), scale, 0.005 * scale);
    EXPECT_NEAR(calibration.rotation_scale(), 1. / scale, 0.02 / scale);
  }
}

TEST(OdometryCalibrationTest, NothingIsAppliedBeyondTheLimit) {
  OdometryCalibrationOptions options = TranslationAndRotation();
  options.max_deviation = 0.02;
  Robot robot(9, 1.05, 1., 0.05);
  OdometryCalibration calibration(options);
  for (int i = 0; i < 1000; ++i) calibration.Add(robot.Step());
  EXPECT_EQ(calibration.translation_scale(), 1.02);
  EXPECT_EQ(calibration.rotation_per_metre(), 0.02);
}

TEST(OdometryCalibrationTest, CorrectsAMotionByHand) {
  OdometryCalibrationOptions options;
  options.translation_scale = 1.1;
  options.rotation_scale = 0.9;
  options.rotation_per_metre = 0.05;
  const OdometryCalibration calibration(options);
  // 2 m straight on become 2.2 m on an arc of 0.1 rad.
  const Pose2 straight = calibration.Correct(Pose2(2., 0., 0.));
  EXPECT_NEAR(straight.theta, 0.1, 1e-12);
  EXPECT_NEAR(straight.x, 2.2 * std::cos(0.05), 1e-12);
  EXPECT_NEAR(straight.y, 2.2 * std::sin(0.05), 1e-12);
  // Backwards it turns in the other direction.
  EXPECT_NEAR(calibration.Correct(Pose2(-2., 0., 0.)).theta, -0.1, 1e-12);
  EXPECT_NEAR(calibration.Correct(Pose2(0., 0., 1.)).theta, 0.9, 1e-12);
}

TEST(OdometryCalibrationTest, WhatIsUnknownByHand) {
  OdometryCalibrationOptions options = TranslationAndRotation();
  options.translation_scale_sigma = 0.02;
  options.rotation_scale_sigma = 0.1;
  options.rotation_per_metre_sigma = 0.01;
  const Eigen::Matrix3d straight =
      OdometryCalibration(options).Covariance(Pose2(2., 0., 0.));
  // Along 0.02 * 2 m; rotation 0.01 * 2 m, across half of the distance times
  // that.
  EXPECT_NEAR(straight(0, 0), 0.04 * 0.04, 1e-12);
  EXPECT_NEAR(straight(1, 1), 0.02 * 0.02, 1e-12);
  EXPECT_NEAR(straight(2, 2), 0.02 * 0.02, 1e-12);
  EXPECT_NEAR(straight(0, 1), 0., 1e-12);
  const Eigen::Matrix3d turn =
      OdometryCalibration(options).Covariance(Pose2(0., 0., 0.5));
  EXPECT_NEAR(turn(2, 2), 0.05 * 0.05, 1e-12);
  EXPECT_NEAR(turn(0, 0), 0., 1e-12);
}

TEST(OdometryCalibrationTest, OffChangesNothing) {
  OdometryCalibrationOptions options;
  options.estimate_odometry_scale = false;
  options.estimate_rotation = false;
  Robot robot(10, 1.03, 0.97, 0.01);
  OdometryCalibration calibration(options);
  for (int i = 0; i < 300; ++i) calibration.Add(robot.Step());
  const Pose2 motion(0.3, -0.02, 0.4);
  const Pose2 corrected = calibration.Correct(motion);
  EXPECT_EQ(corrected.x, motion.x);
  EXPECT_EQ(corrected.y, motion.y);
  EXPECT_EQ(corrected.theta, motion.theta);
  EXPECT_TRUE(calibration.Covariance(motion).isZero(0.));
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
