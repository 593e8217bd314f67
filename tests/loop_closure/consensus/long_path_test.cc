// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Loops that close paths of hundreds of metres.
#include <cmath>
#include <memory>

#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/consensus/forth_and_back.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using testing::IsEmpty;
using uncertainty::LoopEdge;
using uncertainty::NodeId;

Eigen::Matrix3d OfALoop() {
  return Eigen::Vector3d(0.0025, 0.0025, 1e-4).asDiagonal();
}

// 400 m there and back again, on which local SLAM turns 40 degrees too far.
class LongPathTest : public testing::Test {
 protected:
  static constexpr int kNumNodes = 1600;

  LongPathTest() : paths_(uncertainty::PathNoiseOptions(), 10000) {
    options_.scores_are_probabilities = true;
    options_.single_strong_enabled = false;
    Pose2 pose;
    for (int i = 0; i <= kNumNodes; ++i) {
      paths_.Add(NodeId{0, i}, pose);
      pose = pose *
             Pose2(0.5, 0., (i == kNumNodes / 2 ? kPi : 0.) + 0.7 / kNumNodes);
    }
  }

  // The place of node i, seen again on the way back.
  LoopEvidence Revisit(const int64_t id, const int i, const double score) {
    LoopEvidence loop;
    loop.id = id;
    loop.edge.a = NodeId{0, i};
    loop.edge.b = NodeId{0, kNumNodes - i};
    loop.edge.pose.pose = Pose2(0., 0., kPi);
    loop.edge.pose.covariance = OfALoop();
    loop.score = score;
    loop.prior_sigma = 45.;
    return loop;
  }
  // Two nodes of one visit, as the path has them.
  LoopEvidence Short(const int64_t id, const int i) {
    LoopEvidence loop;
    loop.id = id;
    loop.edge.a = NodeId{0, i};
    loop.edge.b = NodeId{0, i + 4};
    loop.edge.pose.pose = paths_.Between(loop.edge.a, loop.edge.b)->pose;
    loop.edge.pose.covariance = OfALoop();
    loop.score = 0.9;
    return loop;
  }
  double ChiSquare(const LoopEdge& u, const LoopEdge& v) {
    return uncertainty::TestCycle(options_.cycle, u.pose,
                                  *paths_.Between(u.b, v.b), v.pose,
                                  *paths_.Between(v.a, u.a))
        .chi_square;
  }

  CompatibleSubsetOptions options_;
  uncertainty::PathUncertainty paths_;
};

// Between a short loop in the middle and one that closes the whole path lie
// 300 m, and half a radian: 10 seen from one, 23 from the other.
TEST_F(LongPathTest, ACycleIsSeenFromBothEnds) {
  const LoopEvidence wide = Revisit(1, 200, 0.9);
  const LoopEvidence narrow = Short(2, 790);
  EXPECT_LT(ChiSquare(narrow.edge, wide.edge), options_.cycle.chi_square_bound);
  EXPECT_GT(ChiSquare(wide.edge, narrow.edge), options_.cycle.chi_square_bound);
  for (const bool wide_first : {false, true}) {
    CompatibleSubset subset(options_, &paths_);
    subset.Add(wide_first ? wide : narrow);
    subset.Add(wide_first ? narrow : wide);
    EXPECT_THAT(subset.Decide(), IsEmpty());
    const auto undecided = subset.Undecided();
    ASSERT_EQ(undecided.size(), 2u);
    for (const SubsetDecision& decision : undecided) {
      EXPECT_EQ(decision.contradictions, 0) << wide_first;
      EXPECT_EQ(decision.subset_size, 2) << wide_first;
    }
  }
}

// 0.3: with the factor 3 a share of 1 + ln(3/7) / ln 3 = 0.23, with 10 one of
// 0.63.
TEST_F(LongPathTest, RevisitsThatAgreeFarOffSayMore) {
  for (const double odds : {1., 10.}) {
    CompatibleSubset subset(options_, &paths_);
    subset.SetOddsPerFarRevisit(odds);
    for (int k = 0; k < 5; ++k) subset.Add(Revisit(k, 200 + 15 * k, 0.3));
    EXPECT_EQ(Accepted(subset.Decide()).size(), odds > 3. ? 5u : 0u) << odds;
  }
  // Where they were predicted well, it is what is left open anyway.
  CompatibleSubset predicted(options_, &paths_);
  predicted.SetOddsPerFarRevisit(10.);
  for (int k = 0; k < 5; ++k) {
    LoopEvidence loop = Revisit(k, 200 + 15 * k, 0.3);
    loop.prior_sigma = 1.;
    predicted.Add(loop);
  }
  EXPECT_THAT(Accepted(predicted.Decide()), IsEmpty());
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
