// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/search_planner.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "Eigen/Eigenvalues"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;

// Accepted loops before the node that may offer a more certain way. The newest
// ones are the nearest along the trajectory, others add little.
constexpr int kLoopsTried = 20;
// A whole submap costs a hundred windows.
constexpr size_t kFullSearchesPerNode = 1;
// Accepted loops and searched nodes remembered, oldest forgotten first.
constexpr size_t kMaxLoops = 20000;
constexpr size_t kMaxNodesPerSubmap = 20000;

double WorstSigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
      Eigen::Matrix2d(covariance.topLeftCorner<2, 2>()),
      Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0., solver.eigenvalues()(1)));
}

}  // namespace

SearchPlanner::SearchPlanner(const proto::LoopClosureOptions::Search& options,
                             const Eigen::Matrix3d& loop_covariance,
                             const double reach,
                             const double default_linear_window,
                             const double default_angular_window,
                             const PathUncertainty* const paths)
    : options_(options),
      loop_covariance_(loop_covariance),
      reach_(reach),
      default_linear_window_(default_linear_window),
      default_angular_window_(default_angular_window),
      paths_(CHECK_NOTNULL(paths)) {}

bool SearchPlanner::HasNear(const NodeSet& nodes, const NodeKey& node,
                            const double distance) const {
  if (distance <= 0.) return false;
  const auto near = [&](const NodeKey& other) {
    const absl::optional<double> travelled = paths_->Travelled(other, node);
    return travelled.has_value() && *travelled < distance;
  };
  const auto after = nodes.lower_bound(node);
  if (after != nodes.end() && near(*after)) return true;
  return after != nodes.begin() && near(*std::prev(after));
}

absl::optional<UncertainPose> SearchPlanner::BestWay(
    const SearchPair& pair) const {
  if (!pair.anchor.has_value()) return absl::nullopt;
  absl::optional<UncertainPose> best = paths_->Between(*pair.anchor, pair.node);
  const auto offer = [&](const LoopEdge& loop) {
    const absl::optional<UncertainPose> before =
        paths_->Between(*pair.anchor, loop.a);
    const absl::optional<UncertainPose> after =
        paths_->Between(loop.b, pair.node);
    if (!before.has_value() || !after.has_value()) return;
    const UncertainPose way = Compose(Compose(*before, loop.pose), *after);
    if (!best.has_value() ||
        way.covariance.topLeftCorner<2, 2>().trace() <
            best->covariance.topLeftCorner<2, 2>().trace()) {
      best = way;
    }
  };
  // Loops on both sides of the node: in a burst after a submap was finished the
  // nodes are old ones.
  const auto middle = accepted_loops_.lower_bound(pair.node);
  auto it = middle;
  for (int i = 0; i < kLoopsTried && it != accepted_loops_.begin(); ++i) {
    --it;
    if (it->first.trajectory_id != pair.node.trajectory_id) break;
    offer(it->second);
  }
  it = middle;
  for (int i = 0; i < kLoopsTried && it != accepted_loops_.end(); ++i, ++it) {
    if (it->first.trajectory_id != pair.node.trajectory_id) break;
    offer(it->second);
  }
  return best;
}

SearchPlan SearchPlanner::PlanAlone(const SearchPair& pair) const {
  SearchPlan plan;
  const double distance = pair.predicted.translation().norm();
  const absl::optional<UncertainPose> way = BestWay(pair);
  if (!way.has_value()) {
    plan.out_of_reach = distance > reach_;
    plan.linear_window = default_linear_window_;
    plan.angular_window = default_angular_window_;
  } else {
    plan.translation_sigma = WorstSigma(way->covariance);
    plan.rotation_sigma = std::sqrt(std::max(0., way->covariance(2, 2)));
    const double wanted = options_.window_sigmas() * plan.translation_sigma;
    plan.full_submap =
        wanted > options_.max_linear_window() && options_.global_search();
    plan.linear_window =
        std::min(std::max(wanted, options_.min_linear_window()),
                 options_.max_linear_window());
    plan.angular_window =
        std::min(kPi, std::max(options_.min_angular_window(),
                               options_.window_sigmas() * plan.rotation_sigma));
    plan.out_of_reach =
        distance > reach_ + (plan.full_submap ? wanted : plan.linear_window);
  }
  if (plan.out_of_reach) return plan;
  if (way.has_value() &&
      plan.translation_sigma < options_.informative_sigma()) {
    plan.skipped = LoopDecision::SKIPPED_UNINFORMATIVE;
    return plan;
  }
  const auto memory = submaps_.find(
      std::make_pair(pair.submap_trajectory_id, pair.submap_index));
  if (memory == submaps_.end()) return plan;
  if (HasNear(memory->second.accepted, pair.node,
              options_.redundant_distance())) {
    plan.skipped = LoopDecision::SKIPPED_REDUNDANT;
  } else if (plan.full_submap
                 ? HasNear(memory->second.searched_fully, pair.node,
                           options_.full_search_spacing())
                 : HasNear(memory->second.searched, pair.node,
                           options_.search_spacing())) {
    plan.skipped = LoopDecision::SKIPPED_SPACING;
  }
  return plan;
}

