// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How wide the lasers of a robot see at present: the angle of all directions from
// which there was more than a stray point in the last seconds. A laser of short
// range beside the only wall of a hall sees as little as a narrow one.
#ifndef CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_FIELD_OF_VIEW_H_
#define CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_FIELD_OF_VIEW_H_

#include <array>
#include <cstdint>

#include "Eigen/Core"

namespace cartographer_ext {
namespace front_end {

// Estimates the field of view from points. Not thread-safe.
class FieldOfView {
 public:
  // So much time has passed since the last points, seconds >= 0: older ones count
  // less.
  void Advance(double seconds);

  // A point relative to the laser, in a frame that moves with the robot. Points
  // that are not finite are ignored.
  void Add(const Eigen::Vector2f& point);

  // Radians in [0, 2 pi]; 2 pi before there were enough points to tell.
  double angle() const;

 private:
  static constexpr int kSectors = 72;
  std::array<double, kSectors> weights_{};
  double total_ = 0.;
  int64_t num_points_ = 0;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_FIELD_OF_VIEW_H_
