// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Selects the candidates that are searched, and their windows around the
// prediction.
//
//   window     `window_sigmas` standard deviations of the least uncertain path
//              from the submap to the node, along the trajectory and over
//              accepted loops (least_uncertain_paths.h). A node that has just
//              closed a loop is searched closely, one that has driven far since
//              is searched widely, and one that may be anywhere in the whole
//              submap.
//   spacing    A submap is searched again after some distance only; after an
//              accepted loop after a longer one or some time; not at all while
//              the path to it is less uncertain than a loop would be.
//   cap        Of the candidates of one node that remain the most promising are
//              searched: those with much to gain that are near enough to
//              overlap; wide windows only while there is credit for them
//              (search_credit.h).
//   saturation A submap that many loops constrain already gains little from
//              another one, and a node needs few loops. Of the saturated
//              submaps around a node only the nearest are searched, so that its
//              cost does not grow with the number of earlier visits.
//   passes     The same holds for a place of a submap that a few passes are tied
//              to (place_passes.h), and where the path tells nearly as much as a
//              loop would it is not searched at all. Of the nodes of earlier
//              laps, all of which a new submap meets at once, a few passes at
//              each place are searched.
//
// The plans depend only on the sequence of previous proposals and decisions.
// Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_PLANNER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_PLANNER_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer_ext/loop_closure/candidate_search/place_passes.h"
#include "cartographer_ext/loop_closure/candidate_search/search_credit.h"
#include "cartographer_ext/loop_closure/candidate_search/search_result.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/least_uncertain_paths.h"
#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace loop_closure {

// Windows and limits of searches.
struct SearchPlannerOptions {
  // Otherwise Cartographer's sampler and its fixed window.
  bool enabled = true;
  int max_searches_per_node = 8;  // > 0
  // Half width of the window in standard deviations of the prediction, > 0.
  // About one prediction in a hundred has a larger error; then the next node is
  // searched.
  double window_sigmas = 3.;
  // Smallest window, for errors that the model of the path does not include.
  // Metres and radians (10 degrees), > 0.
  double min_linear_window = 1.;
  double min_angular_window = 0.17;
  // Largest window; beyond it the whole submap is searched, if enabled. Metres,
  // > 0.
  double max_linear_window = 15.;
  bool global_search = true;
  // After an accepted loop the same submap is searched again after this
  // distance or time; 0 metres: immediately. A second loop of the same revisit
  // adds little. The time limit ensures that a place revisited after a short
  // path is closed again.
  double redundant_distance = 2.;
  double redundant_time = 10.;
  // The same distance after any search, in a window and in a whole submap,
  // which costs some 25 times as much. Half a metre is the spacing of the
  // nodes that temporal verification compares.
  double search_spacing = 0.5;
  double full_search_spacing = 3.;
  // Metres. If the path to the submap is less uncertain than this, a loop would
  // not add information.
  double informative_sigma = 0.05;
  // A submap with this many accepted loops is saturated, > 0: one more lowers
  // the standard deviation of its pose by half a percent. Of the saturated
  // submaps around a node this many are searched if the path to them is less
  // uncertain than `saturated_sigma` metres, otherwise all.
  int saturating_loops = 100;
  double saturated_sigma = 1.;
  int max_saturated_searches_per_node = 1;  // > 0
  // A place of a submap is saturated, too, with this many passes, > 0. Of the
  // nodes that a submap meets at once as many passes are searched at each place
  // where the path is less uncertain than `saturated_sigma`.
  int max_passes_per_place = 3;
};

// Sets the standard deviations of a prediction with this covariance, and the
// window that they ask for.
void SetWindow(const SearchPlannerOptions& options,
               const Eigen::Matrix3d& covariance, SearchPlan* plan);

// The covariance of where a search expects its match, in the node's tracking
// frame: that of the prediction, or of the window where it is unknown, and what
// the smallest window allows for.
Eigen::Matrix3d ExpectedCovariance(const SearchPlannerOptions& options,
                                   const SearchPlan& plan);
// The same for a prediction with this covariance.
Eigen::Matrix3d ExpectedCovariance(const SearchPlannerOptions& options,
                                   const Eigen::Matrix3d& covariance);

// Plans the searches of candidates, see above.
class SearchPlanner {
 public:
  // `loop_covariance`: of a loop itself. `reach`: maximum distance of a node
  // from the origin of a submap that it sees, metres. `default_linear_window`,
  // `default_angular_window`: used if the uncertainty is unknown. `paths` must
  // outlive this object and contain the nodes.
  SearchPlanner(const SearchPlannerOptions& options,
                const Eigen::Matrix3d& loop_covariance, double reach,
                double default_linear_window, double default_angular_window,
                const uncertainty::PathUncertainty* paths);

