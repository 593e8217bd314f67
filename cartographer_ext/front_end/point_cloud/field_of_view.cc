// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/field_of_view.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr int64_t kEnough = 2000;  // points
// A sector counts if it has at least a twentieth of the mean of all sectors.
constexpr double kShare = 0.05;
// In which points lose two thirds of their weight, seconds.
constexpr double kMemory = 2.;

}  // namespace

constexpr int FieldOfView::kSectors;

void FieldOfView::Advance(const double seconds) {
  const double factor = std::exp(-seconds / kMemory);
  for (double& weight : weights_) weight *= factor;
  total_ *= factor;
}

void FieldOfView::Add(const Eigen::Vector2f& point) {
  if (!point.allFinite()) return;
  const double turns = std::atan2(point.y(), point.x()) / (2. * kPi) + 0.5;
  weights_[std::min(kSectors - 1, static_cast<int>(turns * kSectors))] += 1.;
  total_ += 1.;
  ++num_points_;
}

double FieldOfView::angle() const {
  if (num_points_ < kEnough) return 2. * kPi;
  const double least = kShare * total_ / kSectors;
  int sectors = 0;
  for (const double weight : weights_) {
    if (weight > 0. && weight >= least) ++sectors;
  }
  return 2. * kPi * sectors / kSectors;
}

}  // namespace front_end
}  // namespace cartographer_ext
