// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/option_blocks.h"

#include <memory>
#include <string>
#include <vector>

#include "cartographer_ext/loop_closure_options.pb.h"
#include "cartographer_ext/options/option_description.h"
#include "cartographer_ext/scan_matcher_options.pb.h"
#include "cartographer_ext/swaps.h"
#include "glog/logging.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

SlamConfiguration Parse(const std::string& more) {
  const auto configuration = ParseSlamConfiguration(
      {"configuration_files"}, "test.lua",
      "include \"common_2d.lua\"\n" + more +
          "\nreturn { map_builder = MAP_BUILDER, trajectory_builder = "
          "TRAJECTORY_BUILDER }\n");
  CHECK(configuration.ok()) << configuration.status();
  return *configuration;
}

std::vector<std::string> Paths(
    const std::vector<options::OptionBlock>& blocks) {
  std::vector<std::string> paths;
  for (const options::OptionBlock& block : blocks) {
    paths.push_back(block.stock_path);
  }
  return paths;
}

TEST(OptionBlocksTest, AbsentBlocksHaveTheirDefaults) {
  const auto blocks = OptionBlocks(Parse(""));
  for (const options::OptionBlock& block : blocks) {
    EXPECT_FALSE(block.present) << block.stock_path;
    EXPECT_FALSE(block.summary.empty());
    ASSERT_NE(block.options, nullptr);
    const std::unique_ptr<google::protobuf::Message> defaults(
        block.options->New());
    options::SetDefaults(defaults.get());
    EXPECT_EQ(block.options->SerializeAsString(),
              defaults->SerializeAsString());
  }
}

#if defined(CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER) && \
    defined(CARTOGRAPHER_EXT_SWAP_CERES_SCAN_MATCHER) &&       \
    defined(CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER) &&       \
    defined(CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM)

TEST(OptionBlocksTest, InTheOrderOfTheData) {
  EXPECT_THAT(
      Paths(OptionBlocks(Parse(""))),
      testing::ElementsAre("TRAJECTORY_BUILDER_2D",
                           "TRAJECTORY_BUILDER_2D.ceres_scan_matcher",
                           "POSE_GRAPH.constraint_builder",
                           "POSE_GRAPH.constraint_builder.ceres_scan_matcher",
                           "POSE_GRAPH.optimization_problem"));
}

TEST(OptionBlocksTest, PresentBlocksHaveTheValuesGiven) {
  const auto blocks = OptionBlocks(
      Parse("POSE_GRAPH.constraint_builder.cartographer_ext = "
            "{ search = { max_searches_per_node = 3 } }\n"
            "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.cartographer_ext = {}"));
  ASSERT_EQ(blocks.size(), 5u);
  EXPECT_FALSE(blocks[0].present);
  EXPECT_TRUE(blocks[1].present);
  EXPECT_TRUE(blocks[2].present);
  // The two matchers are told apart.
  EXPECT_FALSE(blocks[3].present);
  EXPECT_FALSE(blocks[4].present);
  const auto* const loops =
      dynamic_cast<const proto::LoopClosureOptions*>(blocks[2].options.get());
  ASSERT_NE(loops, nullptr);
  EXPECT_EQ(loops->search().max_searches_per_node(), 3);
  // What is left out keeps its default.
  EXPECT_EQ(loops->compatible_subset().min_revisits(), 2);
  EXPECT_NE(
      dynamic_cast<const proto::ScanMatcherOptions*>(blocks[1].options.get()),
      nullptr);
}

#endif

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
