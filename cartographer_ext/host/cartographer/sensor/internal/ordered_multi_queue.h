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

#include "absl/container/flat_hash_set.h"
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
  // Finishes those queues of a trajectory that are left, all at once.
  void FinishTrajectory(int trajectory_id);
  // Finishes all queues.
  void Flush();
  // The queue that dispatching last had to wait for; only after Add.
  QueueKey GetBlocker() const;

 private:
  struct Queue {
    // There must be a reading.
    common::Time FrontTime() const { return readings.front()->GetTime(); }

    std::deque<std::unique_ptr<Data>> readings;
    Callback callback;
    bool finished = false;
  };
  using Queues = std::map<QueueKey, Queue>;

  // The queues of a trajectory are neighbours; this is the first.
  Queues::iterator FirstOf(int trajectory_id);
  void DispatchAll();
  // Drops finished queues without readings. Then the queue with the oldest
  // reading, or the end while another queue has to be waited for.
  Queues::iterator OldestReading();
  // Dispatches or drops the first reading of a queue, unless that must wait.
  bool Process(Queues::iterator entry);
  // When all sensors of a trajectory have begun.
  common::Time StartTime(int trajectory_id);

  Queues queues_;
  std::map<int, common::Time> start_times_;
  common::Time last_dispatched_time_ = common::Time::min();
  QueueKey blocker_;
};

// One queue for each sensor of a trajectory, with a common callback.
void AddQueues(int trajectory_id,
               const absl::flat_hash_set<std::string>& sensor_ids,
               const std::function<void(const std::string& sensor_id,
                                        std::unique_ptr<Data>)>& callback,
               OrderedMultiQueue* queue);

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_INTERNAL_ORDERED_MULTI_QUEUE_H_
