// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_INTERNAL_ORDERED_MULTI_QUEUE_H_
#define CARTOGRAPHER_SENSOR_INTERNAL_ORDERED_MULTI_QUEUE_H_

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "cartographer/common/time.h"
#include "cartographer/sensor/data.h"

namespace cartographer {
namespace sensor {

struct QueueKey {
  int trajectory_id;
  std::string sensor_id;

  bool operator<(const QueueKey& other) const {
    return std::tie(trajectory_id, sensor_id) <
           std::tie(other.trajectory_id, other.sensor_id);
  }
};

// Merges queues that are each in order of time. The oldest reading is
// dispatched as soon as every unfinished queue has one. Of equal times the
// queue with the smaller key comes first. A trajectory begins when all of its
// sensors have begun: of the readings before that, each queue passes on its
// last one only.
class OrderedMultiQueue {
 public:
  using Callback = std::function<void(std::unique_ptr<Data>)>;

  OrderedMultiQueue();
  OrderedMultiQueue(OrderedMultiQueue&& queue) = default;
  // All queues must be finished.
  ~OrderedMultiQueue();

  // The key must be new.
  void AddQueue(const QueueKey& queue_key, Callback callback);
  // The queue must be there and unfinished.
  void MarkQueueAsFinished(const QueueKey& queue_key);
  // Readings of an unknown queue are dropped with a warning. Times of a queue
  // must not go back.
  void Add(const QueueKey& queue_key, std::unique_ptr<Data> data);
  // Finishes all queues.
  void Flush();
  // The queue that was empty when we could last not go on; not before Add.
  QueueKey GetBlocker() const;

 private:
  struct Queue {
    std::deque<std::unique_ptr<Data>> readings;
    Callback callback;
    bool finished = false;
  };

  void Dispatch();
  void DispatchFront(Queue* queue);
  common::Time CommonStartTime(int trajectory_id);

  common::Time last_dispatched_time_ = common::Time::min();
  std::map<int, common::Time> common_start_times_;
  std::map<QueueKey, Queue> queues_;
  QueueKey blocker_;
};

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_INTERNAL_ORDERED_MULTI_QUEUE_H_
