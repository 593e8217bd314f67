// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Learns from the candidates of a run how much local SLAM drifts.
//
// Candidates in a row between the same two stretches of the path need no
// assumption about the path between the stretches: two of them, a few metres
// apart, close a cycle with the two short pieces of path between them, and it
// stays open by as much as local SLAM has drifted there (drift_estimator.h). A
// candidate with a place that was mapped shortly before closes a cycle with
// the path itself. Wrong candidates are what the mixture of the estimator is
// for; none has to be accepted before it counts, so a model that is too narrow
// cannot keep itself alive by refusing what contradicts it.
//
// What consensus and search use is the bound from above, never below the prior:
// what is learnt over metres says nothing about errors that add up along a
// whole run. What is the same all along the run is taken out of the paths. Both
// are passed on when they have changed enough to matter.
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

class DriftLearner {
 public:
  // `paths` has to outlive this and to know the nodes of the loops; its drift
  // is set. `prior` is the noise it was made with.
  DriftLearner(const uncertainty::PathNoiseOptions& prior,
               uncertainty::PathUncertainty* paths);

  // A loop between nodes of one trajectory that may be right; others are
  // ignored.
  void Add(const uncertainty::LoopEdge& loop);
  // Passes what was learnt to the paths; true where that changed them.
  bool Update();
  uncertainty::DriftEstimate Estimate(int trajectory_id) const;
  // The trajectories of which something is known.
  std::map<int, uncertainty::DriftEstimate> Estimates() const;
  void DeleteTrajectory(int trajectory_id);

 private:
  struct Trajectory {
    Trajectory();

    uncertainty::DriftEstimator estimator;
    std::deque<uncertainty::LoopEdge> loops;  // that closed or begin cycles
    uncertainty::DriftFit fit;
    int num_fitted = 0;  // cycles
  };

  // Of a loop with the path itself, where that is short.
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
