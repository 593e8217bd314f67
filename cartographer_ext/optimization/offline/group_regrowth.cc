// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "cartographer_ext/common/thinned.h"
#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/noise/map_evidence.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"
#include "cartographer_ext/optimization/offline/starts/windings.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Relative decrease of the cost after which all moves are tried again.
constexpr double kLargeProgress = 1e-6;
// Gates up to which a rejected loop is put in force: so many others would have
// to come in after it.
constexpr double kForcible = 20.;

// A group with loops in force.
struct GroupInForce {
  int turn = 0;   // among the groups with as many
  int loops = 0;  // in force
  int group = 0;
};

// Groups that may be released, in the order of trials.
std::vector<GroupInForce> ReleasableGroups(const LoopSupport& support,
                                           const std::vector<double>& weights) {
  std::vector<GroupInForce> result;
  std::map<int, int> groups_of_size;
  int all = 0;
  for (size_t g = 0; g != support.groups.size(); ++g) {
    GroupInForce entry;
    entry.group = g;
    for (const int i : support.groups[g]) entry.loops += weights[i] > 0.;
    all += entry.loops;
    if (entry.loops == 0) continue;
    entry.turn = groups_of_size[entry.loops]++;
    result.push_back(entry);
  }
  result.erase(std::remove_if(result.begin(), result.end(),
                              [all](const GroupInForce& entry) {
                                return 2 * entry.loops > all;
                              }),
               result.end());
  std::sort(result.begin(), result.end(),
            [](const GroupInForce& a, const GroupInForce& b) {
              return std::tie(a.turn, a.loops, a.group) <
                     std::tie(b.turn, b.loops, b.group);
            });
  return result;
}

// A map, the loops in force, and those that stay out.
struct Decided {
  std::vector<Pose2> poses;
  std::vector<double> weights;
  std::vector<bool> banned;
};

class Regrower {
 public:
  Regrower(const LoopSupport& support, const RegrowOptions& options,
           RobustSolver* const solver, std::vector<Pose2>* const poses,
           std::vector<Alternative>* const alternatives)
      : support_(support),
        options_(options),
        solver_(*solver),
        edges_(solver->edges()),
        poses_(*poses),
        lowest_(edges_, options.gate, kLargeProgress, poses, alternatives),
        most_work_(solver->work() + options.max_work) {}

  int Run() {
    int kept = 0;
    while (MayTry()) {
      start_.poses = poses_;
      start_.weights = DecideLoops(edges_, poses_, options_.gate);
      start_.banned.assign(edges_.size(), false);
      groups_ = ReleasableGroups(support_, start_.weights);
      if (!Move()) break;
      ++kept;
    }
    return kept;
  }

 private:
  bool MayTry() const {
    return trials_ < options_.max_trials && solver_.work() < most_work_;
  }

  // The cheap ones first: of what is released with others much grows anew.
  bool Move() {
    Decided map = start_;
    if (options_.windings_alone) {
      const std::vector<Winding> windings = OtherWindings();
      return !windings.empty() && (Grow(&map) || TryWindings(windings));
    }
    return Grow(&map) || ForceNearest(start_, options_.max_near, &forced_) ||
           TryWindings(OtherWindings()) || ReleaseAlone() ||
           ReleaseWithSmaller() || StartFromGroup();
  }

  // What failed before may succeed after progress.
  void Forget() {
    released_.clear();
    released_alone_.clear();
    forced_.clear();
  }

  // Grows the map on; false where it cannot be solved.
  bool GrowPolished(Decided* const map, std::vector<Pose2>* const polished) {
    ++trials_;
    GrowthOptions growth;
    growth.gate = options_.gate;
    if (!ContinueGrowth(support_, growth, map->banned, &solver_, &map->poses,
                        &map->weights)) {
      return false;
    }
    *polished = map->poses;
    PolishTruncated(options_.gate, kFullPolishRounds, &solver_, polished,
                    nullptr);
    return true;
  }

  // The same; whether that is the lowest.
  bool Grow(Decided* const map) {
    std::vector<Pose2> polished;
    return GrowPolished(map, &polished) && lowest_.Offer(std::move(polished));
  }

  // Whether there is more evidence for another map than for the lowest. The less
  // odometry says of headings, the more wrong loops fit with some winding.
  bool IsLikelier(const std::vector<Pose2>& poses) {
    const double log_area = LogArea(poses_);
    const auto evidence_of = [&](const std::vector<Pose2>& map) {
      return LogPosteriorOfMap({map, DecideLoops(edges_, map, options_.gate)},
                               support_, edges_, log_area, &solver_);
    };
    return evidence_of(poses) > evidence_of(poses_);
  }

