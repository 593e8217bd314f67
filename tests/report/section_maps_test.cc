// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "cartographer_ext/report/sections.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/report/report_example.h"

namespace cartographer_ext {
namespace report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(SectionMapsTest, TrajectoriesArePartedInThePath) {
  evaluation::MapGraph graph = test::ExampleGraph();
  graph.nodes[{1, 0}].global_pose = Pose2(7., 7., 0.);
  const auto path = NodePath(graph);
  ASSERT_EQ(path.size(), 7u);
  EXPECT_EQ(path[4], Eigen::Vector2d(4., 0.));
  EXPECT_FALSE(path[5].allFinite());
  EXPECT_EQ(path[6], Eigen::Vector2d(7., 7.));
  EXPECT_TRUE(NodePath(evaluation::MapGraph()).empty());
  const auto seconds = NodeSeconds(graph, 100 * test::kSecond);
  ASSERT_EQ(seconds.size(), path.size());
  EXPECT_EQ(seconds[4], 4.);
  EXPECT_TRUE(std::isnan(seconds[5]));
}

TEST(SectionMapsTest, ASoundMapHasNoPlacesAgainstIt) {
  const ReportData data = test::ExampleData(false);
  Markup page;
  AddMaps(data, test::Prepare(data), &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("<h2 id=\"map\">"));
  EXPECT_EQ(test::Count(html, "<figure"), 1u);
  EXPECT_THAT(html, Not(HasSubstr("<table")));
  EXPECT_THAT(html, Not(HasSubstr("compare")));
}

TEST(SectionMapsTest, RingsRoundContradictions) {
  ReportData data = test::ExampleData(false);
  data.runs[0].evaluation.consistency = test::ExampleConsistency();
  Markup page;
  AddMaps(data, test::Prepare(data), &page);
  const std::string& html = page.str();
  EXPECT_EQ(test::Count(html, "class=\"ring\""), 2u);
  EXPECT_THAT(html, HasSubstr("(0, 1) to (0, 2)"));
  EXPECT_THAT(html, HasSubstr("1.0 to 2.0 s"));
  EXPECT_THAT(html, HasSubstr("75 %"));
  EXPECT_THAT(html, HasSubstr("submaps (0, 1)"));
  EXPECT_THAT(html, HasSubstr("odometry, by 40 deg"));
}

// The worst node of the piece and the nearest one of the submap it contradicts;
// the nodes before and after a wrong turn.
TEST(SectionMapsTest, ARingNamesTheScansThatDoNotAgree) {
  ReportData data = test::ExampleData(false);
  data.runs[0].evaluation.consistency = test::ExampleConsistency();
  auto& nodes = data.runs[0].evaluation.consistency->contradictions.nodes;
  nodes[2].worst_fraction = 0.9;
  nodes[2].worst_submap_id = {0, 1};
  for (const int index : {0, 4}) {
    evaluation::GraphConstraint inserted;
    inserted.submap_id = {0, 1};
    inserted.node_id = {0, index};
    data.runs[0].graph.constraints.push_back(inserted);
  }
  data.runs[0].graph.nodes.at({0, 4}).global_pose = Pose2(2.5, 0., 0.1);
  Markup page;
  AddMaps(data, test::Prepare(data), &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("data-name=\"nodes (0, 1) to (0, 2) (\" "
                              "data-t=\"1\""));
  EXPECT_THAT(html, HasSubstr("data-scan=\"0:2 2 0 0\" "
                              "data-other=\"0:4 2.5 0 0.1\""));
  EXPECT_THAT(html, HasSubstr("data-name=\"before node (0, 3) (\""));
  EXPECT_THAT(html, HasSubstr("data-scan=\"0:3 3 0 0\" "
                              "data-other=\"0:2 2 0 0\""));
  const std::vector<evaluation::GraphId> expected = {
      {0, 2}, {0, 4}, {0, 3}, {0, 2}};
  EXPECT_EQ(NodesOfPlaces(data), expected);
}

TEST(SectionMapsTest, RunsAreLaidOverEachOther) {
  const ReportData data = test::ExampleData(true);
  Prepared prepared = test::Prepare(data);
  prepared.image_ids = {"map0", "map1"};
  Markup page;
  AddMaps(data, prepared, &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("Before and after: as stored, ours"));
  EXPECT_THAT(html, HasSubstr("id=\"compare1\""));
  EXPECT_THAT(html, HasSubstr("data-target=\"compare1\""));
  EXPECT_THAT(html, HasSubstr("href=\"#map1\""));
  EXPECT_EQ(test::Count(html, "<figure"), test::Count(html, "</figure>"));
  EXPECT_EQ(test::Count(html, "<div"), test::Count(html, "</div>"));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
