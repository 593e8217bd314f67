// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/option_printing.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer_ext/options/dropin/lua_options.h"
#include "cartographer_ext/options/option_description.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "sample_options.pb.h"

namespace cartographer_ext {
namespace options {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// The same block in two places, absent in the second.
std::vector<OptionBlock> SampleBlocks() {
  std::vector<OptionBlock> blocks(2);
  for (OptionBlock& block : blocks) {
    auto sample = absl::make_unique<test::SampleOptions>();
    SetDefaults(sample.get());
    block.name = "sample";
    block.summary = "Samples.";
    block.options = std::move(sample);
  }
  blocks[0].stock_path = "STOCK.first";
  blocks[0].present = true;
  static_cast<test::SampleOptions*>(blocks[0].options.get())
      ->mutable_window()
      ->set_length(4);
  blocks[1].stock_path = "STOCK.second";
  return blocks;
}

TEST(OptionPrintingTest, TextShowsBasicOptionsFirstAndMarksChangedValues) {
  const std::string text = ToText(SampleBlocks());
  EXPECT_THAT(text,
              StartsWith("Basic options\n* STOCK.first.cartographer_ext.window."
                         "length = 4  (default 10; >= 1 and <= 100)\n\n"
                         "Advanced options\n\nSTOCK.first.cartographer_ext\n  "
                         "Samples.\n"));
  EXPECT_THAT(text, HasSubstr("\n  enabled = true  (default true)\n"));
  EXPECT_THAT(text,
              HasSubstr("\n  window.gamma = 0.3  (default 0.3; > 0; 1/s)\n"));
  EXPECT_THAT(text, HasSubstr("STOCK.second.cartographer_ext: absent, stock "
                              "behaviour\n"));
}

TEST(OptionPrintingTest, MarkdownIsATable) {
  const std::string markdown = ToMarkdown(SampleBlocks());
  EXPECT_THAT(markdown, HasSubstr("## `STOCK.first.cartographer_ext`\n"));
  EXPECT_THAT(markdown,
              HasSubstr("|---|---|---|---|---|---|\n| `window.length` (basic) "
                        "| 4 | 10 | >= 1 and &lt;= 100 |  | How many. |\n"));
  // No value where the block is absent.
  EXPECT_THAT(markdown, HasSubstr("| `window.length` (basic) |  | 10 | >= 1 "
                                  "and &lt;= 100 |"));
}

TEST(OptionPrintingTest, LuaHasWhatIsPresent) {
  const std::string lua = ToLua(SampleBlocks());
  EXPECT_THAT(lua, HasSubstr("STOCK.first.cartographer_ext = {\n"));
  EXPECT_THAT(lua, HasSubstr("    length = 4,\n"));
  EXPECT_THAT(lua, Not(HasSubstr("STOCK.second")));
}

TEST(OptionPrintingTest, LuaFileReadsBackAsDefaults) {
  const std::string file = ToLuaFile(SampleBlocks());
  EXPECT_THAT(file, HasSubstr("--   sample.window.length = 10\n\n"));
  // Once, though it may stand in two places.
  const size_t first = file.find("CARTOGRAPHER_EXT.sample = {");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(file.find("CARTOGRAPHER_EXT.sample = {", first + 1),
            std::string::npos);
  cartographer::common::LuaParameterDictionary dictionary(
      file + "return { cartographer_ext = CARTOGRAPHER_EXT.sample }",
      absl::make_unique<cartographer::common::ConfigurationFileResolver>(
          std::vector<std::string>{}));
  test::SampleOptions read, defaults;
  ASSERT_TRUE(ReadExtension("STOCK.first", &dictionary, &read));
  SetDefaults(&defaults);
  EXPECT_EQ(read.SerializeAsString(), defaults.SerializeAsString());
}

}  // namespace
}  // namespace options
}  // namespace cartographer_ext
