// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Absolute and relative trajectory error against a reference trajectory
// (Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS
// 2012), in the plane: x, y and yaw are compared.
//
// * ATE: the estimate is first aligned with the reference by the rigid motion
//   that minimises the sum of squared distances (Umeyama 1991, without scale;
//   in the plane the rotation is atan2(sum of cross products, sum of dot
//   products) of the centred points). The remaining distances are the errors. One
//   early wrong turn affects the whole run.
// * RPE: motion over a given path length, estimate against reference; needs no
//   alignment and measures drift.
#ifndef CARTOGRAPHER_EXT_METRICS_TRAJECTORY_METRICS_H_
#define CARTOGRAPHER_EXT_METRICS_TRAJECTORY_METRICS_H_

#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/metrics/statistics.h"
#include "cartographer_ext/metrics/trajectory.h"

namespace cartographer_ext {
namespace evaluation {

// Poses of both trajectories at one time.
struct PosePair {
  io::TimeNs time = 0;
  Pose2 estimate;   // (map <- robot)
  Pose2 reference;  // (reference <- robot)
};

// One pair for each estimated pose that the reference covers: the reference
// stamp within `tolerance`, otherwise interpolated.
std::vector<PosePair> Associate(const Trajectory& estimate,
                                const Trajectory& reference,
                                io::TimeNs tolerance);

// (reference <- map) by least squares. If the positions do not determine the
// rotation (a stationary robot), the mean heading is used.
Pose2 AlignInPlane(const std::vector<PosePair>& pairs);

struct TrajectoryErrors {
  int64_t num_pairs = 0;
  Pose2 alignment;  // (reference <- map)
  Statistics ate;   // metres
  Statistics ate_rotation_degrees;
  Statistics rpe;  // metres over `rpe_distance`
  Statistics rpe_rotation_degrees;
  double rpe_distance = 0.;
  // Distance in metres between the aligned and the reference pose at each
  // pair, in order of time.
  std::vector<double> distances;
};

struct TrajectoryMetricsOptions {
  io::TimeNs stamp_tolerance = 1000000;
  double rpe_distance = 1.;  // metres along the reference
};

// An error if fewer than two poses have a reference.
absl::StatusOr<TrajectoryErrors> ComputeTrajectoryErrors(
    const Trajectory& estimate, const Trajectory& reference,
    const TrajectoryMetricsOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_METRICS_TRAJECTORY_METRICS_H_
