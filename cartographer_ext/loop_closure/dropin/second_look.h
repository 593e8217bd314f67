// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Searches that could not be made when the nodes were added.
//
//   around accepted loops   A loop far from where it was predicted is accepted
//                           when enough others agree, often long after the robot
//                           was there. The nodes around it were searched widely
//                           and therefore sparsely, or not at all. At the end of
//                           the run they are searched where the loop predicts
//                           them.
//   around single matches   A match that nobody supports predicts its
//                           neighbours, too. If the place is right, most of them
//                           match where it puts them; in a place that merely
//                           looks alike they soon do not. Around a match in a
//                           whole submap, which may show the place from another
//                           side, it is enough that they pass verification. Such searches decide
//                           about the match and give no loops themselves. They
//                           are made when the robot has left the place, or at
//                           the end of the run. Some matches that are certainly
//                           wrong are followed, too, because they show how far
//                           places look alike (consensus/neighbour_odds.h).
//
// A neighbour is searched in one submap, the one that covers best what the
// robot sees there, in a narrow window. The scans are those of the history, so
// that nothing is asked of the host, which may have deleted the nodes.
//
// Within one trajectory only, and only with `search` and single strong loops
// enabled. Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SECOND_LOOK_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SECOND_LOOK_H_

#include <deque>
#include <functional>
#include <map>
#include <set>

#include "absl/types/optional.h"
#include "cartographer_ext/loop_closure/candidate_search/typical_fit.h"
#include "cartographer_ext/loop_closure/dropin/pair_planner.h"
#include "cartographer_ext/loop_closure/dropin/pair_searcher.h"
#include "cartographer_ext/loop_closure/dropin/submap_store.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure/loop_pipeline.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace loop_closure {

// Searches nodes of the past, see above.
class SecondLook {
 public:
  // All must outlive this object.
  SecondLook(const LoopOptions& options, const PairSearcher* searcher,
             const TypicalFit* typical_fit, SubmapStore* submaps,
             PairPlanner* planner, LoopPipeline* pipeline);

  SecondLook(const SecondLook&) = delete;
  SecondLook& operator=(const SecondLook&) = delete;

  void AddAccepted(const LoopCandidate& accepted);
  // Searches around what was accepted since the last call. The candidates go
  // through the pipeline; returns whether there were any.
  bool SearchAroundAccepted();
  // Searches around the undecided candidates that were not followed yet, before
  // the end of a run those in a weak prior that the robot has left behind;
  // returns whether there were any.
  bool FollowUndecided(bool at_end);

  // Nodes up to an index are no longer searched.
  void DeleteNodes(int trajectory_id, int last_node_index);
  void DeleteTrajectory(int trajectory_id);

 private:
  // A search of a neighbour of `match` predicted at (a <- node), with the least
  // score of that match. Empty where nothing is mapped there, or where it is not
  // known well enough.
  absl::optional<SearchJob> MakeJob(
      const LoopCandidate& match, const uncertainty::NodeId& a,
      const uncertainty::NodeId& node,
      const uncertainty::UncertainPose& prediction) const;
  // A candidate without node of the submap that covers best what is seen at a
  // node of its own; near another submap.
  absl::optional<LoopCandidate> SubmapAround(
      const uncertainty::NodeId& node, const uncertainty::SubmapId& near) const;
  // Calls `visit` for nodes before and behind another one, `kSpacing` apart.
  void Walk(const uncertainty::NodeId& from, double least, double most,
            const std::function<void(const uncertainty::NodeId&)>& visit) const;
  // Matches the scan of the history.
  void Match(SearchJob* job) const;
  bool IsWorthFollowingNow(const LoopCandidate& candidate) const;
  FollowedMatch Follow(const LoopCandidate& candidate) const;
  // Whether a node near this one was searched again.
  bool IsLookedAt(const uncertainty::NodeId& node) const;

  const LoopOptions options_;
  // Not in the literal modes of the papers.
  const bool is_on_;
  const PairSearcher* const searcher_;
  const TypicalFit* const typical_fit_;
  SubmapStore* const submaps_;
  PairPlanner* const planner_;
  LoopPipeline* const pipeline_;
  std::deque<LoopCandidate> accepted_;  // to be looked around
  std::set<uncertainty::NodeId> looked_at_;
  std::map<int, int> last_deleted_node_;  // by trajectory
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SECOND_LOOK_H_
