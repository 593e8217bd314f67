// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The record of a candidate for the decision log: the results of each stage,
// the verdict and its reason. Poses in the record are those of the tracking
// frame.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_RECORD_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_RECORD_H_

#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_decision.pb.h"

namespace cartographer_ext {
namespace loop_closure {

// A stage that the candidate did not reach leaves its message unset.
proto::LoopDecision MakeDecisionRecord(const LoopCandidate& candidate,
                                       bool with_times);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_RECORD_H_
