// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Prediction from an IMU: preintegration between two scans (paper G, improved
// graph optimisation 2024, section 3.2) with biases estimated while the robot
// is stationary. Readings must be gravity aligned, so that tilt does not turn
// gravity into acceleration; the remainder is part of the bias. The rotation is
// that of the calibrated gyroscope (gyroscope.h).
//
// A scan asks for the same interval before and after its match, so the last
// integration is kept.
#ifndef CARTOGRAPHER_EXT_FRONT_END_IMU_IMU_PREDICTOR_H_
#define CARTOGRAPHER_EXT_FRONT_END_IMU_IMU_PREDICTOR_H_

#include <deque>

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/imu/gyroscope.h"
#include "cartographer_ext/front_end/imu/imu_preintegration.h"

namespace cartographer_ext {
namespace front_end {

// Noise of the readings and of the biases.
struct ImuPredictorOptions {
  bool enabled = true;
  ImuNoiseOptions noise;
  // Standard deviations of the biases that are left after their estimate, of
  // the accelerometers with the tilt.
  double yaw_rate_bias_noise = 0.002;     // rad/s
  double acceleration_bias_noise = 0.05;  // m/s^2
  // After so long stationary the mean of the readings is taken as bias.
  double stationary_time = 1.;  // seconds
};

// A motion by the IMU.
struct ImuMotion {
  Pose2 motion;  // (robot at `from` <- robot at `to`)
  // Of (x, y, theta) of the motion. Includes the biases, not the velocity at
  // `from`.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  double speed_change = 0.;  // forwards, m/s
};

// Predicts from an IMU, see above. Not thread-safe.
class ImuPredictor {
 public:
  explicit ImuPredictor(const ImuPredictorOptions& options);

  // Readings that are not finite or not later than the last one are ignored.
  void Add(const PlanarImuReading& reading);

  // The motion between two times, seconds, with the velocity at `from` in the
  // robot's frame (m/s). False when the readings do not cover the interval.
  bool Predict(double from, double to, const Eigen::Vector2d& velocity,
               ImuMotion* motion) const;

  // The matched motion between two scans; estimates the biases when it is zero.
  // `heading`: what the scan at `to` tells of it.
  void AddMatch(double from, double to, const Pose2& match,
                const ScanHeading& heading = ScanHeading());

  const Gyroscope& gyroscope() const { return gyroscope_; }
  Gyroscope* mutable_gyroscope() { return &gyroscope_; }
  const ImuBias& bias() const { return bias_; }
  // Whether changes of speed are those of the robot: the biases are known, and the
  // readings have horizontal accelerations (see io/imu_levelling.h for IMUs
  // without).
  bool acceleration_is_known() const {
    return bias_is_known_ && has_acceleration_;
  }

 private:
  absl::optional<PreintegratedImu> Preintegrate(double from, double to) const;

  const ImuPredictorOptions options_;
  std::deque<PlanarImuReading> readings_;
  Gyroscope gyroscope_;
  ImuBias bias_;
  bool bias_is_known_ = false;
  bool has_acceleration_ = false;  // other than zero
  // Of the last successful Preintegrate(), invalid after any change of the
  // readings or of the biases.
  struct Preintegrated {
    bool is_valid = false;
    double from = 0.;
    double to = 0.;
    PreintegratedImu imu;
  };
  mutable Preintegrated last_;
  // Sums over the readings since the robot stopped. Those of the newest
  // interval are added with the next one: in it the robot may have started to
  // move.
  double stationary_since_ = 0.;
  bool is_stationary_ = false;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  int num_summed_ = 0;
  Eigen::Vector3d newest_sum_ = Eigen::Vector3d::Zero();
  int num_newest_ = 0;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_IMU_IMU_PREDICTOR_H_
