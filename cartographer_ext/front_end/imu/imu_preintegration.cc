// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/imu/imu_preintegration.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Geometry"

namespace cartographer_ext {
namespace front_end {
namespace {

bool IsFinite(const PlanarImuReading& reading) {
  return std::isfinite(reading.time) && reading.acceleration.allFinite() &&
         std::isfinite(reading.yaw_rate);
}

}  // namespace

ImuPreintegrator::ImuPreintegrator(const ImuNoiseOptions& noise,
                                   const ImuBias& bias)
    : noise_(noise), bias_(bias) {}

bool ImuPreintegrator::Add(const PlanarImuReading& first,
                           const PlanarImuReading& second) {
  if (!IsFinite(first) || !IsFinite(second)) return false;
  const double dt = second.time - first.time;
  if (!(dt > 0.)) return false;

  // G eq. 13. The second acceleration is rotated with the heading reached.
  const double yaw_rate =
      0.5 * (first.yaw_rate + second.yaw_rate) - bias_.yaw_rate;
  const double heading = result_.gamma;
  const double next_heading = heading + yaw_rate * dt;  // eq. 12
  const Eigen::Matrix2d rotation =
      Eigen::Rotation2Dd(heading).toRotationMatrix();
  const Eigen::Matrix2d next_rotation =
      Eigen::Rotation2Dd(next_heading).toRotationMatrix();
  const Eigen::Vector2d a0 = first.acceleration - bias_.acceleration;
  const Eigen::Vector2d a1 = second.acceleration - bias_.acceleration;
  const Eigen::Vector2d mean = 0.5 * (rotation * a0 + next_rotation * a1);

  // Error state (alpha, beta, gamma): F by differentiating the update below. A
  // heading error turns the mean acceleration by 90 degrees.
  const Eigen::Vector2d turned(-mean.y(), mean.x());
  Matrix5d f = Matrix5d::Identity();
  f.block<2, 2>(0, 2) = dt * Eigen::Matrix2d::Identity();
  f.block<2, 1>(0, 4) = 0.5 * dt * dt * turned;
  f.block<2, 1>(2, 4) = dt * turned;
  // White noise of density s over dt has variance s^2 / dt in the mean reading.
  const double acceleration_variance =
      noise_.acceleration_density * noise_.acceleration_density / dt;
  const double rate_variance =
      noise_.yaw_rate_density * noise_.yaw_rate_density / dt;
  Eigen::Matrix<double, 5, 3> g = Eigen::Matrix<double, 5, 3>::Zero();
  g.block<2, 2>(0, 0) = 0.5 * dt * dt * Eigen::Matrix2d::Identity();
  g.block<2, 2>(2, 0) = dt * Eigen::Matrix2d::Identity();
  g(4, 2) = dt;
  const Eigen::Vector3d q(acceleration_variance, acceleration_variance,
                          rate_variance);
  result_.covariance = f * result_.covariance * f.transpose() +
                       g * q.asDiagonal() * g.transpose();

  result_.alpha += result_.beta * dt + 0.5 * dt * dt * mean;  // eq. 7, 10
  result_.beta += mean * dt;                                  // eq. 8, 11
  result_.gamma = next_heading;                               // eq. 9, 12
  result_.duration += dt;
  return true;
}

PlanarImuReading InterpolateReading(const PlanarImuReading& first,
                                    const PlanarImuReading& second,
                                    const double time) {
  const double span = second.time - first.time;
  const double ratio =
      span > 0. ? std::min(1., std::max(0., (time - first.time) / span)) : 0.;
  PlanarImuReading result;
  result.time = time;
  result.acceleration =
      first.acceleration + ratio * (second.acceleration - first.acceleration);
  result.yaw_rate = first.yaw_rate + ratio * (second.yaw_rate - first.yaw_rate);
  return result;
}

PlanarState Predict(const PlanarState& state, const PreintegratedImu& imu) {
  const Eigen::Matrix2d rotation =
      Eigen::Rotation2Dd(state.pose.theta).toRotationMatrix();
  const Eigen::Vector2d position = state.pose.translation() +
                                   state.velocity * imu.duration +
                                   rotation * imu.alpha;
  PlanarState next;
  next.pose = Pose2(position.x(), position.y(),
                    NormalizeAngle(state.pose.theta + imu.gamma));
  next.velocity = state.velocity + rotation * imu.beta;
  return next;
}

}  // namespace front_end
}  // namespace cartographer_ext
