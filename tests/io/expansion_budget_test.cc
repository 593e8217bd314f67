// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/expansion_budget.h"

#include <cstdint>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

TEST(ExpansionBudgetTest, SixtyFourMegabytesAndFiftyTimesTheFile) {
  ExpansionBudget budget(1000);
  EXPECT_TRUE(budget.Take(64 << 20));
  EXPECT_TRUE(budget.Take(50 * 1000));
  EXPECT_FALSE(budget.Take(1));
  EXPECT_EQ(budget.Error("x").code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(budget.Error("x").message()),
              testing::HasSubstr("50 times its size; -max_expansion"));
}

TEST(ExpansionBudgetTest, TheFactorCanBeRaised) {
  SetMaxExpansion(100);
  ExpansionBudget budget(1000);
  SetMaxExpansion(50);
  EXPECT_TRUE(budget.Take((64 << 20) + 100 * 1000));
  EXPECT_FALSE(budget.Take(1));
}

TEST(ExpansionBudgetTest, NothingOverflows) {
  SetMaxExpansion(1 << 30);
  ExpansionBudget budget(INT64_MAX);
  SetMaxExpansion(50);
  EXPECT_TRUE(budget.Take(uint64_t{1} << 61));
  EXPECT_FALSE(budget.Take(UINT64_MAX));
  EXPECT_FALSE(budget.Take(1));  // it stays used up
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
