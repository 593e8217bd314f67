// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Names of nodes and submaps, and a container addressed by them.
//
// MapById keeps one sorted map over (trajectory, index), so that iteration
// visits trajectories in ascending order and, within one, indices in ascending
// order. Beside it a small table counts the entries of every trajectory and
// remembers whether Append may still continue the numbering: once an index was
// chosen by the caller (Insert) or the newest entry was removed (Trim), the
// next free index is no longer known to be safe.
#ifndef CARTOGRAPHER_MAPPING_ID_H_
#define CARTOGRAPHER_MAPPING_ID_H_

#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <ostream>
#include <tuple>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/port.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/proto/pose_graph.pb.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

// The `node_index`-th node of trajectory `trajectory_id`.
struct NodeId {
  NodeId(int trajectory_id, int node_index)
      : trajectory_id(trajectory_id), node_index(node_index) {}

  bool operator==(const NodeId& other) const { return Key() == other.Key(); }
  bool operator!=(const NodeId& other) const { return Key() != other.Key(); }
  bool operator<(const NodeId& other) const { return Key() < other.Key(); }

  void ToProto(proto::NodeId* proto) const {
    proto->set_trajectory_id(trajectory_id);
    proto->set_node_index(node_index);
  }

  int trajectory_id;
  int node_index;

 private:
  std::tuple<int, int> Key() const {
    return std::make_tuple(trajectory_id, node_index);
  }
};

// The `submap_index`-th submap of trajectory `trajectory_id`.
struct SubmapId {
  SubmapId(int trajectory_id, int submap_index)
      : trajectory_id(trajectory_id), submap_index(submap_index) {}

  bool operator==(const SubmapId& other) const { return Key() == other.Key(); }
  bool operator!=(const SubmapId& other) const { return Key() != other.Key(); }
  bool operator<(const SubmapId& other) const { return Key() < other.Key(); }

  void ToProto(proto::SubmapId* proto) const {
    proto->set_trajectory_id(trajectory_id);
    proto->set_submap_index(submap_index);
  }

  int trajectory_id;
  int submap_index;

 private:
  std::tuple<int, int> Key() const {
    return std::make_tuple(trajectory_id, submap_index);
  }
};

inline std::ostream& operator<<(std::ostream& os, const NodeId& id) {
  return os << "(" << id.trajectory_id << ", " << id.node_index << ")";
}

inline std::ostream& operator<<(std::ostream& os, const SubmapId& id) {
  return os << "(" << id.trajectory_id << ", " << id.submap_index << ")";
}

namespace internal {

inline int IndexOf(const NodeId& id) { return id.node_index; }
inline int IndexOf(const SubmapId& id) { return id.submap_index; }

// The time of an entry: its time() where it has one, else its member `time`.
template <typename T>
auto TimeOf(const T& entry, int) -> decltype(entry.time()) {
  return entry.time();
}
template <typename T>
auto TimeOf(const T& entry, long) -> decltype(entry.time) {
  return entry.time;
}
template <typename T>
common::Time GetTime(const T& entry) {
  return TimeOf(entry, 0);
}

}  // namespace internal

// A pair of iterators for range-based loops.
template <typename IteratorType>
class Range {
 public:
  Range(const IteratorType& begin, const IteratorType& end)
      : begin_(begin), end_(end) {}

  IteratorType begin() const { return begin_; }
  IteratorType end() const { return end_; }

 private:
  IteratorType begin_;
  IteratorType end_;
};

// Trajectories without entries do not exist in it: trimming the last entry
// forgets the trajectory.
template <typename IdType, typename DataType>
class MapById {
 private:
  using Storage = std::map<IdType, DataType>;
  struct TrajectoryInfo {
    size_t size = 0;
    bool can_append = true;
  };
  using TrajectoryTable = std::map<int, TrajectoryInfo>;

 public:
  struct IdDataReference {
    IdType id;
    const DataType& data;
  };

  class ConstIterator {
   public:
    using iterator_category = std::bidirectional_iterator_tag;
    using value_type = IdDataReference;
    using difference_type = int64;
    using pointer = std::unique_ptr<const IdDataReference>;
    using reference = const IdDataReference&;

    explicit ConstIterator(typename Storage::const_iterator position)
        : position_(position) {}

    IdDataReference operator*() const {
      return IdDataReference{position_->first, position_->second};
    }
    std::unique_ptr<const IdDataReference> operator->() const {
      return absl::make_unique<const IdDataReference>(**this);
    }
    ConstIterator& operator++() {
      ++position_;
      return *this;
    }
    ConstIterator& operator--() {
      --position_;
      return *this;
    }
    bool operator==(const ConstIterator& other) const {
      return position_ == other.position_;
    }
    bool operator!=(const ConstIterator& other) const {
      return position_ != other.position_;
    }

   private:
    typename Storage::const_iterator position_;
  };

  class ConstTrajectoryIterator {
   public:
    using iterator_category = std::bidirectional_iterator_tag;
    using value_type = int;
    using difference_type = int64;
    using pointer = const int*;
    using reference = const int&;

    explicit ConstTrajectoryIterator(
        typename TrajectoryTable::const_iterator position)
        : position_(position) {}

