// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/cost_comparison.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace experiments {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string NewFile() {
  const std::string filename = testing::TempDir() + "/costs.jsonl";
  std::remove(filename.c_str());
  return filename;
}

std::string ReadFile(const std::string& filename) {
  std::ifstream stream(filename);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

void WriteFile(const std::string& filename, const std::string& content) {
  std::ofstream(filename) << content;
}

TEST(CostComparisonTest, ComparesEachGraphOnce) {
  SweepOptions options;
  options.families = {"few"};
  options.types = {"none", "R"};
  options.counts = {"20%", "50%"};
  options.first_seed = 3;
  options.seeds = 2;
  const auto comparisons = CompareCosts(options);
  ASSERT_TRUE(comparisons.ok()) << comparisons.status();
  ASSERT_EQ(comparisons->size(), 6u);
  EXPECT_EQ((*comparisons)[0].count, 0);
  EXPECT_EQ((*comparisons)[0].seed, 3);
  EXPECT_EQ((*comparisons)[1].seed, 4);
  EXPECT_EQ((*comparisons)[2].requested_count, "20%");
  EXPECT_GT((*comparisons)[4].count, (*comparisons)[2].count);
  for (const CostComparison& comparison : *comparisons) {
    EXPECT_GT(comparison.cost, 0.);
    EXPECT_THAT(comparison.rival, Not(testing::IsEmpty()));
    EXPECT_LE(comparison.excess, kCostTolerance);
  }
}

TEST(CostComparisonTest, DataSetWithoutOutliersDoesNotChangeWithTheSeed) {
  SweepOptions options;
  options.datasets = {test::OwnData("square.g2o")};
  options.types = {"none"};
  options.counts = {"0"};
  options.seeds = 3;
  const auto comparisons = CompareCosts(options);
  ASSERT_TRUE(comparisons.ok()) << comparisons.status();
  ASSERT_EQ(comparisons->size(), 1u);
  EXPECT_EQ(comparisons->front().dataset, "square");
}

TEST(CostComparisonTest, GoesOnWhereItWasKilled) {
  SweepOptions options;
  options.families = {"few"};
  options.types = {"none", "L"};
  options.counts = {"30%"};
  options.first_seed = 5;
  options.seeds = 2;
  options.journal_filename = NewFile();
  const auto whole = CompareCosts(options);
  ASSERT_TRUE(whole.ok()) << whole.status();
  const std::string text = ReadFile(options.journal_filename);
  ASSERT_EQ(std::count(text.begin(), text.end(), '\n'), 5);
  // Killed in the third line; what is in the file is believed.
  std::vector<std::string> lines = absl::StrSplit(text, '\n');
  nlohmann::json first = nlohmann::json::parse(lines[1]);
  EXPECT_EQ(first["cost"].get<double>(), whole->front().cost);
  first["cost"] = 1e9;
  WriteFile(options.journal_filename,
            absl::StrCat(lines[0], "\n", first.dump(), "\n",
                         lines[2].substr(0, lines[2].size() / 2)));
  const auto rest = CompareCosts(options);
  ASSERT_TRUE(rest.ok()) << rest.status();
  ASSERT_EQ(rest->size(), 4u);
  EXPECT_EQ(rest->front().cost, 1e9);
  EXPECT_EQ(rest->front().rival, whole->front().rival);
  for (size_t i = 1; i != rest->size(); ++i) {
    EXPECT_EQ((*rest)[i].cost, (*whole)[i].cost);
    EXPECT_EQ((*rest)[i].dataset, "few");
  }
  // Other seeds are not those of the journal.
  options.first_seed = 6;
  options.types = {"none"};
  const auto other = CompareCosts(options);
  ASSERT_TRUE(other.ok()) << other.status();
  EXPECT_EQ(other->front().cost, (*whole)[1].cost);
  EXPECT_EQ(other->back().seed, 7);
  EXPECT_NE(other->back().cost, 1e9);
}

TEST(CostComparisonTest, AJournalOfOtherOptionsIsAnError) {
  SweepOptions options;
  options.datasets = {test::OwnData("square.g2o")};
  options.types = {"none"};
  options.counts = {"0"};
  options.journal_filename = NewFile();
  ASSERT_TRUE(CompareCosts(options).ok());
  options.group_size = 3;
  EXPECT_THAT(std::string(CompareCosts(options).status().message()),
              HasSubstr("other options"));
  WriteFile(options.journal_filename, "{\"dataset\":\"intel\"}\n");
  EXPECT_THAT(std::string(CompareCosts(options).status().message()),
              HasSubstr("not a journal of costs"));
}

// Two hundred metres straight on, and a loop to a place 20 m beside the path.
// Taken at their word, matrices of 1 m a step make bending the path the cheaper
// explanation; with the actual 0.2 m it costs more than to refuse the loop.
TEST(CostComparisonTest, TheNoiseDecidesWhichMapCostsMore) {
  constexpr int kPoses = 201;
  optimization::PoseGraph graph;
  for (int i = 0; i != kPoses; ++i) {
    graph.ids.push_back(i);
    graph.poses.push_back(Pose2(i, 0., 0.));
  }
  const auto add = [&](const int from, const int to, const bool is_loop,
                       const Pose2& measurement) {
    optimization::PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = is_loop;
    edge.measurement = measurement;
    edge.information = Eigen::Vector3d(1., 1., 1e6).asDiagonal();
    graph.edges.push_back(edge);
  };
  for (int i = 1; i != kPoses; ++i) add(i - 1, i, false, Pose2(1., 0., 0.));
  add(0, kPoses - 1, true, Pose2(kPoses - 1, 20., 0.));
  std::vector<Pose2> bent = graph.poses;
  for (Pose2& pose : bent) pose.y = 0.1 * pose.x;
  optimization::NoiseScale noise;
  EXPECT_GT(ExcessWithNoise(graph, noise, graph.poses, bent), 1.);
  noise.odometry.factor = noise.loops.factor = 0.2;
  EXPECT_LT(ExcessWithNoise(graph, noise, graph.poses, bent), -0.1);
}

TEST(CostComparisonTest, TableAndJsonNameWhatIsAbove) {
  CostComparison below, above;
  below.dataset = above.dataset = "ring";
  below.type = above.type = "R";
  below.excess = -0.1;
  below.seed = 7;
  above.seed = 8;
  above.rival = "tree, gm";
  above.excess = 2e-6;
  above.estimated_excess = -1e-3;
  const std::string table = CostTable({below, above});
  EXPECT_THAT(table, HasSubstr("above: ring R  seed 8"));
  EXPECT_THAT(table, HasSubstr("tree, gm"));
  EXPECT_THAT(table, Not(HasSubstr("seed 7")));
  const nlohmann::ordered_json json = CostJson({below, above});
  EXPECT_EQ(json["above"], 1);
  EXPECT_EQ(json["above_in_both"], 0);
  EXPECT_EQ(json["graphs"], 2);
  EXPECT_EQ(json["comparisons"][0]["above"], false);
  above.excess = 0.9 * kCostTolerance;
  EXPECT_EQ(CostJson({below, above})["above"], 0);
}

TEST(CostComparisonTest, BadInputIsNamed) {
  SweepOptions options;
  options.families = {"moon"};
  options.types = {"none"};
  options.counts = {"0"};
  EXPECT_THAT(std::string(CompareCosts(options).status().message()),
              HasSubstr("moon"));
}

}  // namespace
}  // namespace experiments
}  // namespace cartographer_ext
