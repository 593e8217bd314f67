// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Selects which of the pairs of a submap and a node proposed by the pose graph
// are searched, and how.
//
//   one trajectory     SearchPlanner, or Cartographer's sampler and fixed
//                      window.
//   two trajectories   MapLocalization decides whether to search around the
//                      prediction or everywhere. Everywhere means that all
//                      submaps of the other trajectory are searched at once;
//                      submaps overlap by half, so every second one is enough.
//   loaded map         Nodes of a loaded map are not searched in the submaps of
//                      the run that is localised in it; the nodes of the run
//                      are searched in the submaps of the map.
//
// Not thread-safe; depends on the sequence of calls only.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_PLANNER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_PLANNER_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer/common/fixed_ratio_sampler.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer_ext/loop_closure/candidate_search/search_planner.h"
#include "cartographer_ext/loop_closure/consensus/closed_prediction.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure/relocalization/map_localization.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace loop_closure {

// A run got lost in a map: the loops found up to the node no longer locate it.
struct LostPlace {
  int trajectory_id = 0;
  int map_trajectory_id = 0;
  int last_node_index = -1;
  bool by_decisions = false;  // about its place
};

// Plans the searches of pairs, see above.
class PairPlanner {
 public:
  // `paths` must outlive this object and contain the nodes.
  PairPlanner(
      const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
          options,
      const LoopOptions& extension, const uncertainty::PathUncertainty* paths);

  // Returns the candidates with their plans. `proposed` are those proposed when
  // one node was added: those of this node first, then older nodes with a
  // submap that has just been finished. The same pair may be planned twice,
  // around its prediction and everywhere.
  std::vector<LoopCandidate> Plan(const std::vector<LoopCandidate>& proposed,
                                  std::vector<LostPlace>* lost);

  // As SearchPlanner::PathBetween.
  absl::optional<uncertainty::UncertainPose> PathBetween(
      const uncertainty::VertexId& a, const uncertainty::VertexId& b) {
    return search_planner_.PathBetween(a, b);
  }

  // As SearchPlanner::IsRedundant.
  bool IsRedundant(const LoopCandidate& candidate) const {
    return search_planner_.IsRedundant(candidate);
  }

  // Adds an accepted candidate, with its loop if the anchor is known. Returns
  // as MapLocalization::AddAcceptedLoop.
  bool AddAcceptedLoop(const LoopCandidate& accepted,
                       const absl::optional<uncertainty::LoopEdge>& loop);
  // The paths over the accepted loops without these ends.
  loop_closure::PathBetween PathsWithout(const LoopEnds& ends) const;
  // To be called when it is withdrawn; `anchor` and `node` are the ends of its
  // edge.
  void RemoveAcceptedLoop(const uncertainty::VertexId& anchor,
                          const uncertainty::NodeId& node) {
    search_planner_.RemoveAcceptedLoop(anchor, node);
  }
  void DeleteSubmap(const uncertainty::SubmapId& submap);
  void DeleteTrajectory(int trajectory_id);

  MapLocalization* localization() { return &localization_; }

 private:
  struct Planned {
    size_t proposed = 0;  // index
    SearchPlan plan;
  };
  // State of one planning call.
  struct Session {
    const std::vector<LoopCandidate>& proposed;
    std::vector<Planned> planned;
    std::vector<size_t> around;  // to be searched around their predictions
    std::vector<LostPlace>* lost;
  };

  SearchPlan PlanLikeStock(const LoopCandidate& candidate);
  // Pairs of one node with submaps of one other trajectory.
  void PlanInterTrajectory(const std::vector<size_t>& group, Session* session);
  void PlanQuery(const std::vector<size_t>& group, Session* session);
  void PlanAroundPredictions(Session* session);

  const cartographer::mapping::constraints::proto::ConstraintBuilderOptions
      options_;
  const LoopOptions extension_;
  SearchPlanner search_planner_;
  MapLocalization localization_;
  std::map<uncertainty::SubmapId, cartographer::common::FixedRatioSampler>
      samplers_;
  // Trajectories of nodes that were added to the pose graph, not loaded.
  std::set<int> live_trajectories_;
  int64_t num_queries_ = 0;
  // The last query of each submap.
  std::map<uncertainty::SubmapId, int64_t> last_queries_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_PLANNER_H_
