// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Initial guesses for a pose graph. The local minimum that a solver finds
// depends on its initial guess, and each of these is good where others are not:
//
//   ChainOdometry   needs no loop, drifts without bounds;
//   SpanningTree    prefers short paths over loops to long odometry, a wrong
//                   loop in the tree moves all behind it;
//   ChordalPoses    solves for all rotations at once and then for all
//                   positions (Martinec and Pajdla 2007, Carlone et al. 2015):
//                   two linear systems without any initial poses, so the
//                   length of the drift does not matter.
//
// All keep the first pose fixed.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_STARTS_STARTS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_STARTS_STARTS_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

// Poses by chaining odometry from the first pose. A part that odometry does not
// reach is attached by its first loop to what was reached before it, whether
// that loop is right or not.
std::vector<Pose2> ChainOdometry(const PoseGraph& graph);

// Poses along the tree of least uncertain paths from the first pose, over
// odometry and the loops whose weight is above one half. `weights` has one
// entry per edge. Unreachable poses keep their estimate.
std::vector<Pose2> SpanningTree(const PoseGraph& graph,
                                const std::vector<double>& weights);

// Chordal relaxation. With z_i = exp(i theta_i) and r_ij the measured rotation,
//
//   min sum w_ij |z_j - z_i r_ij|^2,                      z_0 given,
//
// then z_i / |z_i| are the rotations, and the positions solve
//
//   min sum |W_ij (R_i' (p_j - p_i) - t_ij)|^2,           p_0 given.
//
// `weights` multiply the edges; zero removes one. Returns false, without
// effect, if the edges in force do not determine the poses.
bool ChordalPoses(const std::vector<WhitenedEdge>& edges,
                  const std::vector<double>& weights,
                  std::vector<Pose2>* poses);

// The second of these systems alone, with the rotations of `poses`. Returns false,
// without effect, if the edges do not determine the positions.
bool PositionsOfHeadings(const std::vector<WhitenedEdge>& edges,
                         const std::vector<double>& weights,
                         std::vector<Pose2>* poses);

// The same with loops that contradict the rest downweighted, in a few rounds of
// reweighting by the Geman-McClure kernel: robust rotation averaging.
bool RobustChordalPoses(const std::vector<WhitenedEdge>& edges,
                        std::vector<Pose2>* poses);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_STARTS_STARTS_H_
