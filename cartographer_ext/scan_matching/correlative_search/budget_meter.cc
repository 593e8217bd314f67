// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/budget_meter.h"

#include <chrono>

namespace cartographer_ext {
namespace scan_matching {
namespace {

double Seconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

BudgetMeter::BudgetMeter(const SearchBudget& budget) : budget_(budget) {
  if (budget_.max_seconds > 0.) start_seconds_ = Seconds();
}

bool BudgetMeter::Spend(const int64_t candidates) {
  spent_ += candidates;
  if (budget_.max_candidates > 0 && spent_ > budget_.max_candidates) {
    used_up_ = true;
  }
  if (budget_.max_seconds > 0. && --calls_until_clock_ <= 0) {
    calls_until_clock_ = 32;
    if (Seconds() - start_seconds_ > budget_.max_seconds) used_up_ = true;
  }
  return !used_up_;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
