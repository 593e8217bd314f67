// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Quality of the localisation in a map, scan by scan, from the poses published
// online (OnlinePoses) and ground truth, both in the frame of the map.
//
//   segment     From the start to the end; a kidnapped robot (its true pose
//               moves farther from one scan to the next than it can drive)
//               starts a new one.
//   localised   From the first scan after which the pose stays within the
//               tolerances for `hold_seconds`, or to the end of the segment.
//   jump        The error of the published pose changes by more than
//               `jump_distance` from one scan to the next: by a loop closure,
//               not by drift. Not in the first `settle_seconds` of a segment,
//               while local SLAM adapts to other walls.
//   wrong       A jump that ends farther from ground truth than
//               `jump_distance`, or rotated by more than `wrong_rotation`:
//               localised at a wrong place.
//
// A robot with an unknown pose has to jump once, to the right place. All jumps
// after it was localised are errors.
#ifndef CARTOGRAPHER_EXT_METRICS_LOCALIZATION_METRICS_H_
#define CARTOGRAPHER_EXT_METRICS_LOCALIZATION_METRICS_H_

#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/metrics/statistics.h"
#include "cartographer_ext/metrics/trajectory.h"
#include "cartographer_ext/metrics/trajectory_metrics.h"

namespace cartographer_ext {
namespace evaluation {

struct LocalizationOptions {
  double translation_tolerance = 0.3;        // metres
  double rotation_tolerance = DegToRad(5.);  // radians
  double hold_seconds = 10.;
  double settle_seconds = 1.;
  double jump_distance = 0.5;             // metres
  double wrong_rotation = DegToRad(10.);  // radians
  double carried_distance = 1.;           // metres, between two scans
  io::TimeNs stamp_tolerance = 1000000;
};

struct LocalizationSegment {
  io::TimeNs begin = 0;
  io::TimeNs end = 0;
  bool localized = false;
  // From the start until localised; undefined if never.
  double seconds = 0.;
  double metres = 0.;   // true path length
  int jumps = 0;        // after that
  int wrong_jumps = 0;  // before and after
  // After localisation, metres and degrees; share of scans within both
  // tolerances.
  Statistics translation_error;
  Statistics rotation_error_degrees;
  double fraction_within = 0.;
};

struct LocalizationMetrics {
  int64_t num_scans = 0;
  std::vector<LocalizationSegment> segments;  // at least one

  int num_localized() const;
  int num_jumps() const;
  int num_wrong_jumps() const;
};

// `pairs` of one robot in order of time, both poses in one frame; see
// Associate. An error for fewer than two.
absl::StatusOr<LocalizationMetrics> ComputeLocalizationMetrics(
    const std::vector<PosePair>& pairs, const LocalizationOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_METRICS_LOCALIZATION_METRICS_H_
