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
// Factor and bias are estimated and judged by rotation_check.h, the offset of the
// clocks by ClockOffset.
//
// Where scans are few, wheels prove it likewise: two sensors agree only if both
// are right. They do not refute it, since wheels slip; and as their scale is not
// better known than that of a gyroscope, its factor stays one.
#ifndef CARTOGRAPHER_EXT_FRONT_END_IMU_GYROSCOPE_H_
#define CARTOGRAPHER_EXT_FRONT_END_IMU_GYROSCOPE_H_

#include <cstddef>

#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/front_end/imu/rotation_check.h"
#include "cartographer_ext/front_end/odometry/clock_offset.h"
#include "cartographer_ext/front_end/odometry/odometry_buffer.h"

namespace cartographer_ext {
namespace front_end {

// How long readings of an IMU are kept, seconds, and how many at most.
constexpr double kImuBufferSeconds = 10.;
constexpr size_t kMaxImuReadings = 20000;
// The newest reading may be this much older than the scan, seconds.
constexpr double kMaxImuExtrapolation = 0.1;

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

// Corrects rotations as received.
struct GyroscopeCorrection {
  double factor = 1.;
  double factor_variance = 0.;
  double drift = 0.;            // added, rad/s
  double drift_variance = 0.;   // rad^2/s^2
  double density_squared = 0.;  // of the yaw rate, rad^2/s

  // Of a rotation over so many seconds, radians.
  double Angle(double raw, double seconds) const {
    return factor * raw + drift * seconds;
  }
  // Square radians.
  double Variance(double raw, double seconds) const {
    return density_squared * seconds + drift_variance * Squared(seconds) +
           factor_variance * Squared(raw);
  }
};

// What a scan alone tells of the heading, without the prediction: a gyroscope must
// not be confirmed by its own prediction, nor by that of the wheels.
struct ScanHeading {
  bool is_observable = false;
  double offset = 0.;  // from the heading of the match, radians
  double sigma = 0.;
  // Seconds after which scans see another part of the map: the errors of those
  // that see the same part are the same.
  double map_age = 10.;
};

// The rotation between two scans by the scan matcher.
struct MatchedRotation {
  double from = 0.;  // seconds
  double to = 0.;
  double angle = 0.;    // radians
  ScanHeading heading;  // at `to`
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
  // The rotation as received; false when the readings do not cover it.
  bool Raw(double from, double to, double* angle) const;
  // By today's estimates of factor and bias.
  GyroscopeCorrection Correction() const;

  void AddMatch(const MatchedRotation& matched);
  // The rotation by the wheels between two stamps of scans.
  void AddWheels(double from, double to, double angle);

  // The bias is known from a standstill, rad/s.
  void SetBias(double bias);

  bool has_readings() const { return has_reading_; }
  GyroscopeState state() const;
  double factor() const { return scans_.factor(); }
  double factor_sigma() const { return scans_.factor_sigma(); }
  // Scan minus IMU stamp of the same moment, seconds.
  double clock_offset() const { return offset_.offset(); }

 private:
  // A stretch that is compared.
  struct Segment {
    double start = 0.;
    double end = 0.;
    double angle = 0.;     // by the other sensor
    double turned = 0.;    // sum of absolute angles
    double measured = 0.;  // by the gyroscope, as received
  };

  // Adds to the segment; true once that is long enough.
  static bool Extend(double from, double to, double angle, double raw,
                     Segment* segment);
  // By scans or wheels; null where neither prove it.
  const RotationCheck* Proof() const;

  const GyroscopeOptions options_;
  OdometryBuffer headings_;  // integrated readings
  bool has_reading_ = false;
  double last_time_ = 0.;
  double last_rate_ = 0.;
  double heading_ = 0.;
  ClockOffset offset_;
  RotationCheck scans_;
  Segment segment_;           // by scans
  double last_heading_ = 0.;  // offset of the scan before
  RotationCheck wheels_;
  Segment wheel_segment_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_IMU_GYROSCOPE_H_