  // What leads to the map of other loops in force, to grow from.
  static SolverOptions ChangedOptions(const std::vector<double>& weights) {
    SolverOptions options;
    options.edge_weights = weights;
    options.max_iterations = 30;
    options.cost_tolerance = 1e-5;
    return options;
  }

  // The same after a change of the loops in force.
  bool GrowChanged(Decided* const map) {
    const SolverOptions options = ChangedOptions(map->weights);
    std::vector<Pose2> relaxed = map->poses;
    const double cost = solver_.Solve(options, &map->poses).final_cost;
    if (ChordalPoses(edges_, map->weights, &relaxed) &&
        solver_.Solve(options, &relaxed).final_cost < cost) {
      map->poses = std::move(relaxed);
    }
    return Grow(map);
  }

  bool ReleaseWithSmaller() {
    int failures = 0;
    for (const GroupInForce& released : groups_) {
      if (failures == options_.max_failures || !MayTry()) break;
      if (!released_.insert(released.group).second) continue;
      ++failures;
      Decided map = start_;
      for (const GroupInForce& other : groups_) {
        if (other.loops > released.loops) continue;
        for (const int i : support_.groups[other.group]) map.weights[i] = 0.;
      }
      for (const int i : support_.groups[released.group]) map.banned[i] = true;
      if (!GrowChanged(&map)) continue;
      Forget();
      released_.insert(released.group);
      return true;
    }
    return false;
  }

