// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Families of pose graphs with known ground truth, for questions that the few
// public data sets cannot answer. A seed chooses size, noise and path of the
// graph; the same seed gives the same graph on every platform.
//
//   ring           one to four rings of kilometres, several laps, heading noise
//                  of 0.01 to 0.1 rad per step: uncertain odometry
//   road           blocks of streets at car speed with the drift of visual
//                  odometry and few loops
//   grid           a robot in a Manhattan world, many loops
//   star           arms walked out and back
//   floors         two floors above each other, joined once or three times; no
//                  loop leads from one to the other
//   robots         two to four trajectories in frames of their own, joined by
//                  loops only
//   few            one of ring, road, grid and star with 3 to 30 loops in all
//   overconfident  one of these with overconfident information matrices: chi2
//                  of 5 to 100 per loop
//   underconfident the same with a chi2 of 0.01 to 1
//
// Some of the graphs have gaps in their ids, some more than one fixed pose. The
// noise is Gaussian and, except for the last two families, as given by the
// information matrices.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_GRAPH_FAMILIES_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_GRAPH_FAMILIES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace experiments {

struct FamilyGraph {
  optimization::PoseGraph graph;  // poses are chained odometry
  std::vector<Pose2> truth;       // of each pose
  // Factors by which the information matrices were multiplied.
  double odometry_confidence = 1.;
  double loop_confidence = 1.;
};

const std::vector<std::string>& FamilyNames();

// An error for an unknown family.
absl::StatusOr<FamilyGraph> GenerateFamilyGraph(const std::string& family,
                                                uint64_t seed);

}  // namespace experiments
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_GRAPH_FAMILIES_H_
