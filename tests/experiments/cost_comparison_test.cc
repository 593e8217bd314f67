// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/cost_comparison.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace experiments {
namespace {

using testing::HasSubstr;
using testing::Not;

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

TEST(CostComparisonTest, TableAndJsonNameWhatIsAbove) {
  CostComparison below, above;
  below.dataset = above.dataset = "ring";
  below.type = above.type = "R";
  below.excess = -0.1;
  below.seed = 7;
  above.seed = 8;
  above.rival = "tree, gm";
  above.excess = 2e-6;
  const std::string table = CostTable({below, above});
  EXPECT_THAT(table, HasSubstr("above: ring R  seed 8"));
  EXPECT_THAT(table, HasSubstr("tree, gm"));
  EXPECT_THAT(table, Not(HasSubstr("seed 7")));
  const nlohmann::ordered_json json = CostJson({below, above});
  EXPECT_EQ(json["above"], 1);
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
