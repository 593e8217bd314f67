// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/map_quality.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace repair {
namespace {

using testing::HasSubstr;

// Nodes [begin, end) see a place again.
void Judge(const int begin, const int end, const bool contradicted,
           MapQuality* const quality) {
  for (int i = begin; i < end; ++i) {
    quality->is_contradicted[{0, i}] = contradicted;
  }
}

// Nodes 0 to 99 agree, 100 to 149 contradict.
MapQuality Broken() {
  MapQuality quality;
  quality.verdict = "broken";
  quality.severe_share = 0.3;
  quality.contradicted_rays = 0.2;
  quality.open_cycles = 0.1;
  quality.loop_residual = 0.5;
  quality.entropy = -1.;
  Judge(0, 100, false, &quality);
  Judge(100, 150, true, &quality);
  return quality;
}

TEST(MapQualityTest, TheFirstMeasureThatDiffersDecides) {
  MapQuality better = Broken();
  EXPECT_THAT(WhyNotBetter(Broken(), better),
              HasSubstr("would not change in quality"));
  better.severe_share = 0.2;
  better.contradicted_rays = 0.3;
  better.entropy = 0.;
  EXPECT_EQ(WhyNotBetter(Broken(), better), "");
  EXPECT_THAT(WhyNotBetter(better, Broken()), HasSubstr("severe share"));
  better = Broken();
  better.contradicted_rays = 0.1;
  better.open_cycles = 0.9;
  EXPECT_EQ(WhyNotBetter(Broken(), better), "");
  better = Broken();
  better.loop_residual = 0.1;
  better.entropy = 0.;
  EXPECT_EQ(WhyNotBetter(Broken(), better), "");
  EXPECT_THAT(WhyNotBetter(better, Broken()), HasSubstr("distance"));
  better = Broken();
  better.entropy = -1.1;
  EXPECT_EQ(WhyNotBetter(Broken(), better), "");
  EXPECT_THAT(WhyNotBetter(better, Broken()), HasSubstr("entropy"));
}

TEST(MapQualityTest, TheVerdictGoesBeforeTheMeasures) {
  MapQuality doubtful = Broken();
  doubtful.verdict = "doubtful";
  doubtful.severe_share = 0.31;
  EXPECT_EQ(WhyNotBetter(Broken(), doubtful), "");
  EXPECT_THAT(WhyNotBetter(doubtful, Broken()),
              HasSubstr("would be broken, it is doubtful"));
}

TEST(MapQualityTest, PlacesThatComeToAgreeAreEvidence) {
  MapQuality better = Broken();
  better.severe_share = 0.5;
  Judge(100, 110, false, &better);
  EXPECT_EQ(GainOfEvidence(Broken(), better), 10 + 3 * 10);
  EXPECT_EQ(GainOfEvidence(better, Broken()), -(10 + 3 * 10));
  EXPECT_EQ(WhyNotBetter(Broken(), better), "");
  EXPECT_THAT(WhyNotBetter(better, Broken()), HasSubstr("fewer places agree"));
  // Places seen twice only now.
  better = Broken();
  Judge(200, 210, false, &better);
  // A node of the broken map is worth that much.
  const double worth = (100. - 3. * 50.) / (150. + 8.);
  EXPECT_NEAR(GainOfEvidence(Broken(), better), 10. - 10. * worth, 1e-9);
  Judge(210, 220, true, &better);
  EXPECT_NEAR(GainOfEvidence(Broken(), better), 10. - 3. * 10. - 20. * worth,
              1e-9);
  // Places of a map that agrees are taken as they are.
  MapQuality right;
  Judge(0, 100, false, &right);
  better = right;
  Judge(100, 110, false, &better);
  EXPECT_EQ(GainOfEvidence(right, better), 10.);
  Judge(110, 120, true, &better);
  EXPECT_EQ(GainOfEvidence(right, better), 10. - 3. * 10.);
}

// Each place more would speak against a folded map.
TEST(MapQualityTest, ToBeJudgedAtMorePlacesIsNoFault) {
  MapQuality few;
  few.verdict = "doubtful";
  Judge(0, 57, false, &few);
  Judge(57, 84, true, &few);
  MapQuality many = few;
  Judge(100, 386, false, &many);
  Judge(386, 500, true, &many);  // 28 % of the new ones, before 32 %
  EXPECT_GT(GainOfEvidence(few, many), 0.);
  EXPECT_THAT(WhyNotBetter(few, many), testing::Not(HasSubstr("fewer places")));
  EXPECT_LT(GainOfEvidence(many, few), 0.);
  // Not so if they contradict more often.
  MapQuality worse = few;
  Judge(100, 300, false, &worse);
  Judge(300, 500, true, &worse);
  EXPECT_LT(GainOfEvidence(few, worse), 0.);
  EXPECT_THAT(WhyNotBetter(few, worse), HasSubstr("fewer places agree"));
  // What one node says is no measure for hundreds.
  MapQuality one;
  Judge(0, 1, true, &one);
  EXPECT_LT(GainOfEvidence(one, worse), 0.);
}

// All contradictions are gone because nothing overlaps there any more.
TEST(MapQualityTest, AMapTornApartIsNotBetter) {
  MapQuality torn = Broken();
  torn.verdict = "sound";
  torn.severe_share = 0.;
  for (int i = 95; i < 150; ++i) torn.is_contradicted.erase({0, i});
  EXPECT_EQ(GainOfEvidence(Broken(), torn), -5.);
  EXPECT_THAT(WhyNotBetter(Broken(), torn), HasSubstr("fewer places agree"));
  Judge(95, 110, false, &torn);
  EXPECT_EQ(WhyNotBetter(Broken(), torn), "");
  torn.verdict = "unknown";
  EXPECT_THAT(WhyNotBetter(Broken(), torn), HasSubstr("apart"));
}

// The best version so far of a library with equal aisles, and one that agrees at
// some nodes more because more of it hangs free.
TEST(MapQualityTest, AVersionOfWhichMoreCameLooseIsNotBetter) {
  MapQuality tied;
  tied.verdict = "doubtful";
  Judge(0, 1018, false, &tied);
  Judge(1018, 1048, true, &tied);
  tied.loose_share = 0.033;
  MapQuality loose = tied;
  Judge(1018, 1022, false, &loose);  // worth 16 nodes
  EXPECT_EQ(WhyNotBetter(tied, loose), "");
  loose.loose_share = 0.04;
  EXPECT_EQ(WhyNotBetter(tied, loose), "");
  loose.loose_share = 0.083;  // 52 nodes more
  EXPECT_THAT(WhyNotBetter(tied, loose),
              HasSubstr("more came loose than agrees: 8.3 % of the path"));
  Judge(1018, 1033, false, &loose);  // 60 nodes
  EXPECT_EQ(WhyNotBetter(tied, loose), "");
}

// What agrees may be the smaller part.
TEST(MapQualityTest, AVersionThatRestsOnFewerRevisitsIsNotBetter) {
  MapQuality loose = Broken();
  loose.verdict = "doubtful";
  loose.severe_share = 0.;
  loose.is_contradicted.clear();
  Judge(30, 140, false, &loose);
  EXPECT_GT(GainOfEvidence(Broken(), loose), 0.);
  EXPECT_EQ(WhyNotBetter(Broken(), loose), "");
  loose.loose_share = 0.45;
  EXPECT_THAT(WhyNotBetter(Broken(), loose),
              HasSubstr("it rests on fewer revisits: 110 nodes see a place of "
                        "another time, before 150"));
  EXPECT_NE(WhyNotWritten(Broken(), loose), "");
  // It was no closer before.
  MapQuality before = Broken();
  before.loose_share = 0.45;
  EXPECT_EQ(WhyNotBetter(before, loose), "");
  // Nor is it written where it compares as many.
  Judge(0, 150, false, &loose);
  EXPECT_EQ(WhyNotBetter(Broken(), loose), "");
  EXPECT_THAT(WhyNotWritten(Broken(), loose),
              HasSubstr("45.0 % of the path may lie elsewhere"));
  loose.loose_share = 0.01;
  EXPECT_EQ(WhyNotWritten(Broken(), loose), "");
}

TEST(MapQualityTest, DisplacedNodesDoNotAgree) {
  evaluation::SelfConsistency consistency;
  for (int i = 0; i < 10; ++i) {
    evaluation::NodeContradiction node;
    node.node_id = {0, i};
    node.judged = i == 5 ? 0 : 100;
    consistency.contradictions.nodes.push_back(node);
  }
  EXPECT_EQ(QualityOf({}, consistency).num_agreeing(), 9);
  evaluation::PathPiece piece;
  piece.first_node = {0, 4};
  piece.last_node = {0, 6};
  consistency.displacements.pieces = {piece};
  const MapQuality quality = QualityOf({}, consistency);
  EXPECT_EQ(quality.num_agreeing(), 7);
  EXPECT_EQ(quality.num_contradicted(), 2);
}

TEST(MapQualityTest, AMapThatCannotBeJudgedIsNotWritten) {
  MapQuality unknown = Broken();
  unknown.verdict = "unknown";
  MapQuality better = unknown;
  Judge(100, 150, false, &better);
  EXPECT_EQ(WhyNotBetter(unknown, better), "");
  EXPECT_THAT(WhyNotWritten(unknown, better), HasSubstr("nothing tells"));
  better.verdict = "sound";
  EXPECT_EQ(WhyNotWritten(unknown, better), "");
}

TEST(MapQualityTest, ABrokenMapIsNotWritten) {
  MapQuality better = Broken();
  Judge(100, 140, false, &better);
  better.severe_share = 0.06;
  EXPECT_EQ(WhyNotBetter(Broken(), better), "");
  EXPECT_THAT(WhyNotWritten(Broken(), better),
              HasSubstr("still broken (6.0 %)"));
  better.verdict = "doubtful";
  EXPECT_EQ(WhyNotWritten(Broken(), better), "");
  EXPECT_NE(WhyNotWritten(better, better), "");
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
