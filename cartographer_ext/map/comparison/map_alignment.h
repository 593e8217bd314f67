// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Aligns two maps. Maps of one run share nodes: the transform that most of them
// agree with is found by testing single nodes, as in RANSAC but with evenly
// spaced nodes instead of drawn ones, and refined over those that agree
// [Umeyama 1991]. Maps of two runs share walls: all rotations and offsets are
// searched on a coarse grid [Olson 2009], then nearest walls are paired and
// fitted alternately [Besl and McKay 1992] with a decreasing pairing radius.
#ifndef CARTOGRAPHER_EXT_MAP_COMPARISON_MAP_ALIGNMENT_H_
#define CARTOGRAPHER_EXT_MAP_COMPARISON_MAP_ALIGNMENT_H_

#include <utility>
#include <vector>

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

struct MapAlignment {
  Pose2 first_from_second;  // (first map <- second map)
  // Share of the nodes, or of the walls of the smaller map, that coincide with
  // the other map.
  double agreement = 0.;
};

// The poses of one node in both maps.
using NodePosePair = std::pair<Pose2, Pose2>;

// A node of the first map and the pose of the robot at its stamp in the second
// map.
struct CommonNode {
  GraphId id;  // in the first map
  io::TimeNs time = 0;
  NodePosePair poses;
};

// Matched by trajectory and stamp. If the second map has no node within 0.1 ms,
// its path is interpolated between nodes at most two seconds apart, because a
// re-run of local SLAM may insert different scans.
std::vector<CommonNode> FindCommonNodes(const MapGraph& first,
                                        const MapGraph& second);

// Rigid fit of the second poses to the first ones. Pairs further apart than
// `tolerance` (metres) after the fit are ignored. Empty without pairs.
absl::optional<MapAlignment> AlignPoses(const std::vector<NodePosePair>& pairs,
                                        double tolerance);

// Least squares over points, (first <- second); needs one pair at least.
Pose2 FitPoints(const std::vector<Eigen::Vector2d>& first,
                const std::vector<Eigen::Vector2d>& second);

// Aligns walls, given as positions of occupied cells in metres. Empty if no
// pose puts a fifth of the smaller map's walls onto those of the other.
absl::optional<MapAlignment> AlignWalls(
    const std::vector<Eigen::Vector2d>& first,
    const std::vector<Eigen::Vector2d>& second, double tolerance);

// AlignWalls from a known initial pose: pairs and fits only.
MapAlignment RefineWalls(const std::vector<Eigen::Vector2d>& first,
                         const std::vector<Eigen::Vector2d>& second,
                         const Pose2& first_from_second, double radius,
                         double tolerance);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_COMPARISON_MAP_ALIGNMENT_H_
