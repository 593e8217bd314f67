// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_records.h"

#include "absl/status/statusor.h"
#include "cartographer_ext/loop_closure/decision_log.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr size_t kChunkBytes = 1 << 20;

}  // namespace

void DecisionRecords::Add(const proto::LoopDecision& decision) {
  if (chunks_.empty() || chunks_.back().size() >= kChunkBytes) {
    chunks_.emplace_back();
    chunks_.back().reserve(kChunkBytes + kChunkBytes / 64);
  }
  AppendDecision(decision, &chunks_.back());
  ++size_;
}

void DecisionRecords::ForEach(
    const std::function<void(const proto::LoopDecision&)>& visit) const {
  for (const std::string& chunk : chunks_) {
    const auto decisions = ParseDecisions(chunk);
    CHECK(decisions.ok()) << decisions.status();  // written above
    for (const proto::LoopDecision& decision : *decisions) visit(decision);
  }
}

std::vector<proto::LoopDecision> DecisionRecords::Parsed() const {
  std::vector<proto::LoopDecision> decisions;
  decisions.reserve(size_);
  ForEach([&decisions](const proto::LoopDecision& decision) {
    decisions.push_back(decision);
  });
  return decisions;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