  SearchPlanner(const SearchPlanner&) = delete;
  SearchPlanner& operator=(const SearchPlanner&) = delete;

  // Returns one plan per candidate, in their order. Candidates of one node must
  // be passed in one call, so that the limit per node applies to all of them.
  std::vector<SearchPlan> Plan(
      const std::vector<const LoopCandidate*>& candidates);

  // (a <- b) along the least uncertain path over all accepted loops; empty if
  // none connects them.
  absl::optional<uncertainty::UncertainPose> PathBetween(
      const uncertainty::VertexId& a, const uncertainty::VertexId& b) {
    return least_uncertain_paths_.Between(a, b);
  }

  // Whether a loop near the candidate was accepted.
  bool IsRedundant(const LoopCandidate& candidate) const;

  // Paths over the accepted loops for which the condition does not hold.
  uncertainty::LeastUncertainPaths PathsWithout(
      const std::function<bool(const uncertainty::LoopEdge&)>& condition)
      const {
    return least_uncertain_paths_.Without(condition);
  }
  // (anchor <- node) of a candidate that was accepted.
  void AddAcceptedLoop(const LoopCandidate& accepted,
                       const uncertainty::LoopEdge& loop);
  // The same when it is withdrawn.
  void RemoveAcceptedLoop(const uncertainty::VertexId& anchor,
                          const uncertainty::NodeId& node);
  // Accepted loops between nodes of a trajectory up to an index and submaps of
  // another one are no longer used to predict its nodes.
  void ForgetLoops(int trajectory_id, int submap_trajectory_id,
                   int last_node_index);
  void DeleteSubmap(const uncertainty::SubmapId& submap);
  void DeleteTrajectory(int trajectory_id);

 private:
  // With their times.
  using Nodes = std::map<uncertainty::VertexId, int64_t>;
  struct SubmapMemory {
    Nodes searched;
    Nodes searched_fully;
    Nodes accepted;
    PlacePasses passes;  // of accepted loops

    Nodes* Searched(const SearchPlan& plan) {
      return plan.full_submap ? &searched_fully : &searched;
    }
  };

  // Whether a node of `nodes` is within `distance` metres of path and
  // `duration` seconds of the candidate's node.
  bool HasNear(const Nodes& nodes, const LoopCandidate& candidate,
               double distance, double duration) const;
  // Plans a candidate independently of the other candidates of its node.
  SearchPlan PlanAlone(const LoopCandidate& candidate);
  // The window for the uncertainty of the prediction, into the plan; returns
  // whether the uncertainty is known.
  bool PlanWindow(const LoopCandidate& candidate, SearchPlan* plan);
  // Adds a node, within the bound on memory.
  static void Remember(const uncertainty::VertexId& node, int64_t time,
                       Nodes* nodes);
  // Whether the submap, or the place in it, has enough loops.
  bool IsSaturated(const LoopCandidate& candidate) const;
  bool HasEnoughPasses(const SubmapMemory& memory,
                       const LoopCandidate& candidate) const;
  // Whether the place has enough passes for a path as uncertain as planned.
  bool IsTied(const LoopCandidate& candidate, const SearchPlan& plan) const;
  // Whether the node of a saturated candidate needs no other one: it is
  // searched, or has been near it, and the path is known roughly.
  bool IsEnoughFor(const LoopCandidate& candidate, const SearchPlan& plan);
  // For wide searches, of a node that has candidates.
  void EarnCredit(const uncertainty::NodeId& node);
  // Plans a candidate and notes the search.
  void PlanAndNote(const LoopCandidate& candidate, SearchPlan* plan);
  // Plans the candidates of one node, `indices`.
  void PlanNode(const std::vector<const LoopCandidate*>& candidates,
                const std::vector<size_t>& indices,
                std::vector<SearchPlan>* plans);
  // Priority of a candidate; larger is better.
  double Promise(const LoopCandidate& candidate, const SearchPlan& plan) const;
  // Of the planned searches of one node, `of_node`, skips all but the most
  // promising.
  void ApplyCap(const std::vector<const LoopCandidate*>& candidates,
                const std::vector<size_t>& indices,
                std::vector<SearchPlan>* plans);

  const SearchPlannerOptions options_;
  const Eigen::Matrix3d loop_covariance_;
  const PassLimits pass_limits_;
  const double reach_;
  const double default_linear_window_;
  const double default_angular_window_;
  const uncertainty::PathUncertainty* const paths_;
  std::map<uncertainty::SubmapId, SubmapMemory> submaps_;
  // Of the searches of one call.
  std::map<uncertainty::SubmapId, PlacePasses> planned_passes_;
  SearchCredit credit_;
  uncertainty::LeastUncertainPaths least_uncertain_paths_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_PLANNER_H_
