// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/markup.h"

#include <cmath>
#include <limits>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace report {
namespace {

using testing::HasSubstr;

TEST(MarkupTest, EscapesWhatIsNotOurs) {
  EXPECT_EQ(Escape("<a href=\"x\">'&"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;");
  EXPECT_EQ(Escape(std::string("a\0b\x1b"
                               "c\n",
                               6)),
            "a b c\n");
  EXPECT_EQ(Escape("\xc3\xa9"), "\xc3\xa9");
}

TEST(MarkupTest, NumbersAreShort) {
  EXPECT_EQ(Number(1.50, 2), "1.5");
  EXPECT_EQ(Number(-0.0001, 2), "0");
  EXPECT_EQ(Number(100., 0), "100");
  EXPECT_EQ(Number(12.3456, 3), "12.346");
  EXPECT_EQ(Number(std::numeric_limits<double>::quiet_NaN()), "0");
}

TEST(MarkupTest, NestsElements) {
  Markup markup;
  markup.Open("p", {{"class", "a\"b"}});
  markup.Text("1 < 2");
  markup.Empty("br", {});
  markup.Element("b", {}, "&");
  markup.Close();
  EXPECT_EQ(markup.str(),
            "<p class=\"a&quot;b\">1 &lt; 2<br/><b>&amp;</b>\n</p>\n");
}

TEST(MarkupDeathTest, OpenElementsAreAnError) {
  Markup markup;
  markup.Open("div");
  EXPECT_DEATH(markup.str(), "div is still open");
  Markup other;
  EXPECT_DEATH(other.Close(), "");
}

TEST(MarkupTest, TablesKnowNumbers) {
  Table table({"name", "value"});
  EXPECT_TRUE(table.empty());
  table.AddRow({"<x>", "-1.5 m"});
  table.AddRow({"y", "none"});
  const std::string html = table.ToHtml("all & more");
  EXPECT_THAT(html, HasSubstr("<caption>all &amp; more</caption>"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\">&lt;x&gt;</th>"));
  EXPECT_THAT(html, HasSubstr("<td class=\"number\">-1.5 m</td>"));
  EXPECT_THAT(html, HasSubstr("<td>none</td>"));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
