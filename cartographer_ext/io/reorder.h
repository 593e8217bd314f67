// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Sorting of recordings whose stamps go backwards, in bounded memory. A first
// pass over the file gives the keys of all events to PlanReordering, which
// finds the smallest window that sorts them; the second pass streams the events
// through a ReorderBuffer of that window. Files already in order need no window
// at all.
#ifndef CARTOGRAPHER_EXT_IO_REORDER_H_
#define CARTOGRAPHER_EXT_IO_REORDER_H_

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

struct EventKey {
  TimeNs time = 0;
  int rank = 0;         // of events with equal stamps: small before large
  int64_t ordinal = 0;  // place in the file; keeps the sort stable

  bool operator<(const EventKey& other) const {
    if (time != other.time) return time < other.time;
    if (rank != other.rank) return rank < other.rank;
    return ordinal < other.ordinal;
  }
};

struct ReorderPlan {
  // Largest number of events that have to be buffered.
  size_t window = 0;
  // Ordinals of events that are too late even for a window of `max_window`
  // events and have to be dropped. Ascending.
  std::vector<int64_t> dropped;
};

// `keys` in the order of the file, with ascending ordinals.
ReorderPlan PlanReordering(const std::vector<EventKey>& keys,
                           size_t max_window);

template <typename Event>
class ReorderBuffer {
 public:
  explicit ReorderBuffer(size_t window = 0) : window_(window) {}

  void Push(const EventKey& key, Event event) {
    events_.emplace(key, std::move(event));
  }
  // Whether the first event can be taken without reading more of the file.
  bool Ready() const { return events_.size() > window_; }
  bool empty() const { return events_.empty(); }
  EventKey first_key() const { return events_.begin()->first; }
  Event Pop() {
    Event event = std::move(events_.begin()->second);
    events_.erase(events_.begin());
    return event;
  }

 private:
  size_t window_;
  std::map<EventKey, Event> events_;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_REORDER_H_
