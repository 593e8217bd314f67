// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/learnt_odometry_noise.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Matches of a laser with a narrow field of view are less accurate: a scan
// overlaps with others over a shorter part of the path, so errors of the
// submaps accumulate. Scaled by the square of the angle, a depth camera of 57
// degrees leaves odometry a tenth of the variance of the translation, 3 mm and
// 3 %.
constexpr double kWideFieldOfView = kPi;
// The same for the heading, as far as that is learnt: a laser that sees a hundred
// degrees knows it better than wheels do. A depth camera leaves 0.3; of a tenth the
// errors of the calibration begin to count.
constexpr double kHeadingFieldOfView = 105. * kPi / 180.;
// Nothing is known of lasers that see less.
constexpr double kNarrowFieldOfView = 1.;

Eigen::Matrix3d Scaled(const Eigen::Vector3d& variances,
                       const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d factors = variances.cwiseSqrt();
  return factors.asDiagonal() * covariance * factors.asDiagonal();
}

}  // namespace

LearntOdometryNoise::LearntOdometryNoise(
    const LearntOdometryNoiseOptions& options)
    : translation_(options.translation), heading_(options.heading) {}

void LearntOdometryNoise::SetFieldOfView(const double angle) {
  const double seen = std::max(angle, kNarrowFieldOfView);
  field_of_view_scale_ = std::min(1., Squared(seen / kWideFieldOfView));
  least_heading_scale_ = std::min(1., Squared(seen / kHeadingFieldOfView));
}

void LearntOdometryNoise::Add(const MatchInnovation& innovation) {
  SquaredInnovation along = innovation.along;
  along.prediction_variance /= translation_scale();
  translation_.Add(along);
  SquaredInnovation heading = innovation.heading;
  heading.prediction_variance /= heading_scale();
  heading_.Add(heading);
}

Eigen::Matrix3d LearntOdometryNoise::ScaleTranslation(
    const Eigen::Matrix3d& covariance) const {
  return Scaled({translation_scale(), translation_scale(), 1.}, covariance);
}

Eigen::Matrix3d LearntOdometryNoise::ScaleHeading(
    const Eigen::Matrix3d& covariance) const {
  return Scaled({1., 1., heading_scale()}, covariance);
}

}  // namespace front_end
}  // namespace cartographer_ext
