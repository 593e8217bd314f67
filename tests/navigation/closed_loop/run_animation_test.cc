// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/run_animation.h"

#include <cstdio>
#include <string>

#include "gtest/gtest.h"
#include "nlohmann/json.hpp"
#include "tests/navigation/closed_loop/small_run.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(RunAnimationTest, IsOnePageThatFetchesNothing) {
  const std::string filename = testing::TempDir() + "/run_animation_test.html";
  ASSERT_TRUE(WriteRunAnimation(SmallRun(), "a <drive>", filename).ok());
  const std::string page = Read(filename);
  std::remove(filename.c_str());
  EXPECT_EQ(page.find("http"), std::string::npos);
  EXPECT_NE(page.find("<title>a &lt;drive&gt;</title>"), std::string::npos);
  EXPECT_EQ(page.find('%' + std::string("DATA")), std::string::npos);
  // A message cannot end the script.
  EXPECT_EQ(page.find("</script>"), page.rfind("</script>"));
  // The data are JSON.
  const size_t begin = page.find("const run = ") + 12;
  const size_t end = page.find(";\n", begin);
  const auto data = nlohmann::json::parse(page.substr(begin, end - begin));
  EXPECT_EQ(data["frames"].size(), 2u);
  EXPECT_TRUE(data["frames"][0].contains("l"));
  EXPECT_FALSE(data["frames"][1].contains("l"));
  int cells = 0;
  for (size_t i = 1; i < data["map"]["runs"].size(); i += 2) {
    cells += data["map"]["runs"][i].get<int>();
  }
  EXPECT_EQ(cells, 80 * 60);
  EXPECT_FALSE(WriteRunAnimation(SmallRun(), "x", "/no/such/folder/x").ok());
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
