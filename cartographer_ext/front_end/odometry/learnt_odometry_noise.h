// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How good the odometry of a run is, learnt from the scan matches: the variances
// of its translation and of its heading relative to those of the options
// (odometry_noise_scale.h). Where local SLAM takes odometry for worse than it is, a
// narrow scan that fits as well a few degrees aside is believed, and a submap turns.
// A wide scan knows the heading better than wheels do, and contradicts them where
// stamps are wrong: what is learnt of the heading counts where the laser sees
// little.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_LEARNT_ODOMETRY_NOISE_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_LEARNT_ODOMETRY_NOISE_H_

#include <algorithm>

#include "Eigen/Core"
#include "cartographer_ext/front_end/odometry/odometry_noise_scale.h"

namespace cartographer_ext {
namespace front_end {

// A match against its prediction by odometry: along one direction that the scan
// determines, square metres, and in heading, square radians.
struct MatchInnovation {
  SquaredInnovation along;
  SquaredInnovation heading;
};

// Priors, memories and bounds of both scales.
struct LearntOdometryNoiseOptions {
  LearntOdometryNoiseOptions() { heading.least = 0.; }

  OdometryNoiseScaleOptions translation;
  OdometryNoiseScaleOptions heading;
};

// Learns, see above. Not thread-safe.
class LearntOdometryNoise {
 public:
  explicit LearntOdometryNoise(const LearntOdometryNoiseOptions& options);

  // How wide the laser sees, radians; half a circle and more before it is known.
  void SetFieldOfView(double angle);

  // Variances of the prediction as they were scaled.
  void Add(const MatchInnovation& innovation);

  // Odometry was wrong. Its heading is no longer trusted more than the options
  // say: what is wrong for seconds is not learnt from matches that agree.
  void AddFault() { heading_.Restart(); }

  // Of the variances.
  double translation_scale() const {
    return field_of_view_scale_ * translation_.scale();
  }
  double heading_scale() const {
    return std::max(least_heading_scale_, heading_.scale());
  }

  // A covariance of (x, y, theta) with that part scaled.
  Eigen::Matrix3d ScaleTranslation(const Eigen::Matrix3d& covariance) const;
  Eigen::Matrix3d ScaleHeading(const Eigen::Matrix3d& covariance) const;

 private:
  OdometryNoiseScale translation_;
  OdometryNoiseScale heading_;
  double field_of_view_scale_ = 1.;  // of the translation
  double least_heading_scale_ = 1.;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_LEARNT_ODOMETRY_NOISE_H_
