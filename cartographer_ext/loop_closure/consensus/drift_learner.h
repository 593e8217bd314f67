// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Estimates the drift of local SLAM from the candidates of a run.
//
// Consecutive candidates between the same two pieces of the path need no
// assumption about the long path between these pieces: two of them, a few
// metres apart, close a cycle with two short pieces of path, and the error of
// this cycle is the drift of local SLAM there (drift_estimator.h). A candidate
// with a place that was mapped shortly before closes a cycle with the path
// itself. The mixture of the estimator handles wrong candidates; candidates
// need not be accepted before they are used, so an overconfident model cannot
// perpetuate itself by rejecting what contradicts it.
//
// A candidate over a long path does not tell whether it is a place that looks
// alike, but the headings of such places are those of the right one, so that its
// heading tells the drift of the heading along the whole path.
//
// Consensus and search use the upper bound. It is never below the prior for the
// translation: an estimate over metres does not cover errors that accumulate along
// a whole run. Nor is it for the rotation, as long as few matches are wrong: wider
// windows find loops after wheel slip, which no estimate foresees, and cost
// little. Where many places look alike wide windows find wrong ones. So the
// bound of the rotation yields to the estimate as the share of wrong matches
// grows.
//
// The errors that are constant along the run are removed from the paths. All this
// is passed on only after a significant change.
//
// Not thread-safe; loops are added in the order of the candidates.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_DRIFT_LEARNER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_DRIFT_LEARNER_H_

#include <deque>
#include <map>

#include "absl/types/optional.h"
#include "cartographer_ext/uncertainty/drift_estimator.h"
#include "cartographer_ext/uncertainty/drift_model.h"
#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// Estimates the drift from candidates, see above.
class DriftLearner {
 public:
  // `paths` must outlive this object and contain the nodes of the loops; its
  // drift is set by this object. `prior` is the noise it was created with.
  DriftLearner(const uncertainty::PathNoiseOptions& prior,
               uncertainty::PathUncertainty* paths);

  // Adds a possibly true loop between nodes of one trajectory; others are
  // ignored. `window`: half width of the search that found it, metres.
  void Add(const uncertainty::LoopEdge& loop, double window);
  // Passes the estimates to the paths; returns whether that changed them.
  // `share_wrong`: of the verified matches of the run, in [0, 1].
  bool Update(double share_wrong);
  uncertainty::DriftEstimate Estimate(int trajectory_id) const;
  // The estimates of all trajectories that have one.
  std::map<int, uncertainty::DriftEstimate> Estimates() const;
  void DeleteTrajectory(int trajectory_id);

 private:
  struct FoundLoop {
    uncertainty::LoopEdge edge;
    double window;
  };
  struct LongLoop {
    uncertainty::LoopEdge edge;
    uncertainty::HeadingCycle heading;
  };
  struct Trajectory {
    Trajectory();

    uncertainty::DriftEstimator estimator;
    std::deque<FoundLoop> loops;      // that closed or begin cycles
    std::deque<LongLoop> long_loops;  // over long paths
    uncertainty::DriftFit fit;
    int num_fitted = 0;  // cycles
  };

  void AddLongLoop(const uncertainty::LoopEdge& loop, Trajectory* trajectory);
  // Loops with an end that `paths_` does not keep any more.
  void DropForgotten(std::deque<LongLoop>* loops) const;
  // Metres of path that the long loops cover together.
  double Driven(const Trajectory& trajectory) const;
  void Fit(Trajectory* trajectory);
  // The path as local SLAM has it; empty where it is not known.
  absl::optional<uncertainty::DriftStretch> Stretch(
      const uncertainty::VertexId& from, const uncertainty::VertexId& to) const;
  // The cycle of a loop with the path itself, if that is short.
  absl::optional<uncertainty::DriftCycle> CycleWithPath(
      const uncertainty::LoopEdge& loop) const;
  absl::optional<uncertainty::DriftCycle> CycleWithLoop(
      const uncertainty::LoopEdge& u, const uncertainty::LoopEdge& v) const;

  const uncertainty::PathNoiseOptions prior_;
  uncertainty::PathUncertainty* const paths_;
  std::map<int, Trajectory> trajectories_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_DRIFT_LEARNER_H_
