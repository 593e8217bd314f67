// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/rerun_configuration.h"

#include "cartographer_ext/configuration/option_messages.h"
#include "cartographer_ext/options/extension_field.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::PoseGraphOptions;
using testing::Contains;
using testing::HasSubstr;

MapGraph GraphWithWeights(const std::vector<double>& loop_weights) {
  MapGraph graph;
  GraphConstraint insertion;
  insertion.translation_weight = 7.;
  insertion.rotation_weight = 8.;
  graph.constraints.push_back(insertion);
  for (const double weight : loop_weights) {
    GraphConstraint loop;
    loop.is_loop = true;
    loop.translation_weight = weight;
    loop.rotation_weight = 2. * weight;
    graph.constraints.push_back(loop);
  }
  return graph;
}

TEST(RerunConfigurationTest, StockIsAssumedAndWeightsAreTheMaps) {
  const auto configuration = LoadRerunConfiguration(
      {"configuration_files"}, "", "", GraphWithWeights({5., 5.}));
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  EXPECT_EQ(configuration->stock_name, "stock.lua");
  EXPECT_FALSE(configuration->stock_is_known);
  EXPECT_FALSE(configuration->ours.has_value());
  const auto& builder = configuration->stock.constraint_builder_options();
  EXPECT_EQ(builder.loop_closure_translation_weight(), 5.);
  EXPECT_EQ(builder.loop_closure_rotation_weight(), 10.);
  EXPECT_EQ(configuration->stock.matcher_translation_weight(), 7.);
  EXPECT_EQ(configuration->stock.matcher_rotation_weight(), 8.);
  EXPECT_THAT(configuration->assumptions,
              Contains(HasSubstr("the defaults (stock.lua) are assumed")));
}

TEST(RerunConfigurationTest, VariousWeightsAreLeftAlone) {
  const auto configuration = LoadRerunConfiguration(
      {"configuration_files"}, "stock.lua", "", GraphWithWeights({5., 6.}));
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  EXPECT_EQ(configuration->stock.constraint_builder_options()
                .loop_closure_translation_weight(),
            1.1e4);
  EXPECT_TRUE(configuration->stock_is_known);
  EXPECT_THAT(configuration->assumptions, Contains(HasSubstr("various")));
}

TEST(RerunConfigurationTest, StockIsOursWithoutTheBlocks) {
  const auto configuration = LoadRerunConfiguration(
      {"configuration_files"}, "default.lua", "", MapGraph());
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  ASSERT_TRUE(configuration->ours.has_value());
  EXPECT_FALSE(configuration->stock_is_known);
  PoseGraphOptions without = *configuration->ours;
  EXPECT_TRUE(RemoveExtensions(&without));
  EXPECT_FALSE(RemoveExtensions(&without));
  EXPECT_EQ(without.SerializeAsString(),
            configuration->stock.SerializeAsString());
  EXPECT_NE(configuration->ours->SerializeAsString(),
            configuration->stock.SerializeAsString());
  EXPECT_THAT(DescribeDifferences(configuration->stock, *configuration->ours),
              Contains(HasSubstr("cartographer_ext: absent -> ")));
}

TEST(RerunConfigurationTest, BlocksGoIntoTheFileOfStock) {
  const auto configuration = LoadRerunConfiguration(
      {"configuration_files"}, "default.lua", "stock.lua", MapGraph());
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  EXPECT_EQ(configuration->stock_name, "stock.lua");
  EXPECT_TRUE(configuration->stock_is_known);
  EXPECT_EQ(configuration->ours_name,
            "stock.lua with the blocks of default.lua");
  ASSERT_TRUE(configuration->ours.has_value());
  for (const std::string& line :
       DescribeDifferences(configuration->stock, *configuration->ours)) {
    EXPECT_THAT(line, HasSubstr("cartographer_ext: absent -> "));
  }
}

TEST(RerunConfigurationTest, MissingFileIsNamed) {
  const auto configuration = LoadRerunConfiguration(
      {"configuration_files"}, "no_such.lua", "", MapGraph());
  ASSERT_FALSE(configuration.ok());
  EXPECT_THAT(std::string(configuration.status().message()),
              HasSubstr("no_such.lua"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
