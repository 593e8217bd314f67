// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// 50 m forth and back in a corridor, a node every half metre: nodes i and
// 200 - i are at one place. The run ends where it began.
#ifndef TESTS_LOOP_CLOSURE_CONSENSUS_FORTH_AND_BACK_H_
#define TESTS_LOOP_CLOSURE_CONSENSUS_FORTH_AND_BACK_H_

#include <cstdint>
#include <vector>

#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"
#include "gtest/gtest.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {

// The pose of node i.
inline Pose2 ForthAndBack(const int i) {
  return i <= 100 ? Pose2(0.5 * i, 0., 0.) : Pose2(100. - 0.5 * i, 0., kPi);
}

// A loop between the place of node i forth and back, wrong by `offset` metres
// along the corridor.
inline LoopEvidence ForthAndBackLoop(const int64_t id, const int i,
                                     const double offset, const double score) {
  LoopEvidence loop;
  loop.id = id;
  loop.edge.a = uncertainty::NodeId{0, i};
  loop.edge.b = uncertainty::NodeId{0, 200 - i};
  loop.edge.pose.pose =
      Pose2(offset, 0., 0.) * Between(ForthAndBack(i), ForthAndBack(200 - i));
  loop.edge.pose.covariance =
      Eigen::Vector3d(0.0025, 0.0025, 1e-4).asDiagonal();
  loop.score = score;
  return loop;
}

// Options where scores are probabilities, without the rule for single strong loops,
// and the path.
class ForthAndBackTest : public testing::Test {
 protected:
  ForthAndBackTest() : paths_(uncertainty::RandomWalk(), 1000) {
    options_.single_strong_enabled = false;
    options_.scores_are_probabilities = true;
    for (int i = 0; i <= 200; ++i) {
      paths_.Add(uncertainty::NodeId{0, i}, ForthAndBack(i));
    }
  }

  CompatibleSubsetOptions options_;
  uncertainty::PathUncertainty paths_;
};

// Ids of the accepted loops.
inline std::vector<int64_t> Accepted(
    const std::vector<SubsetDecision>& decisions) {
  std::vector<int64_t> ids;
  for (const SubsetDecision& decision : decisions) {
    if (decision.accepted) ids.push_back(decision.id);
  }
  return ids;
}

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // TESTS_LOOP_CLOSURE_CONSENSUS_FORTH_AND_BACK_H_
