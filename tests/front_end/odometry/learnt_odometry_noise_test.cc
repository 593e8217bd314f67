// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/learnt_odometry_noise.h"

#include "cartographer_ext/common/pose2.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr double kVariance = 1e-4;

// Of lasers that see a radian or less.
constexpr double kLeastHeadingScale = 0.297760;

// As of a depth camera.
LearntOdometryNoise WithNarrowView() {
  LearntOdometryNoise noise((LearntOdometryNoiseOptions()));
  noise.SetFieldOfView(1.);
  return noise;
}

// Innovations as if odometry had these shares of the variances of the options.
void AddInnovations(const double translation, const double heading,
                    const int count, LearntOdometryNoise* const noise) {
  for (int i = 0; i != count; ++i) {
    MatchInnovation innovation;
    innovation.along = {translation * kVariance, 0.,
                        noise->translation_scale() * kVariance};
    innovation.heading = {heading * kVariance, 0.,
                          noise->heading_scale() * kVariance};
    noise->Add(innovation);
  }
}

TEST(LearntOdometryNoiseTest, BeginsWithTheOptions) {
  const LearntOdometryNoise noise((LearntOdometryNoiseOptions()));
  EXPECT_EQ(noise.translation_scale(), 1.);
  EXPECT_EQ(noise.heading_scale(), 1.);
}

TEST(LearntOdometryNoiseTest, LearnsTranslationAndHeadingApart) {
  LearntOdometryNoise noise = WithNarrowView();
  const double narrow = noise.translation_scale();
  AddInnovations(1., 0.4, 2000, &noise);
  EXPECT_NEAR(noise.translation_scale(), narrow, 1e-9);
  // A tenth of the prior is left (50 of 500 samples): 0.4 + 0.6 * 0.1 / 1.1.
  EXPECT_NEAR(noise.heading_scale(), 0.455, 0.005);
  AddInnovations(0.8, 1., 5000, &noise);
  EXPECT_NEAR(noise.translation_scale(), 0.818 * narrow, 0.005 * narrow);
  EXPECT_NEAR(noise.heading_scale(), 1., 0.005);
}

// The scale it had learnt is that of the variances it is given.
TEST(LearntOdometryNoiseTest, IsBounded) {
  LearntOdometryNoise noise = WithNarrowView();
  const double narrow = noise.translation_scale();
  AddInnovations(0., 0., 3000, &noise);
  EXPECT_NEAR(noise.translation_scale(), 0.5 * narrow, 1e-12);
  EXPECT_NEAR(noise.heading_scale(), kLeastHeadingScale, 1e-6);
  AddInnovations(9., 9., 3000, &noise);
  EXPECT_NEAR(noise.translation_scale(), narrow, 1e-12);
  EXPECT_EQ(noise.heading_scale(), 1.);
}

TEST(LearntOdometryNoiseTest, ANarrowViewLeavesMoreToOdometry) {
  LearntOdometryNoise noise((LearntOdometryNoiseOptions()));
  AddInnovations(1., 0., 3000, &noise);
  noise.SetFieldOfView(2. * kPi);
  EXPECT_EQ(noise.translation_scale(), 1.);
  EXPECT_EQ(noise.heading_scale(), 1.);
  noise.SetFieldOfView(0.75 * kPi);
  EXPECT_NEAR(noise.translation_scale(), 0.5625, 1e-12);
  EXPECT_EQ(noise.heading_scale(), 1.);
  noise.SetFieldOfView(84. * kPi / 180.);
  EXPECT_NEAR(noise.translation_scale(), 0.217778, 1e-6);
  EXPECT_NEAR(noise.heading_scale(), 0.64, 1e-12);
  noise.SetFieldOfView(0.1);
  EXPECT_NEAR(noise.translation_scale(), 1. / (kPi * kPi), 1e-12);
  EXPECT_NEAR(noise.heading_scale(), kLeastHeadingScale, 1e-6);
}

TEST(LearntOdometryNoiseTest, AFaultBeginsTheHeadingAnew) {
  LearntOdometryNoise noise = WithNarrowView();
  const double narrow = noise.translation_scale();
  AddInnovations(0., 0., 3000, &noise);
  noise.AddFault();
  EXPECT_NEAR(noise.translation_scale(), 0.5 * narrow, 1e-12);
  EXPECT_EQ(noise.heading_scale(), 1.);
  AddInnovations(0., 0., 50, &noise);
  EXPECT_NEAR(noise.heading_scale(), 0.5, 0.02);
}

TEST(LearntOdometryNoiseTest, ScalesCovariances) {
  LearntOdometryNoise noise((LearntOdometryNoiseOptions()));
  AddInnovations(0., 0., 3000, &noise);
  noise.SetFieldOfView(84. * kPi / 180.);
  Eigen::Matrix3d covariance;
  covariance << 4., 1., 2., 1., 3., 1., 2., 1., 10.;
  const Eigen::Matrix3d translation = noise.ScaleTranslation(covariance);
  EXPECT_NEAR(translation(0, 0), 0.435556, 1e-6);
  EXPECT_NEAR(translation(0, 1), 0.108889, 1e-6);
  EXPECT_NEAR(translation(0, 2), 0.659966, 1e-6);
  EXPECT_NEAR(translation(2, 2), 10., 1e-12);
  const Eigen::Matrix3d heading = noise.ScaleHeading(covariance);
  EXPECT_NEAR(heading(0, 0), 4., 1e-12);
  EXPECT_NEAR(heading(1, 2), 0.8, 1e-12);
  EXPECT_NEAR(heading(2, 2), 6.4, 1e-12);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
