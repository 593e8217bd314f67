// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// CARMEN logs as a SensorSource (lines: carmen_line.h). The file is read twice:
// once to check and count everything, once to deliver.
//
// Scans. FLASER or ROBOTLASER1 lines, whichever are more (logs converted
// between the two formats hold both); RAWLASER1 where there are neither. Other
// lasers are dropped, with a warning that counts them.
//
// Odometry, SensorSourceOptions::odometry_source. A laser line repeats the pose
// of the previous odometry message under the later stamp of the scan, for every
// scan of ACES and Intel. Such a pose is stale by up to one message, so "auto"
// takes the ODOM lines, with their own stamps, if they cover the run (from
// within two seconds, or 2 % of the run, of the first scan to the same before
// the last one, and at least one for every five scans) and if the stamps can
// pair them with the scans. Stamps that often go backwards, in over 1 % of the
// messages, cannot: they were made on arrival. There, and where ODOM lines are
// missing, "auto" takes the poses of the scan lines, which the robot's own
// program paired. That is ODOM lines for ACES, poses of the scan lines for
// Intel (3 % of its stamps go backwards) and CSAIL (no ODOM lines). Measured by
// the relations less than 5 s apart, raw odometry, mean errors: ACES 0.034 m
// from ODOM lines interpolated at the scan against 0.039 m from scan lines;
// Intel 0.035 m against 0.024 m.
//
// Logs written by a particle filter, of which many public logs exist only like
// this: "auto" takes the corrected poses of the scan lines, with a warning;
// "odom" the ODOM lines, without the corrections (particle_filter_log.h).
// Stamps that do not tell the scans apart, because they are zero or were
// printed with six digits, are replaced by one every 0.1 s in the order of the
// lines (scan_stamps.h); so are those of a particle filter's log that often go
// backwards, because the filter has read the lines in this order. A warning says so.
//
// Laser pose (robot <- laser): from the two poses of the scan lines, if these
// differ by the same transform in 99 % of the scans; else from the parameters
// robot_frontlaser_{offset,side_offset,angular_offset}. Where the two poses
// differ by a varying amount, the log was corrected by a SLAM program; the
// odometry pose is used and the other ignored, with a warning.
//
// No return. The largest reading of the log is a code for "no return" if it
// occurs more than four times as often as all readings up to half a metre below
// it together, or if it is one of the reserved values of SICK lasers (8.183 to
// 8.191 m, 16.375 to 16.383 m, 32.759 to 32.767 m, 81.83 to 81.91 m); range_max
// is then just below. Otherwise it is 80 m, or the maximum range of a
// ROBOTLASER1 line. Readings are not changed.
#ifndef CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_READER_H_
#define CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_READER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// Malformed lines are skipped and counted in a warning naming the first of
// them. A file without a single valid scan and damaged compression are errors.
absl::StatusOr<std::unique_ptr<SensorSource>> OpenCarmenLog(
    const std::string& filename, const SensorSourceOptions& options);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_READER_H_
