// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The relative pose of two vertices of the pose graph with its covariance,
// along trajectories and over any number of accepted loops.
//
// The paths are those of a graph: its vertices are the ends of loops, its edges
// the loops and the pieces of trajectory between them. The path with the lowest
// cost is used (PathUncertainty::PathCost); the cost is additive, as Dijkstra's
// algorithm requires. The covariance is then composed along this path. A single
// path overestimates the uncertainty, since all paths together carry more
// information.
//
// One search of the graph serves all queries from the same vertex, until the
// next loop or the next change of the drift. A loop close to another one at
// both ends adds no path and is not stored; when there are too many, the spacing
// is doubled and loops are dropped accordingly, so that memory and time are
// bounded however long the robot drives. Not thread-safe.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_LEAST_UNCERTAIN_PATHS_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_LEAST_UNCERTAIN_PATHS_H_

#include <cstddef>
#include <functional>
#include <map>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace uncertainty {

// Relative poses over accepted loops, see above.
class LeastUncertainPaths {
 public:
  // A loop both of whose ends are within `spacing` metres (>= 0) of those of a
  // stored one, measured along the trajectory, is not stored. `paths` must
  // outlive this object and contain the ends of the loops.
  LeastUncertainPaths(double spacing, const PathUncertainty* paths,
                      size_t max_loops = 5000);

  void Add(const LoopEdge& loop);
  void RemoveIf(const std::function<bool(const LoopEdge&)>& condition);

  // (a <- b). Empty if no path connects them. Cheap for many b from the same a.
  absl::optional<UncertainPose> Between(const VertexId& a, const VertexId& b);

  // Those without the loops for which the condition holds.
  LeastUncertainPaths Without(
      const std::function<bool(const LoopEdge&)>& condition) const;

  size_t num_loops() const { return loops_.size(); }

 private:
  struct Vertex {
    VertexId id;
    std::vector<size_t> loops;  // that start or end here
    // Neighbours along the trajectory, or kNone.
    size_t before;
    size_t after;
  };
  // The paths from one vertex to all others.
  struct Tree {
    struct Branch {
      double cost;
      size_t from;  // vertex before, or kNone: from the root
      size_t loop;  // that leads here, or kNone: along the trajectory
      bool is_composed = false;
      absl::optional<UncertainPose> pose;  // (root <- vertex)
    };
    VertexId root;
    std::vector<Branch> branches;  // by vertex
  };

  bool HasNear(const LoopEdge& loop) const;
  // Doubles the spacing.
  void Thin();
  void BuildVertices();
  // The vertex with this id, or its neighbours along the trajectory.
  std::vector<size_t> Adjacent(const VertexId& id) const;
  // The tree of `root`, computed if necessary.
  Tree* TreeOf(const VertexId& root);
  // Dijkstra's algorithm from `tree->root`.
  void Search(Tree* tree) const;
  const absl::optional<UncertainPose>& PoseOf(size_t vertex, Tree* tree) const;

  const size_t max_loops_;
  double spacing_;
  const PathUncertainty* const paths_;
  std::vector<LoopEdge> loops_;
  std::map<VertexId, std::vector<VertexId>> ends_;  // from b to each a
  std::vector<Vertex> vertices_;
  std::map<VertexId, size_t> index_of_;
  // Whether the vertices are up to date with the loops.
  bool is_built_ = false;
  int drift_version_ = 0;  // of `paths_` when the trees were searched
  std::map<VertexId, Tree> trees_;
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_LEAST_UNCERTAIN_PATHS_H_