  // Rejected loops that the map nearly allows, the nearest of each group, in
  // ascending order of their squared innovation.
  std::vector<int> NearestRejected(const Decided& map) {
    if (!MayTry()) return {};
    std::vector<int> rejected;
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (map.weights[i] == 0. && !map.banned[i]) rejected.push_back(i);
    }
    rejected = Thinned(rejected, GrowthOptions().max_candidates);
    const std::vector<Innovation> innovations =
        PredictLoops(rejected, map.weights, map.poses, &solver_);
    std::vector<std::pair<double, int>> order;
    for (size_t k = 0; k != innovations.size(); ++k) {
      if (!(innovations[k].chi2 < kForcible * options_.gate)) continue;
      order.push_back({innovations[k].chi2, rejected[k]});
    }
    std::sort(order.begin(), order.end());
    std::vector<int> result;
    std::set<int> groups;
    for (const auto& entry : order) {
      if (!groups.insert(support_.group[entry.second]).second) continue;
      result.push_back(entry.second);
    }
    return result;
  }

  // Those in `tried` are left out. The first that lowers the cost may be a wrong
  // one, so the best is kept.
  bool ForceNearest(const Decided& start, const int max_trials,
                    std::set<int>* const tried) {
    bool better = false;
    int failures = 0;
    for (const int loop : NearestRejected(start)) {
      if (failures == max_trials || !MayTry()) break;
      if (!tried->insert(loop).second) continue;
      ++failures;
      Decided map = start;
      map.weights[loop] = 1.;
      if (GrowChanged(&map)) better = true;
    }
    if (better) Forget();
    return better;
  }

  std::vector<Winding> OtherWindings() const {
    if (options_.max_windings == 0 || !MayTry()) return {};
    WindingOptions options;
    options.max_chi2 = lowest_.cost();
    return FindWindings(edges_, start_.weights, start_.poses, options);
  }

  // The loops in force solved with other windings, in ascending order of cost.
  std::vector<std::pair<double, std::vector<Pose2>>> SolveWindings(
      const std::vector<Winding>& windings) {
    const SolverOptions options = ChangedOptions(start_.weights);
    std::vector<std::pair<double, std::vector<Pose2>>> result;
    for (const Winding& winding : windings) {
      std::vector<Pose2> poses = start_.poses;
      if (!MayTry() || !Rewind(edges_, start_.weights, winding.turns, &poses)) {
        continue;
      }
      const double cost = solver_.Solve(options, &poses).final_cost;
      result.push_back({cost, std::move(poses)});
    }
    std::stable_sort(
        result.begin(), result.end(),
        [](const auto& a, const auto& b) { return a.first < b.first; });
    return result;
  }

  // The best is kept.
  bool TryWindings(const std::vector<Winding>& windings) {
    bool better = false;
    int tries = 0;
    for (auto& solved : SolveWindings(windings)) {
      if (tries == options_.max_windings || !MayTry()) break;
      ++tries;
      Decided map = start_;
      map.poses = std::move(solved.second);
      std::vector<Pose2> polished;
      if (!GrowPolished(&map, &polished) || !IsLikelier(polished)) continue;
      if (lowest_.Offer(std::move(polished))) better = true;
    }
    if (better) Forget();
    return better;
  }

  // The groups by how much more chi2 their release saves than that of right
  // loops would, three each, in standard deviations; the largest first.
  std::vector<int> ByExcess() {
    if (!MayTry()) return {};
    SolverOptions options;
    options.edge_weights = start_.weights;
    options.initial_lambda = 1e-8;
    options.max_iterations = 10;
    options.cost_tolerance = 1e-4;
    std::vector<Pose2> poses = start_.poses;
    const double all = solver_.Solve(options, &poses).final_cost;
    std::vector<std::pair<double, int>> order;
    for (const GroupInForce& entry : groups_) {
      if (!MayTry()) break;  // for the work it takes
      const std::vector<int>& group = support_.groups[entry.group];
      for (const int i : group) options.edge_weights[i] = 0.;
      poses = start_.poses;
      const double saved = all - solver_.Solve(options, &poses).final_cost;
      for (const int i : group) options.edge_weights[i] = start_.weights[i];
      order.push_back(
          {-(saved - 3. * entry.loops) / std::sqrt(6. * entry.loops),
           entry.group});
    }
    std::sort(order.begin(), order.end());
    std::vector<int> result;
    for (const auto& entry : order) result.push_back(entry.second);
    return result;
  }

  bool ReleaseAlone() {
    int failures = 0;
    for (const int group : ByExcess()) {
      if (failures == options_.max_near || !MayTry()) break;
      if (!released_alone_.insert(group).second) continue;
      ++failures;
      Decided map = start_;
      for (const int i : support_.groups[group]) {
        map.weights[i] = 0.;
        map.banned[i] = true;
      }
      std::set<int> forced;
      if (!GrowChanged(&map) &&
          !ForceNearest(map, options_.max_forced, &forced)) {
        continue;
      }
      Forget();
      released_alone_.insert(group);
      return true;
    }
    return false;
  }

  // Grows a map anew from one group, the largest first, where most loops are
  // rejected. What fails once fails again: it does not start from the loops in
  // force.
  bool StartFromGroup() {
    std::vector<std::pair<int, int>> order;
    int loops = 0, in_force = 0;
    for (size_t g = 0; g != support_.groups.size(); ++g) {
      const std::vector<int>& group = support_.groups[g];
      loops += group.size();
      for (const int i : group) in_force += start_.weights[i] > 0.;
      if (group.size() > 1) {
        order.push_back({-static_cast<int>(group.size()), g});
      }
    }
    if (2 * in_force >= loops) return false;
    std::sort(order.begin(), order.end());
    int failures = 0;
    for (const auto& entry : order) {
      if (failures == options_.max_starts || !MayTry()) break;
      if (!started_.insert(entry.second).second) continue;
      ++failures;
      Decided map = start_;
      for (size_t i = 0; i != edges_.size(); ++i) {
        if (edges_[i].is_loop) map.weights[i] = 0.;
      }
      for (const int i : support_.groups[entry.second]) map.weights[i] = 1.;
      if (!GrowChanged(&map)) continue;
      Forget();
      return true;
    }
    return false;
  }

  const LoopSupport& support_;
  const RegrowOptions& options_;
  RobustSolver& solver_;
  const std::vector<WhitenedEdge>& edges_;
  std::vector<Pose2>& poses_;
  LowestCost lowest_;
  const double most_work_;
  int trials_ = 0;
  std::set<int> released_, released_alone_;  // groups that were tried
  std::set<int> started_;                    // groups that maps were grown from
  std::set<int> forced_;                     // loops that were tried
  Decided start_;
  std::vector<GroupInForce> groups_;  // of start_
};

}  // namespace

int RegrowGroups(const LoopSupport& support, const RegrowOptions& options,
                 RobustSolver* const solver, std::vector<Pose2>* const poses,
                 std::vector<Alternative>* const alternatives) {
  return Regrower(support, options, solver, poses, alternatives).Run();
}

}  // namespace optimization
}  // namespace cartographer_ext
