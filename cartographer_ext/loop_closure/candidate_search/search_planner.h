// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Which candidates are searched for a loop, and how widely around the
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
//
// The plans depend on what was proposed and decided before, in this order, and
// on nothing else. Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_PLANNER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_PLANNER_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/loop_closure/candidate_search/search_credit.h"
#include "cartographer_ext/loop_closure/candidate_search/search_result.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/least_uncertain_paths.h"
#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

struct SearchPlannerOptions {
  // Otherwise Cartographer's sampler and its fixed window.
  bool enabled = true;
  int max_searches_per_node = 8;  // > 0
  // Half width of the window in standard deviations of the prediction, > 0.
  // The prediction errs by more once in a hundred times, and the next node
  // tries again.
  double window_sigmas = 3.;
  // The window never gets smaller, for errors that the model of the path does
  // not have. Metres and radians (10 degrees), > 0.
  double min_linear_window = 1.;
  double min_angular_window = 0.17;
  // Beyond this the whole submap is searched, if that is allowed. Metres, > 0.
  double max_linear_window = 15.;
  bool global_search = true;
  // The same submap is searched again after so many metres or seconds, after an
  // accepted loop. 0 metres: at once. A second loop of the same revisit adds
  // little. Time counts so that a place visited twice without going far is
  // closed twice.
  double redundant_distance = 2.;
  double redundant_time = 10.;
  // The same in metres after any search, in a window and in a whole submap,
  // which costs a hundred times as much. Half a metre is the spacing of the
  // nodes that temporal verification compares.
  double search_spacing = 0.5;
  double full_search_spacing = 3.;
  // Metres. Where the path to the submap is less uncertain, a loop, which is as
  // uncertain itself, would add nothing.
  double informative_sigma = 0.05;
};

class SearchPlanner {
 public:
  // `loop_covariance`: of a loop itself. `reach`: how far a node may be from
  // the origin of a submap that it sees, metres. `default_linear_window`,
  // `default_angular_window`: where no uncertainty is known. `paths` has to
  // outlive this and to know the nodes.
  SearchPlanner(const SearchPlannerOptions& options,
                const Eigen::Matrix3d& loop_covariance, double reach,
                double default_linear_window, double default_angular_window,
                const uncertainty::PathUncertainty* paths);

  SearchPlanner(const SearchPlanner&) = delete;
  SearchPlanner& operator=(const SearchPlanner&) = delete;

  // One plan for each candidate, in their order. Candidates of one node have to
  // come in one call for the cap to count them together.
  std::vector<SearchPlan> Plan(
      const std::vector<const LoopCandidate*>& candidates);

  // (anchor <- node) of a candidate that was accepted.
  void AddAcceptedLoop(const LoopCandidate& accepted,
                       const uncertainty::LoopEdge& loop);
  // Accepted loops of nodes of a trajectory up to an index with submaps of
  // another one no longer locate its nodes.
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

    Nodes* Searched(const SearchPlan& plan) {
      return plan.full_submap ? &searched_fully : &searched;
    }
  };

  // Whether a node of `nodes` is nearer to that of the candidate than
  // `distance` metres of travel and `duration` seconds.
  bool HasNear(const Nodes& nodes, const LoopCandidate& candidate,
               double distance, double duration) const;
  // Without regard to the other candidates of the node.
  SearchPlan PlanAlone(const LoopCandidate& candidate);
  // The window for the uncertainty of the prediction, into the plan; returns
  // whether the uncertainty is known.
  bool PlanWindow(const LoopCandidate& candidate, SearchPlan* plan);
  // Larger is better.
  double Promise(const LoopCandidate& candidate, const SearchPlan& plan) const;
  // Skips all but the most promising of the candidates of one node, `indices`.
  void ApplyCap(const std::vector<const LoopCandidate*>& candidates,
                const std::vector<size_t>& indices,
                std::vector<SearchPlan>* plans);

  const SearchPlannerOptions options_;
  const Eigen::Matrix3d loop_covariance_;
  const double reach_;
  const double default_linear_window_;
  const double default_angular_window_;
  const uncertainty::PathUncertainty* const paths_;
  std::map<uncertainty::SubmapId, SubmapMemory> submaps_;
  SearchCredit credit_;
  uncertainty::LeastUncertainPaths least_uncertain_paths_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_PLANNER_H_
