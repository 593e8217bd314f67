// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How much more likely a scan is at one pose in a grid than at another: the
// difference of its log-likelihoods, natural logarithm,
//
//   L = sum over patches of  mean over the points in the patch of  ln p,
//
// where p is the probability of the cell under the point. Points that are close
// together lie on one surface and are right or wrong together: a patch, a
// square of the scan, counts once however many beams fall into it. A cell that
// has not been seen yet may hold anything; it speaks neither for nor against a
// pose (p = 0.5), otherwise scans would be drawn back from new places to known
// walls.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_SCAN_EVIDENCE_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_SCAN_EVIDENCE_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace scan_matching {

// For one pose of a scan, against any other. Poses are (frame of the grid <-
// cloud).
class PoseEvidence {
 public:
  // The grid must outlive it.
  PoseEvidence(const Pose2& pose, const cartographer::sensor::PointCloud& cloud,
               const cartographer::mapping::Grid2D& grid);

  // L(pose) - L(`other`). Zero without points. Infinite in a TSDF, whose
  // distances are not probabilities: there matches are beyond doubt.
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
