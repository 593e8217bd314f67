// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_counts.h"

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace loop_closure {

using proto::LoopDecision;

void DecisionCounts::Add(const LoopDecision& decision) {
  if (decision.verdict() == LoopDecision::ACCEPTED) {
    ++accepted;
  } else if (decision.verdict() == LoopDecision::UNDECIDED) {
    ++undecided;
  } else if (decision.reason() >= LoopDecision::SKIPPED_REDUNDANT) {
    ++skipped;
  } else if (decision.reason() == LoopDecision::LOW_GRID_SCORE) {
    ++not_found;
  } else {
    ++rejected;
  }
}

std::string ToText(const DecisionCounts& counts) {
  return absl::StrCat(counts.accepted, " loops accepted, ", counts.rejected,
                      " rejected, ", counts.undecided, " undecided, ",
                      counts.not_found, " searched without a match, ",
                      counts.skipped, " skipped");
}

}  // namespace loop_closure
}  // namespace cartographer_ext
