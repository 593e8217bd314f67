// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How well it is known where a node lies from another, along the trajectory and
// over any number of accepted loops.
//
// The ways are those of a graph: its vertices are the ends of loops, its edges
// the loops and the stretches of trajectory from end to end. The shortest way
// is the one of least effort (path_uncertainty.h), which adds up and therefore
// suits Dijkstra's algorithm; the covariance is then composed along it. A way
// over a single chain of loops errs on the side of a larger uncertainty, all of
// them together know more.
//
// One search of the graph serves all nodes asked from one place, until the next
// loop. Loops close to another one on both sides add no way and are left out.
// Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_WAYS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_WAYS_H_

#include <cstddef>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/loop_closure/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

class LoopWays {
 public:
  // `spacing`: loops nearer than this to another one along the way, metres on
  // both sides, are left out. `paths` has to outlive this and to know the ends
  // of the loops.
  LoopWays(double spacing, const PathUncertainty* paths);

  void Add(const LoopEdge& loop);
  void RemoveIf(const std::function<bool(const LoopEdge&)>& condition);

  // (a <- b). Empty where no way leads from one to the other. Cheap for many b
  // from the same a.
  absl::optional<UncertainPose> Between(const NodeKey& a, const NodeKey& b);

  size_t num_loops() const { return loops_.size(); }

 private:
  struct NodeLess {
    bool operator()(const NodeKey& a, const NodeKey& b) const {
      return std::make_pair(a.trajectory_id, a.node_index) <
             std::make_pair(b.trajectory_id, b.node_index);
    }
  };
  struct Vertex {
    NodeKey node;
    std::vector<size_t> loops;  // that begin or end here
    // Neighbours along the trajectory, or kNone.
    size_t before;
    size_t after;
  };
  // The ways from one node to all vertices.
  struct Tree {
    struct Branch {
      double effort;
      size_t from;  // vertex before, or kNone: from the root
      size_t loop;  // that leads here, or kNone: along the trajectory
      bool is_composed = false;
      absl::optional<UncertainPose> way;  // (root <- vertex)
    };
    NodeKey root;
    std::vector<Branch> branches;  // by vertex
  };

  bool HasNear(const LoopEdge& loop) const;
  void BuildVertices();
  // Vertices at or around a node.
  std::vector<size_t> Around(const NodeKey& node) const;
  Tree* TreeOf(const NodeKey& root);
  const absl::optional<UncertainPose>& WayTo(size_t vertex, Tree* tree) const;

  const double spacing_;
  const PathUncertainty* const paths_;
  std::vector<LoopEdge> loops_;
  std::map<NodeKey, std::vector<NodeKey>, NodeLess>
      by_node_;  // their ends b, a
  std::vector<Vertex> vertices_;
  std::map<NodeKey, size_t, NodeLess> vertex_of_;
  // What was built from the loops is valid.
  bool is_built_ = false;
  std::map<NodeKey, Tree, NodeLess> trees_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_WAYS_H_
