// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Dead reckoning by wheels and gyroscope: the distance of the wheels along the
// heading of the gyroscope, reading by reading.
//
// Between two scans it makes no difference whether the heading of odometry is
// corrected at the end or on the way. Over a gap of minutes, such as that of a
// laser of short range in a hall, it does: the wheels have turned by radians that
// the robot has not, and the direction of all metres since then is wrong.
//
// The steps between two readings of odometry are kept as received, with the
// rotation by the gyroscope. So all of them are corrected by what is known when
// the gap ends, even if the gyroscope was proven by turns within it.
#ifndef CARTOGRAPHER_EXT_FRONT_END_DEAD_RECKONING_H_
#define CARTOGRAPHER_EXT_FRONT_END_DEAD_RECKONING_H_

#include <deque>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/imu/gyroscope.h"
#include "cartographer_ext/front_end/odometry/odometry_predictor.h"

namespace cartographer_ext {
namespace front_end {

// See above. Not thread-safe.
class DeadReckoning {
 public:
  explicit DeadReckoning(const OdometryNoiseOptions& noise);

  // A reading of odometry, later than the one before: seconds and (odometry <-
  // robot).
  void Add(double time, const Pose2& pose);
  // Takes the steps whose rotation the gyroscope knows by now, and shows them to
  // it.
  void Advance(const OdometryPredictor& odometry, Gyroscope* gyroscope);

  // The motion between two stamps of scans, from < to; `raw` and the flags are
  // not set. False unless the gyroscope is proven and knows all of it.
  bool Predict(double from, double to, const OdometryPredictor& odometry,
               const Gyroscope& gyroscope, OdometryMotion* motion) const;

 private:
  struct Reading {
    double time;
    Pose2 pose;
  };
  struct Step {
    double start;  // by the clock of odometry, seconds
    double end;
    Pose2 motion;
    // By the gyroscope, as received; only if that covers the step.
    bool is_covered;
    double turned;
  };

  const OdometryNoiseOptions noise_;
  bool has_last_ = false;
  Reading last_;                 // up to which steps were taken
  std::deque<Reading> pending_;  // later ones
  std::deque<Step> steps_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DEAD_RECKONING_H_
