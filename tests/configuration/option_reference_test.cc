// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/option_reference.h"

#include <set>
#include <string>

#include "cartographer_ext/configuration/option_blocks.h"
#include "cartographer_ext/options/option_description.h"
#include "cartographer_ext/swaps.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<OptionEffect> Effects(const std::string& lines) {
  const auto effects =
      ParseOptionEffects("key,value,recording,ratio\n" + lines, "effects.csv");
  EXPECT_TRUE(effects.ok()) << effects.status();
  return *effects;
}

TEST(OptionReferenceTest, AtMostSixtyKeysAndTwelveBasicOnes) {
  std::set<std::string> names;
  int num_options = 0;
  int num_basic = 0;
  for (const options::OptionBlock& block : OptionBlocks(SlamConfiguration())) {
    if (!names.insert(block.name).second) continue;
    for (const auto& option : options::Describe(*block.options)) {
      ++num_options;
      num_basic += option.is_basic;
      EXPECT_FALSE(option.documentation.empty()) << option.key;
    }
  }
  EXPECT_LE(num_options, 60);
  EXPECT_LE(num_basic, 12);
}

TEST(OptionReferenceTest, EffectsAreComparedWithTheScatter) {
  const std::string text = OptionReference(
      OptionBlocks(SlamConfiguration()),
      Effects("scatter,,a,1.1\nscatter,,b,1.5\n"
              "optimization_problem.loop_sigma,0.3,a,0.8\n"
              "optimization_problem.loop_sigma,0.3,b,1.4\n"
              "optimization_problem.robust_loops,false,b,nan\n"));
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
  EXPECT_THAT(text, HasSubstr("| option | value | a | b | beyond scatter |\n"
                              "|---|---|---|---|---|\n"
                              "| three times the scatter |  | +10.0 % | +50.0 "
                              "% |  |\n"));
  EXPECT_THAT(text, HasSubstr("| `optimization_problem.loop_sigma` | 0.3 | "
                              "-20.0 % | +40.0 % | 1 of 2 |\n"));
  EXPECT_THAT(text, HasSubstr("| `optimization_problem.robust_loops` | false | "
                              "- | failed | 1 of 1 |\n"));
  EXPECT_THAT(text, HasSubstr("| `optimization_problem.odometry_check` | not "
                              "measured |  |  |  |\n"));
  EXPECT_THAT(text, HasSubstr("`POSE_GRAPH.optimization_problem.cartographer_"
                              "ext`: `gate`, "));
#endif
  EXPECT_THAT(text, Not(HasSubstr("schema")));
}

TEST(OptionReferenceTest, BadEffectsAreNamed) {
  const auto error = [](const std::string& text) {
    return std::string(
        ParseOptionEffects(text, "effects.csv").status().message());
  };
  EXPECT_THAT(error("key,value\n"), HasSubstr("effects.csv:1: "));
  EXPECT_THAT(error("key,value,recording,ratio\na,1,b,c\n"),
              HasSubstr("effects.csv:2: 'a,1,b,c'"));
  EXPECT_THAT(error("key,value,recording,ratio\na,1,b\n"),
              HasSubstr("effects.csv:2: "));
  EXPECT_THAT(error("key,value,recording,ratio\na,1,b,-2\n"),
              HasSubstr("effects.csv:2: "));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
