// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/labelled_loops.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using proto::LoopDecision;
using testing::HasSubstr;

LabelledLoop Loop(const LoopVerdict label, const double grid,
                  const double temporal, const double fused,
                  const bool accepted) {
  LabelledLoop loop;
  loop.label = label;
  loop.decision.mutable_search()->set_grid_score(grid);
  if (temporal > 0.) loop.decision.mutable_temporal()->set_score(temporal);
  loop.decision.mutable_fusion()->set_final_score(fused);
  loop.decision.set_verdict(accepted ? LoopDecision::ACCEPTED
                                     : LoopDecision::REJECTED);
  return loop;
}

std::vector<LabelledLoop> Loops() {
  return {Loop(LoopVerdict::kCorrect, 0.6, 0.9, 0.99, true),
          Loop(LoopVerdict::kCorrect, 0.7, 0.8, 0.9, true),
          Loop(LoopVerdict::kCorrect, 0.8, 0., 0.5, false),
          Loop(LoopVerdict::kWrong, 0.7, 0.3, 0.1, false),
          Loop(LoopVerdict::kWrong, 0.9, 0.85, 0.95, true),
          Loop(LoopVerdict::kUnknown, 0.1, 0.1, 0.1, true)};
}

TEST(LabelledLoopsTest, AreaByHand) {
  // Three true, two false; the true one wins 1, ties and 1: 0.6 never wins, 0.7
  // ties once, 0.8 wins once: 1.5 of 6 pairs.
  const auto area = AreaUnderCurve(Scores(Loops(), ScoreKind::kGrid));
  ASSERT_TRUE(area.has_value());
  EXPECT_NEAR(*area, 1.5 / 6., 1e-12);
  // 0.9 wins twice, 0.8 once, of 4 pairs; one has no temporal score.
  EXPECT_NEAR(*AreaUnderCurve(Scores(Loops(), ScoreKind::kTemporal)), 3. / 4.,
              1e-12);
  // 0.99 wins twice, 0.9 and 0.5 once.
  EXPECT_NEAR(*AreaUnderCurve(Scores(Loops(), ScoreKind::kFused)), 4. / 6.,
              1e-12);
  EXPECT_FALSE(AreaUnderCurve({}).has_value());
  EXPECT_FALSE(AreaUnderCurve({{0.5, true}, {0.6, true}}).has_value());
}

TEST(LabelledLoopsTest, CurveFromStrictToLenient) {
  const std::vector<RatePoint> curve =
      RateCurve(Scores(Loops(), ScoreKind::kGrid));
  ASSERT_EQ(curve.size(), 4u);
  EXPECT_EQ(curve[0].threshold, 0.9);
  EXPECT_EQ(curve[0].true_positive_rate, 0.);
  EXPECT_EQ(curve[0].false_positive_rate, 0.5);
  EXPECT_EQ(curve[0].precision, 0.);
  EXPECT_EQ(curve[2].threshold, 0.7);
  EXPECT_NEAR(curve[2].true_positive_rate, 2. / 3., 1e-12);
  EXPECT_EQ(curve[2].false_positive_rate, 1.);
  EXPECT_EQ(curve[2].precision, 0.5);
  EXPECT_EQ(curve[3].true_positive_rate, 1.);
}

TEST(LabelledLoopsTest, ChainCountsWhatTruthCanJudge) {
  const ChainRates rates = RatesOfChain(Loops());
  EXPECT_EQ(rates.true_candidates, 3);
  EXPECT_EQ(rates.false_candidates, 2);
  EXPECT_NEAR(*rates.precision(), 2. / 3., 1e-12);
  EXPECT_NEAR(*rates.recall(), 2. / 3., 1e-12);
  EXPECT_FALSE(ChainRates().precision().has_value());
  EXPECT_FALSE(ChainRates().recall().has_value());
}

TEST(LabelledLoopsTest, ReliabilityByHand) {
  const std::vector<ScoredLabel> labels = {
      {0.02, false}, {0.04, true}, {0.55, true}, {0.95, true}, {1., true}};
  const auto bins = ReliabilityDiagram(labels);
  EXPECT_EQ(bins[0].count, 2);
  EXPECT_NEAR(bins[0].mean_score, 0.03, 1e-12);
  EXPECT_NEAR(bins[0].true_share, 0.5, 1e-12);
  EXPECT_EQ(bins[1].count, 0);
  EXPECT_EQ(bins[5].count, 1);
  EXPECT_EQ(bins[9].count, 2);
  // (2 * 0.47 + 0.45 + 2 * 0.025) / 5
  EXPECT_NEAR(*ExpectedCalibrationError(bins), 0.288, 1e-12);
  EXPECT_FALSE(ExpectedCalibrationError(ReliabilityDiagram({})).has_value());
}

TEST(LabelledLoopsTest, CandidatesTakeThePlaceOfLoops) {
  MapGraph graph;
  graph.submaps[{0, 0}];
  graph.nodes[{0, 5}];
  GraphConstraint intra;
  GraphConstraint loop;
  loop.is_loop = true;
  graph.constraints = {loop, intra};
  std::vector<LoopDecision> decisions(3);
  for (int i = 0; i < 3; ++i) decisions[i].set_node_index(5);
  decisions[0].mutable_search()->mutable_refined()->set_x(2.);
  // 1 was not found, 2 has no submap in the graph.
  decisions[2].mutable_search()->mutable_refined()->set_x(3.);
  decisions[2].set_submap_index(9);
  std::vector<LoopDecision> candidates;
  const MapGraph result = CandidateGraph(graph, decisions, &candidates);
  ASSERT_EQ(result.constraints.size(), 2u);
  EXPECT_FALSE(result.constraints[0].is_loop);
  EXPECT_TRUE(result.constraints[1].is_loop);
  EXPECT_EQ(result.constraints[1].relative_pose.x, 2.);
  ASSERT_EQ(candidates.size(), 1u);
}

TEST(LabelledLoopsTest, TableAndPicture) {
  const std::string csv = LabelledCsv(Loops());
  EXPECT_EQ(csv.find("label,translation_error,rotation_error,candidate,"), 0u);
  EXPECT_THAT(csv, HasSubstr("\ntrue,0,0,"));
  EXPECT_THAT(csv, HasSubstr("\nfalse,0,0,"));
  EXPECT_THAT(csv, HasSubstr("\nunknown,0,0,"));
  const std::string svg = CurvesSvg(Loops(), "a title");
  EXPECT_EQ(svg.find("<svg"), 0u);
  EXPECT_THAT(svg, HasSubstr("a title"));
  EXPECT_THAT(svg, HasSubstr("temporal score, area 0.750"));
  EXPECT_THAT(svg, HasSubstr("share of true loops"));
  EXPECT_THAT(svg, HasSubstr("</svg>"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
