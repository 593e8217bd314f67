// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/sensors/imu_model.h"

#include <cmath>

#include "cartographer_ext/simulation/seeds.h"

namespace cartographer_ext {
namespace simulation {

ImuModel::ImuModel(const ImuSettings& settings, const uint64_t seed)
    : settings_(settings), random_(MakeRandom(seed, RandomStream::kImu)) {
  gyro_bias_ = Noise(settings_.gyro_bias_sigma);
  accel_bias_ = Noise(settings_.accel_bias_sigma);
}

Eigen::Vector3d ImuModel::Noise(const double sigma) {
  // The draws have names because the order of evaluation of arguments is
  // unspecified.
  const double x = random_.Normal();
  const double y = random_.Normal();
  const double z = random_.Normal();
  return sigma * Eigen::Vector3d(x, y, z);
}

io::ImuReading ImuModel::Sample(const MotionState& motion) {
  io::ImuReading reading;
  const double root_rate = std::sqrt(settings_.rate);
  reading.angular_velocity = Eigen::Vector3d(0., 0., motion.turn_rate) +
                             gyro_bias_ +
                             Noise(settings_.gyro_noise * root_rate);
  reading.linear_acceleration =
      Eigen::Vector3d(motion.acceleration, motion.speed * motion.turn_rate,
                      settings_.gravity) +
      accel_bias_ + Noise(settings_.accel_noise * root_rate);
  gyro_bias_ += Noise(settings_.gyro_bias_walk / root_rate);
  accel_bias_ += Noise(settings_.accel_bias_walk / root_rate);
  return reading;
}

}  // namespace simulation
}  // namespace cartographer_ext
