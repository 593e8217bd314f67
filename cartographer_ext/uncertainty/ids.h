// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Ids of the vertices of a pose graph, for code that needs no host. They number
// nodes and submaps as Cartographer's mapping::NodeId and mapping::SubmapId do.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_IDS_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_IDS_H_

#include <tuple>

namespace cartographer_ext {
namespace uncertainty {

// Ordered by trajectory and index, as SubmapId.
struct NodeId {
  int trajectory_id = 0;
  int node_index = 0;
};

// A submap of a trajectory.
struct SubmapId {
  int trajectory_id = 0;
  int submap_index = 0;
};

inline bool operator==(const NodeId& a, const NodeId& b) {
  return a.trajectory_id == b.trajectory_id && a.node_index == b.node_index;
}
inline bool operator!=(const NodeId& a, const NodeId& b) { return !(a == b); }
inline bool operator<(const NodeId& a, const NodeId& b) {
  return std::tie(a.trajectory_id, a.node_index) <
         std::tie(b.trajectory_id, b.node_index);
}

inline bool operator==(const SubmapId& a, const SubmapId& b) {
  return a.trajectory_id == b.trajectory_id && a.submap_index == b.submap_index;
}
inline bool operator!=(const SubmapId& a, const SubmapId& b) {
  return !(a == b);
}
inline bool operator<(const SubmapId& a, const SubmapId& b) {
  return std::tie(a.trajectory_id, a.submap_index) <
         std::tie(b.trajectory_id, b.submap_index);
}

// A node or a submap. Ordered by kind (submaps first), trajectory and index.
class VertexId {
 public:
  // The first node of trajectory 0.
  VertexId() = default;
  VertexId(const NodeId& id)  // NOLINT(runtime/explicit)
      : is_node_(true),
        trajectory_id_(id.trajectory_id),
        index_(id.node_index) {}
  VertexId(const SubmapId& id)  // NOLINT(runtime/explicit)
      : is_node_(false),
        trajectory_id_(id.trajectory_id),
        index_(id.submap_index) {}

  bool is_node() const { return is_node_; }
  bool is_submap() const { return !is_node_; }
  int trajectory_id() const { return trajectory_id_; }
  // Index of the node or submap within its trajectory.
  int index() const { return index_; }

  bool IsNodeOf(const int trajectory_id) const {
    return is_node_ && trajectory_id_ == trajectory_id;
  }
  bool IsSubmapOf(const int trajectory_id) const {
    return !is_node_ && trajectory_id_ == trajectory_id;
  }
  // Whether both are nodes, or both submaps, of one trajectory: local SLAM has
  // the path from one to the other.
  bool InSequenceWith(const VertexId& other) const {
    return is_node_ == other.is_node_ && trajectory_id_ == other.trajectory_id_;
  }

  friend bool operator==(const VertexId& a, const VertexId& b) {
    return a.InSequenceWith(b) && a.index_ == b.index_;
  }
  friend bool operator!=(const VertexId& a, const VertexId& b) {
    return !(a == b);
  }
  friend bool operator<(const VertexId& a, const VertexId& b) {
    return std::tie(a.is_node_, a.trajectory_id_, a.index_) <
           std::tie(b.is_node_, b.trajectory_id_, b.index_);
  }

 private:
  bool is_node_ = true;
  int trajectory_id_ = 0;
  int index_ = 0;
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_IDS_H_
