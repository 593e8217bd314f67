// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes CARMEN logs: ODOM lines and scans. Scans whose beams follow the FLASER
// convention (carmen_line.h) become FLASER lines, others ROBOTLASER1 lines,
// which name their angles. Millimetres in ranges, micrometres and microradians
// in poses, nanoseconds in stamps.
#ifndef CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_WRITER_H_
#define CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_WRITER_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

class CarmenWriter {
 public:
  // `comment` becomes the head of the file, each line behind a '#'.
  static absl::StatusOr<std::unique_ptr<CarmenWriter>> Open(
      const std::string& filename, const std::string& comment);

  // `linear_velocity` in m/s, `angular_velocity` in rad/s.
  absl::Status AddOdometry(const OdometryReading& reading,
                           double linear_velocity = 0.,
                           double angular_velocity = 0.);

  // `odometry` is (odometry <- robot) at the scan, as far as known by then. "No
  // return" (NaN, infinite, not positive, above range_max) is written as 81.91
  // in FLASER lines and as maximum_range in ROBOTLASER1 lines. The laser's pose
  // follows from scan.laser_pose. An error for scans without readings or with
  // more than CarmenLine::kMaxReadings.
  absl::Status AddScan(const LaserScan& scan, const Pose2& odometry);

  // Puts the file in place; without it nothing is left behind.
  absl::Status Finish();

 private:
  explicit CarmenWriter(const std::string& filename) : file_(filename) {}
  AtomicFile file_;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_WRITER_H_
