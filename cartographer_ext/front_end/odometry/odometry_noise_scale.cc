// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_noise_scale.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace front_end {

void OdometryNoiseScale::Add(const double squared_innovation,
                             const double match_variance,
                             const double odometry_variance) {
  if (!std::isfinite(squared_innovation) || !std::isfinite(match_variance) ||
      !(odometry_variance > 0.) || !std::isfinite(odometry_variance)) {
    return;
  }
  const double keep = std::exp(-1. / options_.memory);
  excess_ = keep * excess_ + squared_innovation - match_variance;
  expected_ = keep * expected_ + odometry_variance;
  weight_ = keep * weight_ + 1.;
  const double prior = options_.prior_samples * expected_ / weight_;
  const double scale = (prior + excess_) / (prior + expected_);
  scale_ = std::max(options_.least, std::min(1., scale));
}

}  // namespace front_end
}  // namespace cartographer_ext
