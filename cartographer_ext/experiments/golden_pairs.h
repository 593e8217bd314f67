// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Golden files: results of the scan matchers of the real Cartographer.
//
// A golden file is a CSV with one line per pair of a submap and a node of a
// pbstream: the initial pose, the result of the branch-and-bound search around
// it (7 m, 30 degrees, depth 7; or in the full submap), and the result of the
// Ceres matcher (weights 20, 10 and 1; non-monotonic; 10 iterations) started
// from there. Columns are found by their names in the first line.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_GOLDEN_PAIRS_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_GOLDEN_PAIRS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/mapping/id.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace evaluation {

struct GoldenPair {
  int64_t line = 0;  // of the file, from 1
  bool full_submap = false;
  cartographer::mapping::SubmapId submap_id{0, 0};
  cartographer::mapping::NodeId node_id{0, 0};
  int num_points = 0;
  Pose2 initial_pose;  // (local frame of the submap <- node), as all poses here
  double min_score = 0.;
  bool found = false;
  double score = 0.;
  Pose2 pose;
  double search_microseconds = 0.;
  // The rest only if found.
  Pose2 refined_pose;
  double final_cost = 0.;
  double refine_microseconds = 0.;
  double build_microseconds = 0.;  // of the submap's search grids
};

// An unreadable file, a missing column or a bad number is an error with the
// file and line.
absl::StatusOr<std::vector<GoldenPair>> ReadGoldenPairs(
    const std::string& filename);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_GOLDEN_PAIRS_H_
