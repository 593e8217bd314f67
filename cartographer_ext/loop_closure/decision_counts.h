// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_COUNTS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_COUNTS_H_

#include <cstdint>
#include <string>

#include "cartographer_ext/loop_decision.pb.h"

namespace cartographer_ext {
namespace loop_closure {

// Outcomes of loop candidates.
struct DecisionCounts {
  int64_t accepted = 0;
  int64_t rejected = 0;   // matched, but rejected
  int64_t not_found = 0;  // searched without a match
  int64_t undecided = 0;
  int64_t skipped = 0;  // not searched

  void Add(const proto::LoopDecision& decision);
};

// "703 loops accepted, 6 rejected, 12 undecided, 410 searched without a match,
// 12034 skipped".
std::string ToText(const DecisionCounts& counts);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_COUNTS_H_
