// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The first pass over a CARMEN log: collects everything about the whole log
// that is needed before the first event can be delivered.
#ifndef CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_SURVEY_H_
#define CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_SURVEY_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/carmen/carmen_line.h"
#include "cartographer_ext/io/reorder.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// How to deliver the log.
struct CarmenPlan {
  CarmenKind scan_kind = CarmenKind::kFrontLaser;
  bool use_odometry_lines = false;
  bool use_scan_poses = false;
  Pose2 laser_pose;            // (robot <- laser)
  double range_max = 80.;      // just below "no return"; infinity if unknown
  bool is_filter_log = false;  // particle_filter_log.h
  bool remove_corrections = false;  // of its poses
  // Scans and ODOM lines are this far apart, in the order of the file; 0: as
  // their stamps say.
  TimeNs line_spacing = 0;
  bool is_damaged = false;  // the compressed data, at some place
  ReorderPlan reordering;
  SensorSourceInfo info;
};

// `odometry_source` as in SensorSourceOptions.
absl::StatusOr<CarmenPlan> SurveyCarmenLog(const std::string& filename,
                                           const std::string& odometry_source);

// Appends the events of one line as (key rank, is odometry inside a scan) under
// `plan`: odometry before the scan it was taken from. Both passes number the
// events with it, so that they agree. `ordinal` is advanced.
struct CarmenEvent {
  EventKey key;
  bool is_scan = false;
  bool inside_scan = false;
};
int CarmenEventsOfLine(const CarmenPlan& plan, CarmenKind kind, TimeNs time,
                       int64_t* ordinal, CarmenEvent events[2]);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_SURVEY_H_
