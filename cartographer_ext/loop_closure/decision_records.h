// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Records of loop decisions, one after the other. They are kept serialized,
// which takes a fifth of the memory: a run has tens of thousands.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_RECORDS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_RECORDS_H_

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "cartographer_ext/loop_decision.pb.h"

namespace cartographer_ext {
namespace loop_closure {

class DecisionRecords {
 public:
  bool empty() const { return size_ == 0; }
  size_t size() const { return size_; }

  void Add(const proto::LoopDecision& decision);
  // Calls `visit` for each, in the order in which they were added.
  void ForEach(
      const std::function<void(const proto::LoopDecision&)>& visit) const;
  std::vector<proto::LoopDecision> Parsed() const;

 private:
  // As in files (decision_log.h), all but the last about kChunkBytes long.
  std::vector<std::string> chunks_;
  size_t size_ = 0;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_RECORDS_H_
