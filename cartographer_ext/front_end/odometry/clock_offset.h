// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The clock offset (time_offset.h) of a sensor whose readings are in a buffer.
// A matched turn waits until the readings cover all candidate offsets.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_CLOCK_OFFSET_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_CLOCK_OFFSET_H_

#include <deque>

#include "cartographer_ext/front_end/odometry/odometry_buffer.h"
#include "cartographer_ext/front_end/odometry/time_offset.h"

namespace cartographer_ext {
namespace front_end {

// Learns the offset, see above. Not thread-safe.
class ClockOffset {
 public:
  explicit ClockOffset(const TimeOffsetOptions& options);

  // The turn between two scans by the scan matcher, whose rotation is
  // observable; stamps in seconds, radians. The heading of the sensor is that
  // of `buffer`, which must be the same one in all calls.
  void AddMatch(double from, double to, double turn,
                const OdometryBuffer& buffer);

  // Scan minus sensor stamp of the same moment, seconds.
  double offset() const { return estimator_.offset(); }

 private:
  struct MatchedTurn {
    double from;
    double to;
    double turn;
  };
  void Learn(const MatchedTurn& matched, const OdometryBuffer& buffer);

  TimeOffsetEstimator estimator_;
  std::deque<MatchedTurn> pending_;  // oldest first
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_CLOCK_OFFSET_H_
