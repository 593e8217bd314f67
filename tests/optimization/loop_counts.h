// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_TESTS_OPTIMIZATION_LOOP_COUNTS_H_
#define CARTOGRAPHER_EXT_TESTS_OPTIMIZATION_LOOP_COUNTS_H_

#include <cstddef>
#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace test {

struct LoopCounts {
  int right = 0;
  int right_in_force = 0;
  int wrong_in_force = 0;
};

// Of edges with these weights, those from `first_outlier` on being wrong loops.
// Odometry must be in force.
inline LoopCounts CountLoops(const std::vector<WhitenedEdge>& edges,
                             const size_t first_outlier,
                             const std::vector<double>& weights) {
  LoopCounts counts;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!edges[i].is_loop) {
      EXPECT_EQ(weights[i], 1.);
    } else if (i < first_outlier) {
      ++counts.right;
      counts.right_in_force += weights[i] > 0.;
    } else {
      counts.wrong_in_force += weights[i] > 0.;
    }
  }
  return counts;
}

}  // namespace test
}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TESTS_OPTIMIZATION_LOOP_COUNTS_H_
