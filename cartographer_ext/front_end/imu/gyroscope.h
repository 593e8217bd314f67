// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The yaw rate of an IMU, calibrated and checked against the scan matcher.
//
// Drivers report degrees instead of radians, IMUs are mounted upside down, a
// frame is missing in tf, a sensor has died and repeats zero, its clock is not
// that of the laser. Such a gyroscope looks sound as long as the robot drives
// straight on, and breaks the map in the first turn. So a gyroscope is believed
// when it has measured turns that scans have measured, too.
//
//   rotation = factor * rotation by the gyroscope - factor * bias * time
//
// is estimated by a CalibrationFilter (the gyroscope is the less noisy of both),
// the offset of the clocks by ClockOffset.
// The gyroscope is proven once the factor is known and near one, and refuted once
// it is known and far from one, or contradicts the matches time and again.
#ifndef CARTOGRAPHER_EXT_FRONT_END_IMU_GYROSCOPE_H_
#define CARTOGRAPHER_EXT_FRONT_END_IMU_GYROSCOPE_H_

#include <cstddef>

#include "cartographer_ext/front_end/calibration_filter.h"
#include "cartographer_ext/front_end/odometry/clock_offset.h"
#include "cartographer_ext/front_end/odometry/odometry_buffer.h"

namespace cartographer_ext {
namespace front_end {

// How long readings of an IMU are kept, seconds, and how many at most.
constexpr double kImuBufferSeconds = 10.;
constexpr size_t kMaxImuReadings = 20000;
// The newest reading may be this much older than the scan, seconds.
constexpr double kMaxImuExtrapolation = 0.1;

enum class GyroscopeState { kUnproven, kProven, kRefuted };

// Noise of the yaw rate, standard deviations.
struct GyroscopeOptions {
  double density = 0.001;  // rad/s / sqrt(Hz), >= 0
  // Of the bias as long as only standstill has measured it, rad/s.
  double bias_noise = 0.002;
};

// A rotation by the gyroscope, corrected.
struct GyroscopeRotation {
  double angle = 0.;     // radians
  double variance = 0.;  // square radians
};

// The rotation between two scans by the scan matcher.
struct MatchedRotation {
  double from = 0.;  // seconds
  double to = 0.;
  double angle = 0.;  // radians
  double sigma = 0.;  // of the pose at `to`
  bool is_observable = true;
};

// Calibrates and checks the yaw rate, see above. Not thread-safe.
class Gyroscope {
 public:
  explicit Gyroscope(const GyroscopeOptions& options);

  // Seconds, later than the reading before, and rad/s.
  void Add(double time, double yaw_rate);

  // The rotation between the stamps of two scans, from < to. False when the
  // readings do not cover them.
  bool Rotation(double from, double to, GyroscopeRotation* rotation) const;

  void AddMatch(const MatchedRotation& matched);

  // The bias is known from a standstill, rad/s.
  void SetBias(double bias);

  bool has_readings() const { return has_reading_; }
  GyroscopeState state() const;
  double factor() const { return filter_.value(0); }
  double factor_sigma() const { return filter_.sigma(0); }
  // Scan minus IMU stamp of the same moment, seconds.
  double clock_offset() const { return offset_.offset(); }

 private:
  // A stretch between two scans that the filter compares.
  struct Segment {
    double start = 0.;
    double end = 0.;
    double angle = 0.;     // of the matches
    double turned = 0.;    // sum of absolute angles
    double measured = 0.;  // by the gyroscope, as received
    double sigma = 0.;     // at the end
  };

  // As received; false when the readings do not cover the interval.
  bool Raw(double from, double to, double* angle) const;
  void Learn(const Segment& segment);

  const GyroscopeOptions options_;
  OdometryBuffer headings_;  // integrated readings
  bool has_reading_ = false;
  double last_time_ = 0.;
  double last_rate_ = 0.;
  double heading_ = 0.;
  ClockOffset offset_;
  CalibrationFilter filter_;
  Segment segment_;
  // Of the last segments, forgotten slowly: how many there were, and how many
  // contradicted the filter.
  double compared_ = 0.;
  double contradicted_ = 0.;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_IMU_GYROSCOPE_H_
