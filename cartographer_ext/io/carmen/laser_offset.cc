// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/laser_offset.h"

#include <cmath>
#include <utility>

#include "cartographer_ext/common/order_statistics.h"

namespace cartographer_ext {
namespace io {
namespace {

// Poses in logs are rounded, and some loggers interpolate one of the two.
constexpr double kOffsetTolerance = 0.02;  // metres, radians

}  // namespace

bool FindConstantOffset(const std::vector<Pose2>& offsets, Pose2* offset) {
  std::vector<double> x, y, sine, cosine;
  for (const Pose2& pose : offsets) {
    x.push_back(pose.x);
    y.push_back(pose.y);
    sine.push_back(std::sin(pose.theta));
    cosine.push_back(std::cos(pose.theta));
  }
  *offset = Pose2(
      UpperMedian(std::move(x)), UpperMedian(std::move(y)),
      std::atan2(UpperMedian(std::move(sine)), UpperMedian(std::move(cosine))));
  size_t num_close = 0;
  for (const Pose2& pose : offsets) {
    if (std::abs(pose.x - offset->x) <= kOffsetTolerance &&
        std::abs(pose.y - offset->y) <= kOffsetTolerance &&
        std::abs(NormalizeAngle(pose.theta - offset->theta)) <=
            kOffsetTolerance) {
      ++num_close;
    }
  }
  return num_close >= 0.99 * offsets.size() &&
         std::hypot(offset->x, offset->y) <= kMaxLaserOffset;
}

}  // namespace io
}  // namespace cartographer_ext
