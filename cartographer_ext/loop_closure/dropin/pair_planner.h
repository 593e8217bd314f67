// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of the pairs of a submap and a node that the pose graph proposes are
// searched, and how.
//
//   one trajectory     SearchPlanner, or Cartographer's sampler and fixed
//                      window.
//   two trajectories   MapLocalization decides whether around the prediction or
//                      everywhere. Everywhere, all submaps of the other
//                      trajectory are searched at once; submaps overlap by
//                      half, so that every second one is enough.
//   loaded map         Nodes of a map that was loaded are not searched in the
//                      submaps of the run that is localised in it: the nodes of
//                      the run are, in the submaps of the map.
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
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure/relocalization/map_localization.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// A run lost its place in a map: the loops found up to the node no longer
// locate it.
struct LostPlace {
  int trajectory_id = 0;
  int map_trajectory_id = 0;
  int last_node_index = -1;
  bool by_decisions = false;  // about its place
};

class PairPlanner {
 public:
  // `paths` has to outlive this and to know the nodes.
  PairPlanner(
      const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
          options,
      const LoopOptions& extension, const uncertainty::PathUncertainty* paths);

  // The candidates with their plans. `proposed` are those proposed when one
  // node was added: those of this node first, then older nodes with a submap
  // that has become complete. The same pair may be planned twice, around its
  // prediction and everywhere.
  std::vector<LoopCandidate> Plan(const std::vector<LoopCandidate>& proposed,
                                  std::vector<LostPlace>* lost);

  // A candidate that was accepted, with its loop if the anchor is known. True
  // as MapLocalization::AddAcceptedLoop.
  bool AddAcceptedLoop(const LoopCandidate& accepted,
                       const absl::optional<uncertainty::LoopEdge>& loop);
  void DeleteSubmap(const uncertainty::SubmapId& submap);
  void DeleteTrajectory(int trajectory_id);

  MapLocalization* localization() { return &localization_; }

 private:
  struct Planned {
    size_t proposed = 0;  // index
    SearchPlan plan;
  };
  // One planning call: what is proposed, and what is known of it so far.
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
  // Those of nodes that the pose graph has added, not loaded.
  std::set<int> live_trajectories_;
  int64_t num_queries_ = 0;
  // The last query of each submap.
  std::map<uncertainty::SubmapId, int64_t> last_queries_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_PLANNER_H_
