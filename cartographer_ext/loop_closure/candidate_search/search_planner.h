// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Which pairs of a node and a submap are searched for a loop, and how far
// around the prediction.
//
//   window     `window_sigmas` standard deviations of the most certain way from
//              the submap to the node, along the trajectory and over accepted
//              loops (least_uncertain_paths.h). A node that has just closed a
//              loop is searched closely, one that has gone far since is
//              searched widely, and one that may be anywhere in the whole
//              submap.
//   spacing    A submap is searched again after some way only; after an
//              accepted loop after a longer one or some time; not at all while
//              the way to it is known better than a loop could tell.
//   cap        Of the pairs of one node that are left the most promising are
//              searched: much to be learnt, and near enough to overlap.
//
// Everything depends on what was offered and decided before, in this order, and
// on nothing else. Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_PLANNER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_PLANNER_H_

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure_options.pb.h"
#include "cartographer_ext/loop_decision.pb.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/least_uncertain_paths.h"
#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

struct SearchPair {
  // Of the submap.
  int submap_trajectory_id = 0;
  int submap_index = 0;
  // A node of the submap, or the submap itself; absent where none is known.
  absl::optional<uncertainty::VertexId> anchor;
  uncertainty::NodeId node;
  int64_t node_time = 0;  // host ticks, 100 ns
  Pose2 predicted;        // (submap <- node)
};

struct SearchPlan {
  // NONE: to be searched. Otherwise why not.
  proto::LoopDecision::Reason skipped = proto::LoopDecision::NONE;
  // Farther away than any window reaches: not even a candidate.
  bool out_of_reach = false;
  bool full_submap = false;
  double linear_window = 0.;   // metres, half width
  double angular_window = 0.;  // radians, half width
  // Standard deviations of the prediction; 0 where it is not known.
  double translation_sigma = 0.;  // metres, in the worst direction
  double rotation_sigma = 0.;     // radians
};

class SearchPlanner {
 public:
  // `loop_covariance`: of a loop itself. `reach`: how far a node may be from
  // the origin of a submap that it sees, metres. `default_linear_window`,
  // `default_angular_window`: where no uncertainty is known. `paths` has to
  // outlive this and to know the nodes.
  SearchPlanner(const proto::LoopClosureOptions::Search& options,
                const Eigen::Matrix3d& loop_covariance, double reach,
                double default_linear_window, double default_angular_window,
                const uncertainty::PathUncertainty* paths);

  SearchPlanner(const SearchPlanner&) = delete;
  SearchPlanner& operator=(const SearchPlanner&) = delete;

  // One plan for each pair, in their order. Pairs of one node have to come in
  // one call for the cap to count them together.
  std::vector<SearchPlan> Plan(const std::vector<SearchPair>& pairs);

  // (anchor <- node) of a loop that was accepted.
  void AddAcceptedLoop(int submap_trajectory_id, int submap_index,
                       const uncertainty::LoopEdge& loop, int64_t node_time);
  void DeleteSubmap(int submap_trajectory_id, int submap_index);
  // Accepted loops of nodes of a trajectory up to an index with submaps of
  // another one no longer tell where a node is.
  void ForgetLoops(int trajectory_id, int submap_trajectory_id,
                   int last_node_index);

 private:
  // With their times.
  using Nodes = std::map<uncertainty::VertexId, int64_t>;
  struct SubmapMemory {
    Nodes searched;
    Nodes searched_fully;
    Nodes accepted;
  };

  // Whether a node of `nodes` is nearer to `node` than `distance` metres of
  // travel and `duration` seconds.
  bool HasNear(const Nodes& nodes, const SearchPair& pair, double distance,
               double duration) const;
  SearchPlan PlanAlone(const SearchPair& pair);
  // Larger is better.
  double Promise(const SearchPair& pair, const SearchPlan& plan) const;

  const proto::LoopClosureOptions::Search options_;
  const Eigen::Matrix3d loop_covariance_;
  const double reach_;
  const double default_linear_window_;
  const double default_angular_window_;
  const uncertainty::PathUncertainty* const paths_;
  std::map<std::pair<int, int>, SubmapMemory> submaps_;
  uncertainty::LeastUncertainPaths ways_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_PLANNER_H_
