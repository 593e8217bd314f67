// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds wrong loops to a pose graph, of the four types with which both papers
// (after the Vertigo package) test robust back ends:
//
//   R    random: both ends anywhere
//   L    local: the ends 2 to 20 poses apart
//   RG   random grouped: the same measurement on (a + j, b + j),
//        j = 0 .. group - 1
//   LG   local grouped
//
// Each outlier claims that both poses are at the same place:
//
//   x, y ~ N(0, 0.3 m),  theta ~ N(0, 10 deg)
//
// with the information matrix of the graph's first loop. Some are therefore
// true by chance (the robot turns on the spot or comes back); score precision
// against the optimum without outliers. The papers state neither the size of
// groups nor whether counts are groups or edges: here `count` is edges and a
// group has ten. The generator is portable: the same seed gives the same
// outliers on every platform.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_OUTLIERS_OUTLIER_GENERATOR_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_OUTLIERS_OUTLIER_GENERATOR_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

enum class OutlierType { kRandom, kLocal, kRandomGrouped, kLocalGrouped };

// "R", "L", "RG", "LG".
absl::StatusOr<OutlierType> OutlierTypeFromName(absl::string_view name);
std::string OutlierTypeName(OutlierType type);

struct OutlierOptions {
  OutlierType type = OutlierType::kRandom;
  int count = 1000;  // edges
  int group_size = 10;
  uint64_t seed = 1;
  double translation_sigma = 0.3;            // metres, each axis
  double rotation_sigma = 10. * kPi / 180.;  // radians
  int local_span = 20;                       // poses
};

// The outliers alone, all loops, from < to. An error when the graph has too few
// poses for the span and group. Without any loop in the graph the information
// is diag(44.72, 44.72, 44.72) (that of the Manhattan set).
absl::StatusOr<std::vector<PoseGraphEdge>> GenerateOutliers(
    const PoseGraph& graph, const OutlierOptions& options);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_OUTLIERS_OUTLIER_GENERATOR_H_
