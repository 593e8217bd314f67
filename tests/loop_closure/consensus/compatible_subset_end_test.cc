// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <vector>

#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/consensus/forth_and_back.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class CompatibleSubsetEndTest : public testing::Test {
 protected:
  CompatibleSubsetEndTest() : paths_(uncertainty::RandomWalk(), 1000) {
    for (int i = 0; i <= 200; ++i) {
      paths_.Add(uncertainty::NodeId{0, i}, ForthAndBack(i));
    }
  }

  // A badly predicted loop between the place of node i forth and back.
  static LoopEvidence Last(int64_t id, int i, double probability) {
    LoopEvidence loop = ForthAndBackLoop(id, i, 0., 0.6);
    loop.prior_sigma = 2.;
    loop.probability = probability;
    return loop;
  }

  CompatibleSubsetOptions options_;
  uncertainty::PathUncertainty paths_;
};

TEST_F(CompatibleSubsetEndTest, ProbableLoopsAreAccepted) {
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Last(0, 2, 0.89));
  subset.Add(Last(1, 1, 0.95));
  subset.Add(Last(2, 0, 0.9));
  EXPECT_THAT(subset.Decide(), IsEmpty());
  const auto decisions = subset.Decide(/*at_end=*/true);
  EXPECT_THAT(Accepted(decisions), ElementsAre(1, 2));
  EXPECT_EQ(decisions[0].reason, SubsetReason::kLikelyAtEnd);
  EXPECT_EQ(subset.num_undecided(), 1);
  // The run goes on.
  subset.Add(Last(3, 3, 0.5));
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(0, 3));

  // Not so where another hypothesis for the same nodes waits, ...
  CompatibleSubset contested(options_, &paths_);
  contested.Add(Last(0, 10, 0.99));
  LoopEvidence rival = Last(1, 10, 0.99);
  rival.edge.pose.pose.x += 12.;
  contested.Add(rival);
  EXPECT_THAT(Accepted(contested.Decide(true)), IsEmpty());
  // ... where nothing predicted it, ...
  CompatibleSubset unpredicted(options_, &paths_);
  LoopEvidence loop = Last(0, 10, 0.99);
  loop.prior_sigma = std::numeric_limits<double>::infinity();
  unpredicted.Add(loop);
  EXPECT_THAT(Accepted(unpredicted.Decide(true)), IsEmpty());
  // ... and in the literal subset of the paper.
  options_.single_strong_enabled = false;
  CompatibleSubset literal(options_, &paths_);
  literal.Add(Last(0, 10, 0.99));
  EXPECT_THAT(Accepted(literal.Decide(true)), IsEmpty());
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