    int operator*() const { return position_->first; }
    ConstTrajectoryIterator& operator++() {
      ++position_;
      return *this;
    }
    ConstTrajectoryIterator& operator--() {
      --position_;
      return *this;
    }
    bool operator==(const ConstTrajectoryIterator& other) const {
      return position_ == other.position_;
    }
    bool operator!=(const ConstTrajectoryIterator& other) const {
      return position_ != other.position_;
    }

   private:
    typename TrajectoryTable::const_iterator position_;
  };

  // Adds `data` behind the newest entry of the trajectory, which is created if
  // need be, and returns the new name.
  IdType Append(const int trajectory_id, const DataType& data) {
    CHECK_GE(trajectory_id, 0);
    TrajectoryInfo& info = trajectories_[trajectory_id];
    CHECK(info.can_append) << "trajectory " << trajectory_id
                           << " no longer continues its own numbering";
    int index = 0;
    if (info.size > 0) {
      index = internal::IndexOf(std::prev(After(trajectory_id))->first) + 1;
    }
    const IdType id{trajectory_id, index};
    entries_.emplace(id, data);
    ++info.size;
    return id;
  }

  // Adds `data` under a name of the caller's choice, which must be free.
  void Insert(const IdType& id, const DataType& data) {
    CHECK_GE(id.trajectory_id, 0);
    CHECK_GE(internal::IndexOf(id), 0);
    CHECK(entries_.emplace(id, data).second) << id << " exists already";
    TrajectoryInfo& info = trajectories_[id.trajectory_id];
    ++info.size;
    info.can_append = false;
  }

  // Removes an entry, which must exist.
  void Trim(const IdType& id) {
    const auto entry = entries_.find(id);
    CHECK(entry != entries_.end()) << id << " does not exist";
    const auto info = trajectories_.find(id.trajectory_id);
    const auto next = entries_.erase(entry);
    if (--info->second.size == 0) {
      trajectories_.erase(info);
    } else if (next == entries_.end() ||
               next->first.trajectory_id != id.trajectory_id) {
      info->second.can_append = false;
    }
  }

  bool Contains(const IdType& id) const { return entries_.count(id) != 0; }
  const DataType& at(const IdType& id) const { return entries_.at(id); }
  DataType& at(const IdType& id) { return entries_.at(id); }

  // The entry called `id`, or end().
  ConstIterator find(const IdType& id) const {
    return ConstIterator(entries_.find(id));
  }

  ConstIterator BeginOfTrajectory(const int trajectory_id) const {
    return ConstIterator(entries_.lower_bound(
        IdType{trajectory_id, std::numeric_limits<int>::min()}));
  }
  ConstIterator EndOfTrajectory(const int trajectory_id) const {
    return ConstIterator(After(trajectory_id));
  }

  size_t SizeOfTrajectoryOrZero(const int trajectory_id) const {
    const auto info = trajectories_.find(trajectory_id);
    return info == trajectories_.end() ? 0 : info->second.size;
  }
  size_t size() const { return entries_.size(); }
  bool empty() const { return entries_.empty(); }

  ConstIterator begin() const { return ConstIterator(entries_.begin()); }
  ConstIterator end() const { return ConstIterator(entries_.end()); }

  // The entries of one trajectory.
  Range<ConstIterator> trajectory(const int trajectory_id) const {
    return Range<ConstIterator>(BeginOfTrajectory(trajectory_id),
                                EndOfTrajectory(trajectory_id));
  }
  // The names of the trajectories.
  Range<ConstTrajectoryIterator> trajectory_ids() const {
    return Range<ConstTrajectoryIterator>(
        ConstTrajectoryIterator(trajectories_.begin()),
        ConstTrajectoryIterator(trajectories_.end()));
  }

  // The first entry of a trajectory that is not earlier than `time`, or the end
  // of the trajectory. Times must not decrease with the index. O(log^2 n).
  ConstIterator lower_bound(const int trajectory_id,
                            const common::Time time) const {
    if (SizeOfTrajectoryOrZero(trajectory_id) == 0) {
      return EndOfTrajectory(trajectory_id);
    }
    const auto last = std::prev(After(trajectory_id));
    if (internal::GetTime(last->second) < time) {
      return EndOfTrajectory(trajectory_id);
    }
    // Bisects for the smallest index at or behind which the next entry is not
    // earlier than `time`; gaps in the numbering do no harm.
    int64 low = internal::IndexOf((*BeginOfTrajectory(trajectory_id)).id);
    int64 high = internal::IndexOf(last->first);
    while (low < high) {
      const int64 middle = low + (high - low) / 2;
      if (internal::GetTime(AtOrBehind(trajectory_id, middle)->second) < time) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return ConstIterator(AtOrBehind(trajectory_id, low));
  }

 private:
  typename Storage::const_iterator AtOrBehind(const int trajectory_id,
                                              const int64 index) const {
    return entries_.lower_bound(IdType{trajectory_id, static_cast<int>(index)});
  }
  typename Storage::const_iterator After(const int trajectory_id) const {
    return entries_.upper_bound(
        IdType{trajectory_id, std::numeric_limits<int>::max()});
  }

  Storage entries_;
  TrajectoryTable trajectories_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_ID_H_
