// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_noise_scale.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace front_end {

void OdometryNoiseScale::Add(const SquaredInnovation& innovation) {
  if (!std::isfinite(innovation.squared) ||
      !std::isfinite(innovation.match_variance) ||
      !(innovation.prediction_variance > 0.) ||
      !std::isfinite(innovation.prediction_variance)) {
    return;
  }
  const double keep = std::exp(-1. / options_.memory);
  excess_ = keep * excess_ + innovation.squared - innovation.match_variance;
  expected_ = keep * expected_ + innovation.prediction_variance;
  weight_ = keep * weight_ + 1.;
  const double prior = options_.prior_samples * expected_ / weight_;
  const double scale = (prior + excess_) / (prior + expected_);
  scale_ = std::max(options_.least, std::min(1., scale));
}

void OdometryNoiseScale::Restart() {
  excess_ = expected_ = weight_ = 0.;
  scale_ = 1.;
}

}  // namespace front_end
}  // namespace cartographer_ext
