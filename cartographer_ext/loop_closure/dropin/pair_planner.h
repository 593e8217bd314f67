// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of the pairs of a node and a submap that the pose graph offers are
// searched, and how.
//
//   own run        SearchPlanner, or Cartographer's sampler and fixed window.
//   other run      MapLocalization says whether around the prediction or
//                  everywhere. Everywhere, all submaps of the other run are
//                  searched at once; submaps overlap by half, so that each
//                  second one is enough.
//   loaded map     Nodes of a map that was loaded are not searched in the
//                  submaps of the run that is localised in it: the run's nodes
//                  are, in the submaps of the map.
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
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/candidate_search/search_planner.h"
#include "cartographer_ext/loop_closure/relocalization/map_localization.h"
#include "cartographer_ext/loop_closure_options.pb.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// A pair that was offered.
struct OfferedPair {
  cartographer::mapping::SubmapId submap_id{0, 0};
  cartographer::mapping::NodeId node_id{0, 0};
  const cartographer::mapping::TrajectoryNode::Data* node = nullptr;
  bool is_global = false;  // nothing is predicted
  Pose2 predicted;         // (submap <- node), gravity-aligned
  Pose2 from_robot;        // (gravity-aligned <- tracking frame), a rotation
  absl::optional<uncertainty::VertexId> anchor;
};

// What is to be done with it.
struct PlannedPair {
  size_t pair = 0;  // index
  SearchPlan plan;
  // Of equal numbers >= 0 all are searched at once; those that are skipped are
  // there for places to be followed into them.
  int64_t query = -1;
};

// A run lost its place in a map: what was found up to the node is out of date.
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
      const proto::LoopClosureOptions& extension,
      const uncertainty::PathUncertainty* paths);

  // The pairs that were offered when one node was added: those of this node
  // first, then older ones with a submap that has become complete. The same
  // pair may be planned twice, around its prediction and everywhere. Of the
  // pairs that are out of any reach some are left out.
  std::vector<PlannedPair> Plan(const std::vector<OfferedPair>& pairs,
                                std::vector<LostPlace>* lost);

  // (anchor <- node) of a loop that was accepted, if the anchor is known. True
  // as MapLocalization::AddAcceptedLoop.
  bool AddAcceptedLoop(const cartographer::mapping::SubmapId& submap_id,
                       const uncertainty::NodeId& node, int64_t node_time,
                       const absl::optional<uncertainty::LoopEdge>& loop);
  void DeleteSubmap(const cartographer::mapping::SubmapId& submap_id);

  MapLocalization* localization() { return &localization_; }

 private:
  using SubmapId = cartographer::mapping::SubmapId;

  SearchPlan PlanLikeStock(const OfferedPair& pair);
  // Pairs of one node with submaps of one other trajectory. What is to be
  // searched around a prediction is appended to `around`.
  void PlanForeign(const std::vector<OfferedPair>& pairs,
                   const std::vector<size_t>& group,
                   std::vector<PlannedPair>* planned,
                   std::vector<size_t>* around, std::vector<LostPlace>* lost);
  void PlanQuery(const std::vector<OfferedPair>& pairs,
                 const std::vector<size_t>& group,
                 std::vector<PlannedPair>* planned);

  const cartographer::mapping::constraints::proto::ConstraintBuilderOptions
      options_;
  const proto::LoopClosureOptions extension_;
  SearchPlanner search_planner_;
  MapLocalization localization_;
  std::map<SubmapId, cartographer::common::FixedRatioSampler> samplers_;
  // Those of nodes that the pose graph has added, not loaded.
  std::set<int> live_trajectories_;
  int64_t num_queries_ = 0;
  // The last query of each submap.
  std::map<SubmapId, int64_t> last_queries_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_PLANNER_H_
