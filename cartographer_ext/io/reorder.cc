// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/reorder.h"

#include <algorithm>
#include <functional>
#include <queue>

namespace cartographer_ext {
namespace io {
namespace {

struct Waiting {
  EventKey key;
  size_t place;  // among the events kept, in the order of the file
  bool operator>(const Waiting& other) const { return other.key < key; }
};

}  // namespace

ReorderPlan PlanReordering(const std::vector<EventKey>& keys,
                           size_t max_window) {
  ReorderPlan plan;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<Waiting>>
      waiting;
  size_t num_kept = 0;
  size_t num_emitted = 0;
  EventKey last;
  // An event at place p that is emitted as number r needs p - r others to wait.
  const auto emit = [&] {
    const Waiting first = waiting.top();
    waiting.pop();
    last = first.key;
    if (first.place > num_emitted) {
      plan.window = std::max(plan.window, first.place - num_emitted);
    }
    ++num_emitted;
  };
  for (const EventKey& key : keys) {
    if (num_emitted > 0 && key < last) {
      plan.dropped.push_back(key.ordinal);
      continue;
    }
    waiting.push(Waiting{key, num_kept++});
    if (waiting.size() > max_window) emit();
  }
  while (!waiting.empty()) emit();
  return plan;
}

}  // namespace io
}  // namespace cartographer_ext
