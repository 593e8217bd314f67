// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Turns the readings of an IMU on a robot that drives on level floors so that
// gravity points along z.
//
// In recordings the mount of an IMU is often missing in tf or a few degrees
// wrong, and then a planar laser seems to look up and down. On level floors the
// direction of gravity is that of the mount: it is averaged over the first
// seconds and tracked slowly. What remains horizontally is acceleration of the
// robot. An IMU that lies on its side or upside down has unknown horizontal
// axes, and one whose gravity has not the right size (in units of g, or taken
// away) an unknown scale: their accelerations are left out.
#ifndef CARTOGRAPHER_EXT_IO_IMU_LEVELLING_H_
#define CARTOGRAPHER_EXT_IO_IMU_LEVELLING_H_

#include "Eigen/Core"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// Standard acceleration of gravity, m/s^2.
constexpr double kGravity = 9.80665;

// Levels the readings of one IMU, see above. Not thread-safe.
class ImuLevelling {
 public:
  // In the order of their stamps. Readings that are not finite come back
  // unchanged.
  ImuReading Level(const ImuReading& reading);

 private:
  bool has_gravity_ = false;
  Eigen::Vector3d gravity_ = Eigen::Vector3d::Zero();  // m/s^2
  TimeNs first_time_ = 0;
  TimeNs last_time_ = 0;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_IMU_LEVELLING_H_
