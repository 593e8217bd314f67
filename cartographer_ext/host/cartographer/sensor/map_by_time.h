// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_MAP_BY_TIME_H_
#define CARTOGRAPHER_SENSOR_MAP_BY_TIME_H_

#include <cstddef>
#include <iterator>
#include <map>

#include "cartographer/common/port.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/id.h"
#include "glog/logging.h"

namespace cartographer {
namespace sensor {

// Readings with a `time` of several trajectories, in order of time.
template <typename DataType>
class MapByTime {
 private:
  using Readings = std::map<common::Time, DataType>;
  using Trajectories = std::map<int, Readings>;

  // Walks over the keys or the values of a map.
  template <typename Map, typename Value, bool kKeys>
  class Iterator {
   public:
    using iterator_category = std::bidirectional_iterator_tag;
    using value_type = Value;
    using difference_type = std::ptrdiff_t;
    using pointer = const Value*;
    using reference = const Value&;

    explicit Iterator(const typename Map::const_iterator iterator)
        : iterator_(iterator) {}

    reference operator*() const {
      return Select(*iterator_, std::integral_constant<bool, kKeys>());
    }
    pointer operator->() const { return &**this; }
    Iterator& operator++() {
      ++iterator_;
      return *this;
    }
    Iterator& operator--() {
      --iterator_;
      return *this;
    }
    bool operator==(const Iterator& other) const {
      return iterator_ == other.iterator_;
    }
    bool operator!=(const Iterator& other) const { return !(*this == other); }

   private:
    static reference Select(const typename Map::value_type& entry,
                            std::true_type) {
      return entry.first;
    }
    static reference Select(const typename Map::value_type& entry,
                            std::false_type) {
      return entry.second;
    }

    typename Map::const_iterator iterator_;
  };

 public:
  using ConstIterator = Iterator<Readings, DataType, false>;
  using ConstTrajectoryIterator = Iterator<Trajectories, int, true>;

  // `data.time` must be after that of the trajectory's last reading.
  void Append(const int trajectory_id, const DataType& data) {
    CHECK_GE(trajectory_id, 0);
    Readings& readings = data_[trajectory_id];
    CHECK(readings.empty() || readings.rbegin()->first < data.time)
        << "readings of trajectory " << trajectory_id << " are out of order";
    readings.emplace_hint(readings.end(), data.time, data);
  }

  // Drops the readings that only `node_id` needs: those between its neighbours,
  // except the first after (or at) the node before it and the last before (or
  // at) the node behind it, between which one can still interpolate. Call this
  // before the node leaves `nodes`.
  template <typename NodeType>
  void Trim(const mapping::MapById<mapping::NodeId, NodeType>& nodes,
            const mapping::NodeId& node_id) {
    const int trajectory_id = node_id.trajectory_id;
    CHECK_GE(trajectory_id, 0);
    const auto found = data_.find(trajectory_id);
    if (found == data_.end()) return;
    Readings& readings = found->second;

    const auto node = nodes.find(node_id);
    CHECK(node != nodes.end());
    auto first = readings.begin();
    if (node != nodes.BeginOfTrajectory(trajectory_id)) {
      first = readings.lower_bound(std::prev(node)->data.time);
      if (first != readings.end()) ++first;
    }
    auto last = readings.end();
    const auto next_node = std::next(node);
    if (next_node != nodes.EndOfTrajectory(trajectory_id)) {
      last = readings.upper_bound(next_node->data.time);
      if (last != readings.begin()) --last;
    }
    // The two may have crossed when there is at most one reading in between.
    if (first == readings.end() ||
        (last != readings.end() && !(first->first < last->first))) {
      return;
    }
    readings.erase(first, last);
    if (readings.empty()) data_.erase(found);
  }

  bool HasTrajectory(const int trajectory_id) const {
    return data_.find(trajectory_id) != data_.end();
  }

  // The trajectory must exist.
  ConstIterator BeginOfTrajectory(const int trajectory_id) const {
    return ConstIterator(data_.at(trajectory_id).begin());
  }
  ConstIterator EndOfTrajectory(const int trajectory_id) const {
    return ConstIterator(data_.at(trajectory_id).end());
  }

  mapping::Range<ConstTrajectoryIterator> trajectory_ids() const {
    return mapping::Range<ConstTrajectoryIterator>(
        ConstTrajectoryIterator(data_.begin()),
        ConstTrajectoryIterator(data_.end()));
  }
  mapping::Range<ConstIterator> trajectory(const int trajectory_id) const {
    return mapping::Range<ConstIterator>(BeginOfTrajectory(trajectory_id),
                                         EndOfTrajectory(trajectory_id));
  }

  // The first reading of the trajectory at or after `time`.
  ConstIterator lower_bound(const int trajectory_id,
                            const common::Time time) const {
    return ConstIterator(data_.at(trajectory_id).lower_bound(time));
  }

 private:
  Trajectories data_;
};

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_MAP_BY_TIME_H_
