// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The identity of a loop closure constraint in its pose graph: the submap that
// was matched and the node whose scan was matched against it.
#ifndef CARTOGRAPHER_EXT_COMMON_LOOP_ID_H_
#define CARTOGRAPHER_EXT_COMMON_LOOP_ID_H_

#include <tuple>

namespace cartographer_ext {

// Submap and node of a loop by their host ids. Ordered by these ids.
struct LoopId {
  int submap_trajectory = 0;
  int submap_index = 0;
  int node_trajectory = 0;
  int node_index = 0;
};

// The ids as a tuple, for comparison.
inline std::tuple<int, int, int, int> AsTuple(const LoopId& id) {
  return std::make_tuple(id.submap_trajectory, id.submap_index,
                         id.node_trajectory, id.node_index);
}
inline bool operator==(const LoopId& a, const LoopId& b) {
  return AsTuple(a) == AsTuple(b);
}
inline bool operator!=(const LoopId& a, const LoopId& b) { return !(a == b); }
inline bool operator<(const LoopId& a, const LoopId& b) {
  return AsTuple(a) < AsTuple(b);
}

// Converts Cartographer's mapping::SubmapId and mapping::NodeId.
template <typename SubmapId, typename NodeId>
LoopId MakeLoopId(const SubmapId& submap, const NodeId& node) {
  LoopId id;
  id.submap_trajectory = submap.trajectory_id;
  id.submap_index = submap.submap_index;
  id.node_trajectory = node.trajectory_id;
  id.node_index = node.node_index;
  return id;
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_LOOP_ID_H_
