// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/readmission.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "cartographer_ext/optimization/offline/certain_growth.h"
#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/loop_support.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Groups that are forced into the map of a replay, the largest first, and their
// least size: a loop agrees by chance with another one, but hardly with two.
constexpr int kMaxForcedGroups = 10;
constexpr int kMinForcedGroup = 3;
// Share of the loops that others agree with.
constexpr double kHardlyAny = 0.1;

// Whether a group of rejected loops contradicts the map, or more than a few lie
// within its uncertainty.
bool MayHaveLostLoops(const LoopSupport& support,
                      const std::vector<bool>& accepted,
                      const std::vector<Pose2>& poses,
                      RobustSolver* const solver) {
  for (const std::vector<int>& group : support.groups) {
    const int lost = std::count_if(group.begin(), group.end(),
                                   [&](const int i) { return !accepted[i]; });
    if (lost >= kMinForcedGroup) return true;
  }
  std::vector<int> rejected;
  for (size_t i = 0; i != accepted.size(); ++i) {
    if (!accepted[i]) rejected.push_back(i);
  }
  return MorePossibleThanByChance(PredictLoops(
      rejected, std::vector<double>(accepted.begin(), accepted.end()), poses,
      solver));
}

// Whether hardly any of the loops that others agree with is in force.
bool HasLostNearlyAll(const LoopSupport& support,
                      const std::vector<bool>& accepted) {
  double loops = 0., in_force = 0.;
  for (const std::vector<int>& group : support.groups) {
    if (static_cast<int>(group.size()) < kMinForcedGroup) continue;
    loops += group.size();
    for (const int i : group) in_force += accepted[i];
  }
  return in_force < kHardlyAny * loops;
}

}  // namespace

bool ReadmitGroups(const PoseGraph& graph,
                   std::vector<WhitenedEdge>* const edges,
                   RobustSolver* const solver, ReplayResult* const replay) {
  const double loops = CountLoops(*edges);
  const bool large = graph.poses.size() * loops > kMaxGrowthWork;
  if (large &&
      CountLoopsInForce(*edges, replay->accepted) >= kHardlyAny * loops) {
    return false;
  }
  const LoopSupport support = FindLoopSupport(graph, LoopSupportOptions());
  if (large ? !HasLostNearlyAll(support, replay->accepted)
            : !MayHaveLostLoops(support, replay->accepted, replay->poses,
                                solver)) {
    return false;
  }
  const double limit = TruncatedCost(*edges, replay->poses) - 2. * kChi2Gate;
  const std::vector<Pose2> chained = ChainOdometry(graph);
  std::vector<Pose2> best = replay->poses, poses = chained;
  double lowest = std::numeric_limits<double>::infinity();
  const auto offer = [&] {
    PolishTruncated(kChi2Gate, kFullPolishRounds, solver, &poses, nullptr);
    const double cost = TruncatedCost(*edges, poses);
    if (cost >= lowest) return;
    lowest = cost;
    best = poses;
  };
  std::vector<double> weights;
  if (large ? GrowCertainLoops(graph, CertainGrowthOptions(), solver, &poses,
                               &weights) > 0
            : GrowLoops(support, GrowthOptions(), solver, &poses, &weights)) {
    offer();
  }
  poses = chained;
  if (!large &&
      GrowCertainLoopsAndGroups(graph, support, solver, &poses, &weights)) {
    offer();
  }
  for (const KernelType type : {KernelType::kDcs, KernelType::kGemanMcClure}) {
    SolverOptions soft;
    soft.kernel = DefaultKernel(type);
    soft.kernel.parameter = kChi2Gate;
    poses = best;
    solver->Solve(soft, &poses);
    offer();
  }
  ForceOptions force;
  force.max_trials = kMaxForcedGroups;
  force.min_members = kMinForcedGroup;
  force.relax = !large;  // two more factorisations a trial
  poses = best;
  if (ForceGroups(support, force, edges, solver, &poses, nullptr) > 0) {
    offer();
  }
  if (lowest > limit) return false;
  weights = DecideLoops(*edges, best, kChi2Gate);
  replay->poses = std::move(best);
  for (size_t i = 0; i != edges->size(); ++i) {
    replay->accepted[i] = weights[i] > 0.5;
  }
  return true;
}

}  // namespace optimization
}  // namespace cartographer_ext
