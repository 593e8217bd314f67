// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Dynamic time warping of two sequences of range signatures, and the variable
// window (paper C, optimised Cartographer 2025, section 1.2, eq. 4).
//
// The query are the scans of the last nodes, the reference is the prediction of
// a submap along the same path placed at the candidate pose, sampled more
// finely. Warping absorbs the error of the odometry scale; a Sakoe-Chiba band
// limits it.
//
//   D(i, j) = c(i, j) + min(D(i-1, j), D(i, j-1), D(i-1, j-1))
//
// The score is 1 - D / (length of the warping path), in [0, 1] for local costs
// in [0, 1].
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_DTW_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_DTW_H_

#include <vector>

#include "absl/types/optional.h"

namespace cartographer_ext {
namespace loop_closure {

// Parameters of eq. 4.
struct VariableWindowOptions {
  // N_0 of eq. 4, nodes. The paper has 4; over 6 m of the path, nodes half a
  // metre apart, look-alike places differ somewhere.
  double base = 12.;
  double span = 2.;    // growth of eq. 4, nodes
  double gamma = 0.3;  // 1/unit of age
};

// C eq. 4: N = base + span (1 - exp(-gamma t)), rounded to the nearest integer
// and at least one. `age` is the age of the submap in seconds or in nodes,
// depending on the options of the builder; negative ages count as zero.
int VariableWindow(const VariableWindowOptions& options, double age);

// The best warping path.
struct DtwResult {
  double cost = 0.;     // sum of local costs along the best path
  int path_length = 0;  // cells on the best path
  // 1 - cost / path_length.
  double score() const { return 1. - cost / path_length; }
};

// `local_cost[i * num_reference + j]` is the cost, in [0, 1], of matching query
// i with reference j; NaN means "not comparable" and excludes the cell. `band`
// is the half width of the Sakoe-Chiba band in reference elements, around the
// straight line between the corners; negative: no band. The path runs from
// corner to corner. Of paths with equal costs the shorter one is used, so the
// result is unique. Empty if a sequence is empty or no path exists.
absl::optional<DtwResult> DynamicTimeWarping(
    int num_query, int num_reference, const std::vector<double>& local_cost,
    double band);

// The same with one step for each query element: the path has exactly one cell
// per query element, and the reference advances by 0 ... `max_advance` (>= 0)
// elements from one to the next. Fine sampling of the reference then adds no
// cost, and a perfect repetition has score 1. The last query element is matched
// with the last reference element (the candidate pose); the first with any
// within the band. Empty as above. `path`, unless null, receives the reference
// element of each query element.
absl::optional<DtwResult> AsymmetricTimeWarping(
    int num_query, int num_reference, const std::vector<double>& local_cost,
    double band, int max_advance, std::vector<int>* path = nullptr);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_DTW_H_
