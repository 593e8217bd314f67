// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/overview_page.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace collection {
namespace {

using testing::HasSubstr;
using testing::Not;

MapRecord Record(const std::string& filename, const std::string& verdict,
                 const double severe_share) {
  MapRecord record;
  record.filename = filename;
  record.verdict = verdict;
  record.severe_share = severe_share;
  record.reasons = {"because of <" + filename + ">"};
  return record;
}

TEST(OverviewPageTest, IsReadableWithoutScriptWorstFirst) {
  const std::string page = MakeOverview(
      {Record("good", "sound", 0.), Record("bad", "broken", 0.1),
       Record("worse", "broken", 0.5), Record("cut", "failed", 0.)},
      {}, "out/all.html");
  const size_t cut = page.find("because of &lt;cut&gt;");
  const size_t worse = page.find("because of &lt;worse&gt;");
  const size_t bad = page.find("because of &lt;bad&gt;");
  const size_t good = page.find("because of &lt;good&gt;");
  ASSERT_NE(good, std::string::npos);
  EXPECT_LT(cut, worse);
  EXPECT_LT(worse, bad);
  EXPECT_LT(bad, good);
  EXPECT_THAT(page, HasSubstr("1 failed, 2 broken, 1 sound"));
  // Nothing is fetched.
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, Not(HasSubstr("Since the baseline")));
}

TEST(OverviewPageTest, LinksAreRelativeToThePage) {
  MapRecord record = Record("a", "sound", 0.);
  record.report = "out/my maps/a#1.html";
  EXPECT_THAT(MakeOverview({record}, {}, "out/all.html"),
              HasSubstr("href=\"my%20maps/a%231.html\""));
}

TEST(OverviewPageTest, SaysWhatHasChanged) {
  const std::string page =
      MakeOverview({Record("a", "broken", 0.1)},
                   {{"a", "sound", "broken", "worse"}}, "all.html");
  EXPECT_THAT(page, HasSubstr("Since the baseline"));
  EXPECT_THAT(page, HasSubstr("worse, was sound"));
}

}  // namespace
}  // namespace collection
}  // namespace cartographer_ext
