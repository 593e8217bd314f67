// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Planar IMU preintegration between two scans (paper G, improved graph
// optimisation 2024, section 3.2).
//
//   G eq. 5, 6   measured = true + bias + noise, for acceleration and yaw rate
//   G eq. 7      alpha = iint R (a - b_a) dt^2        relative position
//   G eq. 8      beta  = int  R (a - b_a) dt          relative velocity
//   G eq. 9      gamma = int  (omega - b_w) dt        relative heading
//   G eq. 10     p' = p + v dt + a_mean dt^2 / 2      (print: "+ v" without dt)
//   G eq. 11     v' = v + a_mean dt
//   G eq. 12     theta' = theta + omega_mean dt
//   G eq. 13     a_mean, omega_mean: midpoint of two readings, the former
//                rotated into the frame of the start, biases removed
//
// In the plane the quaternions are headings and gravity has no component, once
// the readings are expressed in a gravity-aligned frame, which the caller does.
// The covariance of (alpha, beta, gamma) is propagated with the readings'
// white noise; Jacobians with respect to the biases are not needed, because the
// biases are fixed over the short interval (as in the paper).
#ifndef CARTOGRAPHER_EXT_FRONT_END_IMU_IMU_PREINTEGRATION_H_
#define CARTOGRAPHER_EXT_FRONT_END_IMU_IMU_PREINTEGRATION_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {

// A reading in a gravity-aligned frame: x forward, y left.
struct PlanarImuReading {
  double time = 0.;                                        // seconds
  Eigen::Vector2d acceleration = Eigen::Vector2d::Zero();  // m/s^2
  double yaw_rate = 0.;                                    // rad/s
};

// Of inexpensive MEMS sensors, vibration of the robot included.
struct ImuNoiseOptions {
  double acceleration_density = 0.02;  // m/s^2 / sqrt(Hz), >= 0
  double yaw_rate_density = 0.001;     // rad/s / sqrt(Hz), >= 0
};

// Biases that are subtracted from the readings.
struct ImuBias {
  Eigen::Vector2d acceleration = Eigen::Vector2d::Zero();  // m/s^2
  double yaw_rate = 0.;                                    // rad/s
};

using Matrix5d = Eigen::Matrix<double, 5, 5>;

// The integrals over an interval, in the frame of its start.
struct PreintegratedImu {
  double duration = 0.;                             // seconds
  Eigen::Vector2d alpha = Eigen::Vector2d::Zero();  // metres, eq. 7
  Eigen::Vector2d beta = Eigen::Vector2d::Zero();   // m/s, eq. 8
  double gamma = 0.;                                // radians, eq. 9
  // Of (alpha, beta, gamma).
  Matrix5d covariance = Matrix5d::Zero();
};

// Integrates readings, see above. Not thread-safe.
class ImuPreintegrator {
 public:
  ImuPreintegrator(const ImuNoiseOptions& noise, const ImuBias& bias);

  // Adds the interval between two successive readings (eq. 10 to 13). Intervals
  // that are not positive or readings that are not finite are ignored; returns
  // whether the interval was used.
  bool Add(const PlanarImuReading& first, const PlanarImuReading& second);

  const PreintegratedImu& result() const { return result_; }

 private:
  const ImuNoiseOptions noise_;
  const ImuBias bias_;
  PreintegratedImu result_;
};

// Linear interpolation to `time` within [first.time, second.time], for the
// stamps of scans between readings.
PlanarImuReading InterpolateReading(const PlanarImuReading& first,
                                    const PlanarImuReading& second,
                                    double time);

// Pose and velocity of the robot.
struct PlanarState {
  Pose2 pose;                                          // (world <- robot)
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  // world frame, m/s
};

// The state after the preintegrated interval:
//   p' = p + v T + R alpha,  v' = v + R beta,  theta' = theta + gamma.
PlanarState Predict(const PlanarState& state, const PreintegratedImu& imu);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_IMU_IMU_PREINTEGRATION_H_
