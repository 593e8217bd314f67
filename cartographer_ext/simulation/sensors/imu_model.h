// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// An inertial unit between the wheels of a robot on a level floor. True values
// in the robot frame, from the exact motion:
//   angular velocity (0, 0, w),  specific force (dv/dt, v w, g),
// sampled at the stamp. A bias starts at a draw of N(0, bias_sigma^2) and walks
// by bias_walk sqrt(dt) N(0, 1) a sample; white noise has the standard
// deviation density * sqrt(rate). All three axes of both instruments are noisy.
#ifndef CARTOGRAPHER_EXT_SIMULATION_SENSORS_IMU_MODEL_H_
#define CARTOGRAPHER_EXT_SIMULATION_SENSORS_IMU_MODEL_H_

#include <cstdint>

#include "Eigen/Core"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/simulation/drive.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

class ImuModel {
 public:
  ImuModel(const ImuSettings& settings, uint64_t seed);

  // The next sample, 1 / rate after the one before. The stamp is left to the
  // caller.
  io::ImuReading Sample(const MotionState& motion);

  const Eigen::Vector3d& gyro_bias() const { return gyro_bias_; }
  const Eigen::Vector3d& accel_bias() const { return accel_bias_; }

 private:
  Eigen::Vector3d Noise(double sigma);

  const ImuSettings settings_;
  Random random_;
  Eigen::Vector3d gyro_bias_;   // rad/s
  Eigen::Vector3d accel_bias_;  // m/s^2
};

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_SENSORS_IMU_MODEL_H_