double SearchPlanner::Promise(const SearchPair& pair,
                              const SearchPlan& plan) const {
  const double sigma = std::max(plan.translation_sigma, 1e-3);
  const double gain = std::log1p(sigma / WorstSigma(loop_covariance_));
  const double beyond =
      std::max(0., pair.predicted.translation().norm() - 0.5 * reach_);
  const double scale = sigma + 0.25 * reach_;
  return gain * std::exp(-0.5 * beyond * beyond / (scale * scale));
}

std::vector<SearchPlan> SearchPlanner::Plan(
    const std::vector<SearchPair>& pairs) {
  std::vector<SearchPlan> plans(pairs.size());
  std::map<NodeKey, std::vector<size_t>, NodeLess> of_node;
  for (size_t i = 0; i < pairs.size(); ++i) {
    // One by one, since the searches of a burst space each other out.
    plans[i] = PlanAlone(pairs[i]);
    if (plans[i].out_of_reach || plans[i].skipped != LoopDecision::NONE) {
      continue;
    }
    of_node[pairs[i].node].push_back(i);
    SubmapMemory& memory = submaps_[std::make_pair(
        pairs[i].submap_trajectory_id, pairs[i].submap_index)];
    NodeSet& searched =
        plans[i].full_submap ? memory.searched_fully : memory.searched;
    searched.insert(pairs[i].node);
    if (searched.size() > kMaxNodesPerSubmap) searched.erase(searched.begin());
  }
  const size_t cap = static_cast<size_t>(options_.max_searches_per_node());
  for (auto& entry : of_node) {
    std::vector<size_t>& candidates = entry.second;
    std::vector<double> promise(candidates.size());
    std::vector<size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), 0);
    for (size_t k = 0; k < candidates.size(); ++k) {
      promise[k] = Promise(pairs[candidates[k]], plans[candidates[k]]);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](const size_t a, const size_t b) {
                       return promise[a] > promise[b];
                     });
    size_t num_full = 0;
    size_t num_taken = 0;
    for (size_t k = 0; k < order.size(); ++k) {
      const size_t i = candidates[order[k]];
      if (num_taken < cap &&
          (!plans[i].full_submap || num_full < kFullSearchesPerNode)) {
        ++num_taken;
        if (plans[i].full_submap) ++num_full;
        continue;
      }
      plans[i].skipped = LoopDecision::SKIPPED_BUDGET;
      // The next node may try.
      SubmapMemory& memory = submaps_[std::make_pair(
          pairs[i].submap_trajectory_id, pairs[i].submap_index)];
      (plans[i].full_submap ? memory.searched_fully : memory.searched)
          .erase(pairs[i].node);
    }
  }
  return plans;
}

void SearchPlanner::AddAcceptedLoop(const int submap_trajectory_id,
                                    const int submap_index,
                                    const LoopEdge& loop) {
  NodeSet& accepted =
      submaps_[std::make_pair(submap_trajectory_id, submap_index)].accepted;
  accepted.insert(loop.b);
  if (accepted.size() > kMaxNodesPerSubmap) accepted.erase(accepted.begin());
  accepted_loops_[loop.b] = loop;
  if (accepted_loops_.size() > kMaxLoops) {
    accepted_loops_.erase(accepted_loops_.begin());
  }
}

void SearchPlanner::DeleteSubmap(const int submap_trajectory_id,
                                 const int submap_index) {
  submaps_.erase(std::make_pair(submap_trajectory_id, submap_index));
}

}  // namespace loop_closure
}  // namespace cartographer_ext
