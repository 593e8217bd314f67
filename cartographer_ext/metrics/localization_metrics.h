// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How well a robot knew where it was in a map, scan by scan, from the poses
// that it reported at the time (OnlinePoses) and the true ones, both in the
// frame of the map.
//
//   stretch     From the start to the end; a robot that was carried (its true
//               pose moves farther from one scan to the next than it can drive)
//               begins a new one.
//   localised   From the first scan from which on the pose stays within the
//               tolerances for `hold_seconds`, or to the end of the stretch.
//   jump        The reported pose moves against the truth by more than
//               `jump_distance` from one scan to the next: by a loop closure,
//               not by drift. Not in the first `settle_seconds` of a stretch,
//               when local SLAM finds itself among other walls.
//   wrong       A jump that ends farther from the truth than `jump_distance`,
//               or turned by more than `wrong_rotation`: the robot was put
//               into another place than it was in.
//
// A robot that does not know its place has to jump once, to the right one. All
// jumps after it was localised are wrong in themselves.
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

struct LocalizationStretch {
  io::TimeNs begin = 0;
  io::TimeNs end = 0;
  bool localized = false;
  // From the beginning until localised; meaningless when never.
  double seconds = 0.;
  double metres = 0.;   // truly driven
  int jumps = 0;        // after that
  int wrong_jumps = 0;  // before and after
  // After that, metres and degrees; share of scans within both tolerances.
  Statistics translation_error;
  Statistics rotation_error_degrees;
  double fraction_within = 0.;
};

struct LocalizationMetrics {
  int64_t num_scans = 0;
  std::vector<LocalizationStretch> stretches;  // at least one

  int num_localized() const;
  int num_jumps() const;
  int num_wrong_jumps() const;
};

// `pairs` in order of time, of one robot, both poses in one frame; see
// Associate. An error for fewer than two.
absl::StatusOr<LocalizationMetrics> ComputeLocalizationMetrics(
    const std::vector<PosePair>& pairs, const LocalizationOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_METRICS_LOCALIZATION_METRICS_H_
