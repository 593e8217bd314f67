// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/budget_meter.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

TEST(BudgetMeterTest, CountsCandidates) {
  SearchBudget budget;
  budget.max_candidates = 100;
  BudgetMeter meter(budget);
  EXPECT_TRUE(meter.Spend(60));
  EXPECT_TRUE(meter.Spend(40));
  EXPECT_FALSE(meter.used_up());
  EXPECT_FALSE(meter.Spend(1));
  EXPECT_TRUE(meter.used_up());
}

TEST(BudgetMeterTest, ZeroIsWithoutLimit) {
  BudgetMeter meter{SearchBudget()};
  EXPECT_TRUE(meter.Spend(int64_t{1} << 40));
  EXPECT_FALSE(meter.used_up());
}

TEST(BudgetMeterTest, LooksAtTheClock) {
  SearchBudget budget;
  budget.max_seconds = 1e-9;
  BudgetMeter meter(budget);
  EXPECT_FALSE(meter.Spend(1));
  budget.max_seconds = 1e6;
  BudgetMeter patient(budget);
  for (int i = 0; i != 100; ++i) EXPECT_TRUE(patient.Spend(1));
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
