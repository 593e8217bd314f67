// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/internal/ordered_multi_queue.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "glog/logging.h"

namespace cartographer {
namespace sensor {

namespace {

// So many waiting readings point to a sensor that is silent.
constexpr size_t kSuspiciousQueueSize = 500;

std::ostream& operator<<(std::ostream& os, const QueueKey& key) {
  return os << '(' << key.trajectory_id << ", " << key.sensor_id << ')';
}

}  // namespace

OrderedMultiQueue::OrderedMultiQueue() {}

OrderedMultiQueue::~OrderedMultiQueue() {
  for (const auto& entry : queues_) {
    CHECK(entry.second.finished) << "queue " << entry.first << " is unfinished";
  }
}

void OrderedMultiQueue::AddQueue(const QueueKey& queue_key, Callback callback) {
  CHECK_EQ(queues_.count(queue_key), 0) << "queue " << queue_key << " exists";
  queues_[queue_key].callback = std::move(callback);
}

void OrderedMultiQueue::MarkQueueAsFinished(const QueueKey& queue_key) {
  const auto found = queues_.find(queue_key);
  CHECK(found != queues_.end()) << "no queue " << queue_key;
  CHECK(!found->second.finished) << "queue " << queue_key << " is finished";
  found->second.finished = true;
  Dispatch();
}

void OrderedMultiQueue::Add(const QueueKey& queue_key,
                            std::unique_ptr<Data> data) {
  const auto found = queues_.find(queue_key);
  if (found == queues_.end()) {
    LOG_EVERY_N(WARNING, 1000)
        << "dropped a reading of the unknown queue " << queue_key;
    return;
  }
  found->second.readings.push_back(std::move(data));
  Dispatch();
}

void OrderedMultiQueue::Flush() {
  std::vector<QueueKey> unfinished;
  for (const auto& entry : queues_) {
    if (!entry.second.finished) unfinished.push_back(entry.first);
  }
  for (const QueueKey& key : unfinished) MarkQueueAsFinished(key);
}

QueueKey OrderedMultiQueue::GetBlocker() const {
  CHECK(!queues_.empty());
  return blocker_;
}

void OrderedMultiQueue::Dispatch() {
  for (;;) {
    // The queue with the oldest reading; all must have one or be finished.
    auto oldest = queues_.end();
    for (auto it = queues_.begin(); it != queues_.end();) {
      Queue& queue = it->second;
      if (queue.readings.empty()) {
        if (queue.finished) {
          it = queues_.erase(it);
          continue;
        }
        blocker_ = it->first;
        LOG_IF_EVERY_N(
            WARNING,
            oldest != queues_.end() &&
                oldest->second.readings.size() > kSuspiciousQueueSize,
            1000)
            << "queue " << blocker_ << " holds up the others";
        return;
      }
      if (oldest == queues_.end() ||
          queue.readings.front()->GetTime() <
              oldest->second.readings.front()->GetTime()) {
        oldest = it;
      }
      ++it;
    }
    if (oldest == queues_.end()) return;

    Queue& queue = oldest->second;
    const common::Time start = CommonStartTime(oldest->first.trajectory_id);
    if (queue.readings.front()->GetTime() >= start) {
      DispatchFront(&queue);
    } else if (queue.readings.size() >= 2) {
      // Pass on only the last reading before the start.
      if (queue.readings[1]->GetTime() > start) {
        DispatchFront(&queue);
      } else {
        queue.readings.pop_front();
      }
    } else if (queue.finished) {
      DispatchFront(&queue);
    } else {
      blocker_ = oldest->first;
      return;
    }
  }
}

void OrderedMultiQueue::DispatchFront(Queue* const queue) {
  std::unique_ptr<Data> data = std::move(queue->readings.front());
  queue->readings.pop_front();
  CHECK_LE(last_dispatched_time_, data->GetTime())
      << "Non-sorted data added to queue of sensor '" << data->GetSensorId()
      << "'";
  last_dispatched_time_ = data->GetTime();
  queue->callback(std::move(data));
}

common::Time OrderedMultiQueue::CommonStartTime(const int trajectory_id) {
  const auto inserted =
      common_start_times_.emplace(trajectory_id, common::Time::min());
  common::Time& start = inserted.first->second;
  if (inserted.second) {
    // Called when every queue has a reading, so this is the latest beginning.
    for (const auto& entry : queues_) {
      if (entry.first.trajectory_id != trajectory_id) continue;
      start = std::max(start, entry.second.readings.front()->GetTime());
    }
    VLOG(1) << "All sensors of trajectory " << trajectory_id
            << " have begun at " << start << ".";
  }
  return start;
}

}  // namespace sensor
}  // namespace cartographer
