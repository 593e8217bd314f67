// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/loop_comparison.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

GraphConstraint Loop(const int submap, const int node, const double x) {
  GraphConstraint constraint;
  constraint.submap_id = {0, submap};
  constraint.node_id = {0, node};
  constraint.relative_pose = Pose2(x, 0., 0.);
  constraint.is_loop = true;
  return constraint;
}

// Submap 0 at the origin, node i at x = i.
MapGraph Line(const std::vector<GraphConstraint>& constraints) {
  MapGraph graph;
  graph.submaps[{0, 0}].global_pose = Pose2();
  for (int i = 0; i < 40; ++i) {
    graph.nodes[{0, i}].global_pose = Pose2(i, 0., 0.);
  }
  graph.constraints = constraints;
  return graph;
}

TEST(LoopComparisonTest, TellsWhyLoopsAreMissing) {
  GraphConstraint insertion = Loop(0, 1, 0.);
  insertion.is_loop = false;
  const MapGraph first = Line({insertion, Loop(0, 2, 2.), Loop(0, 10, 10.),
                               Loop(0, 14, 9.), Loop(0, 30, 30.)});
  const MapGraph second =
      Line({insertion, Loop(0, 2, 2.01), Loop(0, 6, 6.), Loop(0, 3, 3.)});
  const LoopComparison comparison = CompareLoops(first, second, {});
  EXPECT_EQ(comparison.first, 4);
  EXPECT_EQ(comparison.second, 3);
  EXPECT_EQ(comparison.common, 1);
  EXPECT_EQ(comparison.common_same_pose, 1);
  EXPECT_NEAR(comparison.max_pose_difference, 0.01, 1e-12);
  EXPECT_DOUBLE_EQ(comparison.fraction_of_first, 0.25);
  EXPECT_NEAR(comparison.fraction_of_second, 1. / 3., 1e-12);
  EXPECT_EQ(comparison.neighbour_instead, 1);  // node 10 beside node 6
  EXPECT_EQ(comparison.other_visit, 1);        // node 14
  EXPECT_EQ(comparison.too_far, 1);            // node 30, 30 m away
  EXPECT_THAT(comparison.absences,
              testing::ElementsAre(
                  LoopAbsence::kPresent, LoopAbsence::kNeighbourInstead,
                  LoopAbsence::kOtherVisit, LoopAbsence::kTooFar));
  EXPECT_THAT(ExplainMissing(comparison),
              testing::HasSubstr("1 beyond the distance limit"));
}

TEST(LoopComparisonTest, FatesSayMoreThanPlaces) {
  const MapGraph first = Line({Loop(0, 2, 2.), Loop(0, 3, 3.), Loop(0, 10, 10.),
                               Loop(0, 20, 20.), Loop(0, 30, 30.)});
  const MapGraph second = Line({Loop(0, 2, 2.)});
  LoopOutcomes outcomes;
  const GraphId submap{0, 0};
  // Not what the run found, so its outcome does not matter.
  outcomes[{submap, {0, 2}}].kind = LoopOutcome::Kind::kNotSampled;
  outcomes[{submap, {0, 3}}].kind = LoopOutcome::Kind::kNotSampled;
  outcomes[{submap, {0, 10}}].kind = LoopOutcome::Kind::kTooFar;
  outcomes[{submap, {0, 20}}].kind = LoopOutcome::Kind::kSearched;
  LoopComparisonOptions options;
  options.outcomes = &outcomes;
  const LoopComparison comparison = CompareLoops(first, second, options);
  EXPECT_EQ(comparison.common, 1);
  EXPECT_EQ(comparison.not_sampled, 1);
  EXPECT_EQ(comparison.neighbour_instead, 1);  // node 3, too
  EXPECT_EQ(comparison.no_match, 1);
  EXPECT_EQ(comparison.too_far, 2);  // node 30 has no outcome but is 30 m away
  EXPECT_THAT(
      comparison.absences,
      testing::ElementsAre(LoopAbsence::kPresent, LoopAbsence::kNotSampled,
                           LoopAbsence::kTooFar, LoopAbsence::kNoMatch,
                           LoopAbsence::kTooFar));
  const std::string text = ExplainMissing(comparison);
  EXPECT_THAT(text,
              testing::HasSubstr(
                  "1 within the distance limit, but skipped by the sampler"));
  EXPECT_THAT(text, testing::HasSubstr("1 searched without a match"));
}

TEST(LoopComparisonTest, EqualGraphs) {
  const MapGraph graph = Line({Loop(0, 2, 2.)});
  const LoopComparison comparison = CompareLoops(graph, graph, {});
  EXPECT_EQ(comparison.fraction_of_first, 1.);
  EXPECT_EQ(ExplainMissing(comparison), "");
}

TEST(LoopComparisonTest, NoLoopsAreAllFound) {
  EXPECT_EQ(CompareLoops(Line({}), Line({}), {}).fraction_of_first, 1.);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
