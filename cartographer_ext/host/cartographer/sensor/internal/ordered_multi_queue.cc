// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/internal/ordered_multi_queue.h"

#include <algorithm>
#include <utility>

#include "glog/logging.h"

namespace cartographer {
namespace sensor {

namespace {

// This many waiting readings indicate a sensor that has stopped.
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
  Queue queue;
  queue.callback = std::move(callback);
  CHECK(queues_.emplace(queue_key, std::move(queue)).second)
      << "queue " << queue_key << " exists";
}

void OrderedMultiQueue::MarkQueueAsFinished(const QueueKey& queue_key) {
  const auto entry = queues_.find(queue_key);
  CHECK(entry != queues_.end() && !entry->second.finished)
      << "there is no queue " << queue_key << " to finish";
  entry->second.finished = true;
  DispatchAll();
}

void OrderedMultiQueue::Add(const QueueKey& queue_key,
                            std::unique_ptr<Data> data) {
  const auto entry = queues_.find(queue_key);
  if (entry != queues_.end()) {
    entry->second.readings.push_back(std::move(data));
    DispatchAll();
    return;
  }
  LOG_EVERY_N(WARNING, 1000)
      << "dropped a reading of the unknown queue " << queue_key;
}

void OrderedMultiQueue::FinishTrajectory(const int trajectory_id) {
  for (auto it = FirstOf(trajectory_id);
       it != queues_.end() && it->first.trajectory_id == trajectory_id; ++it) {
    it->second.finished = true;
  }
  DispatchAll();
}

void OrderedMultiQueue::Flush() {
  for (auto& entry : queues_) {
    entry.second.finished = true;
  }
  DispatchAll();
}

QueueKey OrderedMultiQueue::GetBlocker() const {
  CHECK(!queues_.empty());
  return blocker_;
}

OrderedMultiQueue::Queues::iterator OrderedMultiQueue::FirstOf(
    const int trajectory_id) {
  return queues_.lower_bound(QueueKey{trajectory_id, std::string()});
}

void OrderedMultiQueue::DispatchAll() {
  bool progress = true;
  while (progress) {
    const auto oldest = OldestReading();
    progress = oldest != queues_.end() && Process(oldest);
  }
}

OrderedMultiQueue::Queues::iterator OrderedMultiQueue::OldestReading() {
  size_t longest = 0;
  auto silent = queues_.end();
  for (auto it = queues_.begin(); it != queues_.end();) {
    const Queue& queue = it->second;
    longest = std::max(longest, queue.readings.size());
    const bool empty = queue.readings.empty();
    if (empty && !queue.finished && silent == queues_.end()) {
      silent = it;
    }
    it = empty && queue.finished ? queues_.erase(it) : std::next(it);
  }
  if (silent != queues_.end()) {
    blocker_ = silent->first;
    LOG_IF_EVERY_N(WARNING, longest > kSuspiciousQueueSize, 1000)
        << "all sensors wait for " << blocker_;
    return queues_.end();
  }
  // The first of equal times, which has the smallest key.
  return std::min_element(
      queues_.begin(), queues_.end(),
      [](const Queues::value_type& a, const Queues::value_type& b) {
        return a.second.FrontTime() < b.second.FrontTime();
      });
}

bool OrderedMultiQueue::Process(const Queues::iterator entry) {
  Queue& queue = entry->second;
  const common::Time start = StartTime(entry->first.trajectory_id);
  const bool before_start = queue.FrontTime() < start;
  const bool has_successor = queue.readings.size() > 1;
  if (before_start && !has_successor && !queue.finished) {
    // The next reading decides whether this is the last one before the start.
    blocker_ = entry->first;
    return false;
  }
  std::unique_ptr<Data> reading = std::move(queue.readings.front());
  queue.readings.pop_front();
  const bool superseded =
      before_start && has_successor && queue.FrontTime() <= start;
  if (!superseded) {
    CHECK_LE(last_dispatched_time_, reading->GetTime())
        << "the readings of sensor '" << reading->GetSensorId()
        << "' are not in order of time";
    last_dispatched_time_ = reading->GetTime();
    queue.callback(std::move(reading));
  }
  return true;
}

common::Time OrderedMultiQueue::StartTime(const int trajectory_id) {
  const auto known = start_times_.find(trajectory_id);
  if (known != start_times_.end()) {
    return known->second;
  }
  // Called while every queue has a reading. The sensor that begins last is the
  // one to start with.
  common::Time start = common::Time::min();
  for (auto it = FirstOf(trajectory_id);
       it != queues_.end() && it->first.trajectory_id == trajectory_id; ++it) {
    start = std::max(start, it->second.FrontTime());
  }
  VLOG(1) << "trajectory " << trajectory_id << " starts at " << start;
  return start_times_[trajectory_id] = start;
}

void AddQueues(const int trajectory_id,
               const absl::flat_hash_set<std::string>& sensor_ids,
               const std::function<void(const std::string& sensor_id,
                                        std::unique_ptr<Data>)>& callback,
               OrderedMultiQueue* const queue) {
  for (const std::string& sensor_id : sensor_ids) {
    queue->AddQueue(QueueKey{trajectory_id, sensor_id},
                    [sensor_id, callback](std::unique_ptr<Data> reading) {
                      callback(sensor_id, std::move(reading));
                    });
  }
}

}  // namespace sensor
}  // namespace cartographer
