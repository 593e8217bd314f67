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

// How the poses are compared.
enum class PosePrecision {
  // As given: both are matches of the scan.
  kExact,
  // Only the first one is a match, the others are predictions. Walls are often
  // one cell thick with unknown space behind, so that a pose that is wrong by a
  // cell sideways would be as unlikely as one in another room: the others have
  // the largest L of the poses up to a cell off in each axis. And where beams
  // hit a wall far from each other, it is known only where they did when the
  // robot stood: a point stands for the surface up to the middle between it and
  // the points beside it, with the largest p on it.
  kCell,
};

// For one pose of a scan against others. Poses are (frame of the grid <- cloud).
class PoseEvidence {
 public:
  // The grid must outlive it.
  PoseEvidence(const Pose2& pose, const cartographer::sensor::PointCloud& cloud,
               const cartographer::mapping::Grid2D& grid,
               PosePrecision precision);

  // The same scan at another pose.
  void SetPose(const Pose2& pose);

  // L(pose); zero without points and in a TSDF.
  double log_likelihood() const { return log_likelihood_; }

  // L(pose) - L(`other`). Zero without points. Infinite in a TSDF, whose
  // distances are not probabilities: there the match is always trusted.
  double Against(const Pose2& other) const;

  // The same without the object that speaks most for the pose: what is within half
  // a metre of one point. Somebody who walks ahead of the robot, or beside it, is
  // at one place of its scans, as if it stood still; the other things it sees are
  // not.
  double AgainstWithoutObject(const Pose2& other) const;

 private:
  struct Point {
    // The point first, then the surface around it.
    std::vector<Eigen::Vector2d> surface;
    double weight;  // those of a patch add up to one
  };

  struct Best {
    Pose2 pose;
    double log_likelihood = 0.;
  };

  // Calls `function` with the part of each point in L(pose).
  template <typename Function>
  void ForEachPart(const Pose2& pose, const Function& function) const;
  // Of the poses up to so many cells off, that of the largest L.
  Best BestNear(const Pose2& pose, int tolerance) const;

  const cartographer::mapping::Grid2D& grid_;
  const int tolerance_;  // of the others, cells
  std::vector<Point> points_;
  Pose2 pose_;
  double log_likelihood_ = 0.;  // at the pose
};

// The same for one other pose, with PosePrecision::kCell.
double ScanEvidence(const Pose2& pose, const Pose2& other,
                    const cartographer::sensor::PointCloud& cloud,
                    const cartographer::mapping::Grid2D& grid);

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_SCAN_EVIDENCE_H_
