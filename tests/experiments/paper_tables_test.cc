// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/paper_tables.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace experiments {
namespace {

const PrintedRow* Find(const std::vector<PrintedRow>& rows,
                       const std::string& dataset, const std::string& type,
                       const int count) {
  const auto it =
      std::find_if(rows.begin(), rows.end(), [&](const PrintedRow& row) {
        return row.dataset == dataset && row.type == type && row.count == count;
      });
  return it == rows.end() ? nullptr : &*it;
}

TEST(PaperTablesTest, EveryCellOnce) {
  for (const auto& rows : {AcsTable2(), RIsamTable2()}) {
    std::set<std::tuple<std::string, std::string, int>> cells;
    for (const PrintedRow& row : rows) {
      EXPECT_TRUE(cells.emplace(row.dataset, row.type, row.count).second);
      EXPECT_GT(row.method, 0.);
    }
  }
  EXPECT_EQ(AcsTable2().size(), 64u);
  EXPECT_EQ(RIsamTable2().size(), 48u);
}

TEST(PaperTablesTest, CellsAreWhereThePapersHaveThem) {
  const std::vector<PrintedRow> acs = AcsTable2();
  const PrintedRow* row = Find(acs, "city10000", "L", 2000);
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->baseline, 33.8);
  EXPECT_EQ(row->method, 9.2);
  row = Find(acs, "manhattan_g2o", "LG", 4000);
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->baseline, 6.7);
  EXPECT_EQ(row->method, 4.1);
  // SC gave no valid map of Bicocca.
  row = Find(acs, "bicocca25b_0.800", "R", 1000);
  ASSERT_NE(row, nullptr);
  EXPECT_LT(row->baseline, 0.);
  const std::vector<PrintedRow> r_isam = RIsamTable2();
  row = Find(r_isam, "intel", "RG", 1500);
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->baseline, 1.13);
  EXPECT_EQ(row->method, 16.);
}

}  // namespace
}  // namespace experiments
}  // namespace cartographer_ext
