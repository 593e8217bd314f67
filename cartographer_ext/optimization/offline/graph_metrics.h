// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Metrics of an optimised graph: two for the poses against a reference (ground
// truth, or the optimum without outliers), two for the loops.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_GRAPH_METRICS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_GRAPH_METRICS_H_

#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

// Rigid motion (reference <- estimate) which brings the estimate's positions
// closest to the reference's in the sense of least squares.
Pose2 Align(const std::vector<Pose2>& estimate,
            const std::vector<Pose2>& reference);

// Root mean square distance in metres after Align. Sizes must agree.
double AbsoluteTrajectoryError(const std::vector<Pose2>& estimate,
                               const std::vector<Pose2>& reference);

// For references sampled at other times and without stamps (the GPS ground
// truth of Bicocca): index of the reference pose belonging to each pose of the
// estimate, from dynamic time warping of positions after alignment, repeated
// until the alignment settles. First and last poses belong together. It
// underestimates the error of all estimates slightly and equally.
std::vector<int> AssociateByPath(const std::vector<Pose2>& estimate,
                                 const std::vector<Pose2>& reference);

// RPE of the papers (ACS eq. 15, R-iSAM eq. 20) in square metres: mean over
// odometry edges of the squared difference of the relative displacement in the
// frame of the edge's first pose. It does not detect a folded map, so never use
// it alone.
double RelativePoseError(const std::vector<PoseGraphEdge>& edges,
                         const std::vector<Pose2>& estimate,
                         const std::vector<Pose2>& reference);

// Counts of right and wrong decisions on loops.
struct LoopScore {
  int true_accepted = 0;
  int true_total = 0;
  int false_accepted = 0;  // only outliers beyond the gate at the reference
  int accepted = 0;
  double precision = 1.;  // 1 - false_accepted / accepted
  double recall = 1.;     // true_accepted / true_total
};

// Judges the decision "chi2 < kChi2Gate at `estimate`". Loops from index
// `first_outlier` on are outliers; one that lies inside the gate at the
// reference is true by chance and not counted as false. All other loops count
// as true, also the one in a hundred which lies beyond the gate at the
// reference.
LoopScore ScoreLoops(const std::vector<WhitenedEdge>& edges,
                     size_t first_outlier, const std::vector<Pose2>& estimate,
                     const std::vector<Pose2>& reference);
// The same for given decisions, one per edge.
LoopScore ScoreLoops(const std::vector<WhitenedEdge>& edges,
                     size_t first_outlier, const std::vector<bool>& accepted,
                     const std::vector<Pose2>& reference);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_GRAPH_METRICS_H_
