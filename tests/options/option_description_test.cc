// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/option_description.h"

#include <cmath>
#include <limits>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "sample_options.pb.h"

namespace cartographer_ext {
namespace options {
namespace {

using testing::HasSubstr;

TEST(OptionDescriptionTest, DefaultsComeFromTheAnnotations) {
  test::SampleOptions sample;
  SetDefaults(&sample);
  EXPECT_TRUE(sample.enabled());
  EXPECT_EQ(sample.mode(), test::SampleOptions::PROPER);
  EXPECT_EQ(sample.window().length(), 10);
  EXPECT_EQ(sample.window().gamma(), 0.3);
}

TEST(OptionDescriptionTest, NumbersAreChecked) {
  const auto& window = *test::SampleOptions::Window::descriptor();
  const auto& length = *window.FindFieldByName("length");
  const auto& gamma = *window.FindFieldByName("gamma");
  EXPECT_EQ(CheckNumber(length, 1.), "");
  EXPECT_EQ(CheckNumber(length, 100.), "");
  EXPECT_EQ(CheckNumber(length, 0.),
            "0 is out of range, allowed: >= 1 and <= 100");
  EXPECT_EQ(CheckNumber(gamma, 1e-9), "");
  EXPECT_EQ(CheckNumber(gamma, 0.), "0 is out of range, allowed: > 0");
  EXPECT_NE(CheckNumber(gamma, std::numeric_limits<double>::infinity()), "");
  EXPECT_NE(CheckNumber(gamma, std::nan("")), "");
}

TEST(OptionDescriptionTest, DescribesEveryOptionInOrder) {
  test::SampleOptions sample;
  SetDefaults(&sample);
  sample.mutable_window()->set_gamma(0.125);
  const auto descriptions = Describe(sample);
  ASSERT_EQ(descriptions.size(), 5u);
  EXPECT_EQ(descriptions[0].key, "enabled");
  EXPECT_EQ(descriptions[0].type, "boolean");
  EXPECT_EQ(descriptions[1].range, "one of: as_printed, proper");
  EXPECT_EQ(descriptions[3].key, "window.gamma");
  EXPECT_EQ(descriptions[3].default_value, "0.3");
  EXPECT_EQ(descriptions[3].value, "0.125");
  EXPECT_EQ(descriptions[3].unit, "1/s");
  EXPECT_EQ(descriptions[4].type, "text");
  EXPECT_EQ(descriptions[4].value, "");
}

TEST(OptionDescriptionTest, PrintsLua) {
  test::SampleOptions sample;
  SetDefaults(&sample);
  sample.set_folder("a\\\"b");
  const std::string lua = ToLua("cartographer_ext", sample);
  EXPECT_THAT(lua, HasSubstr("cartographer_ext = {\n"));
  EXPECT_THAT(lua, HasSubstr("  mode = \"proper\",\n"));
  EXPECT_THAT(lua, HasSubstr("  window = {\n"));
  EXPECT_THAT(lua, HasSubstr("  folder = \"a\\\\\\\"b\",\n"));
  EXPECT_THAT(lua,
              HasSubstr("    -- How fast. [> 0, 1/s]\n    gamma = 0.3,\n"));
  size_t begin = 0;
  while (begin < lua.size()) {
    const size_t end = lua.find('\n', begin);
    EXPECT_LE(end - begin, 80u) << lua.substr(begin, end - begin);
    begin = end + 1;
  }
}

}  // namespace
}  // namespace options
}  // namespace cartographer_ext
