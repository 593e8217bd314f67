// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_BUDGET_METER_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_BUDGET_METER_H_

#include <cstdint>

#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"

namespace cartographer_ext {
namespace scan_matching {

// The remaining budget of a search.
class BudgetMeter {
 public:
  explicit BudgetMeter(const SearchBudget& budget);
  // Returns false if the budget is used up.
  bool Spend(int64_t candidates);
  bool used_up() const { return used_up_; }

 private:
  const SearchBudget budget_;
  int64_t spent_ = 0;
  int calls_until_clock_ = 0;
  double start_seconds_ = 0.;
  bool used_up_ = false;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_BUDGET_METER_H_
