// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Evidence of a scan for one pose in a grid against another: the difference of
// its log-likelihoods (natural logarithm),
//
//   L = sum over patches of  mean over the points in the patch of  ln p,
//
// where p is the probability of the cell under the point. Neighbouring points
// lie on one surface and are not independent: a patch, a square cell of the
// scan, counts once regardless of the number of beams in it. An unknown cell is
// evidence neither for nor against a pose (p = 0.5); otherwise scans of new
// places would be pulled back to known walls.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_SCAN_EVIDENCE_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_SCAN_EVIDENCE_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace scan_matching {

// The number of patches that the sum above has; points that are not finite have
// none.
int NumPatches(const cartographer::sensor::PointCloud& cloud);

// For one pose of a scan, against any other. Poses are (frame of the grid <-
// cloud).
class PoseEvidence {
 public:
  // The grid must outlive it.
  PoseEvidence(const Pose2& pose, const cartographer::sensor::PointCloud& cloud,
               const cartographer::mapping::Grid2D& grid);

  // L(pose) - L(`other`). Zero without points. Infinite in a TSDF, whose
  // distances are not probabilities: there the match is always trusted.
  double Against(const Pose2& other) const;

 private:
  struct Point {
    Eigen::Vector2d position;
    double log_probability;  // at the pose
  };

  const cartographer::mapping::Grid2D& grid_;
  std::vector<std::vector<Point>> patches_;
};

// The same for one other pose.
double ScanEvidence(const Pose2& pose, const Pose2& other,
                    const cartographer::sensor::PointCloud& cloud,
                    const cartographer::mapping::Grid2D& grid);

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_SCAN_EVIDENCE_H_
