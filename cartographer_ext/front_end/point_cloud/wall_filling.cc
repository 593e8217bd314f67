// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/wall_filling.h"

#include <cmath>
#include <cstddef>

namespace cartographer_ext {
namespace front_end {
namespace {

// Whether `point` lies on the line through `origin` along the unit vector.
bool IsOnLine(const Eigen::Vector2f& origin, const Eigen::Vector2f& direction,
              const Eigen::Vector2f& point, const float tolerance) {
  const Eigen::Vector2f to = point - origin;
  return std::abs(direction.x() * to.y() - direction.y() * to.x()) <= tolerance;
}

// Of the gaps beside the one filled, relative to it: beams look along a wall
// with gaps that grow steadily.
constexpr float kMaxGrowth = 3.f;

}  // namespace

std::vector<Eigen::Vector3f> FillWalls(
    const WallFillingOptions& options,
    const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> filled;
  const float spacing = static_cast<float>(options.spacing);
  if (!(spacing > 0.f)) return filled;
  const float tolerance = static_cast<float>(options.tolerance);
  for (size_t i = 1; i + 2 < points.size(); ++i) {
    const Eigen::Vector3f step = points[i + 1] - points[i];
    const float gap = step.head<2>().norm();
    if (!(gap > spacing && gap <= options.max_gap)) continue;
    const Eigen::Vector2f from = points[i].head<2>();
    const Eigen::Vector2f direction = step.head<2>() / gap;
    const Eigen::Vector2f before = points[i - 1].head<2>();
    const Eigen::Vector2f after = points[i + 2].head<2>();
    const float along_before = direction.dot(from - before);
    const float along_after = direction.dot(after - from) - gap;
    // The points must be in a row, without a larger gap beside this one. The
    // comparisons are written so that NaN fails them.
    const bool is_in_a_row =
        along_before > 0.f && along_before <= kMaxGrowth * gap &&
        along_after > 0.f && along_after <= kMaxGrowth * gap;
    if (!is_in_a_row || !IsOnLine(from, direction, before, tolerance) ||
        !IsOnLine(from, direction, after, tolerance)) {
      continue;
    }
    const int count = static_cast<int>(std::ceil(gap / spacing)) - 1;
    for (int k = 1; k <= count; ++k) {
      filled.push_back(points[i] + static_cast<float>(k) /
                                       static_cast<float>(count + 1) * step);
    }
  }
  return filled;
}

}  // namespace front_end
}  // namespace cartographer_ext
