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

}  // namespace

constexpr int FieldOfView::kSectors;

void FieldOfView::Add(const Eigen::Vector2f& point) {
  if (!point.allFinite()) return;
  const double turns = std::atan2(point.y(), point.x()) / (2. * kPi) + 0.5;
  ++counts_[std::min(kSectors - 1, static_cast<int>(turns * kSectors))];
  ++total_;
}

double FieldOfView::angle() const {
  if (total_ < kEnough) return 2. * kPi;
  const double least = kShare * static_cast<double>(total_) / kSectors;
  int sectors = 0;
  for (const int64_t count : counts_) {
    if (static_cast<double>(count) >= least) ++sectors;
  }
  return 2. * kPi * sectors / kSectors;
}

}  // namespace front_end
}  // namespace cartographer_ext
