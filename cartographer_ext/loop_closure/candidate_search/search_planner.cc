// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/search_planner.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "cartographer_ext/common/squared.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;

// A whole submap costs about 25 windows.
constexpr size_t kFullSearchesPerNode = 6;
// Loops nearer than this to each other give the same paths, metres.
constexpr double kLoopSpacing = 3.;
// Standard deviations of a loop below which a path tells nearly as much.
constexpr double kTiedSigmas = 3.;
// Searched nodes remembered, oldest forgotten first.
constexpr size_t kMaxNodesPerSubmap = 20000;

// (anchor <- tracking frame of the node).
Pose2 HostPrediction(const uncertainty::PathUncertainty& paths,
                     const LoopCandidate& candidate) {
  const Pose2 in_submap = candidate.InTrackingFrame(candidate.SearchCenter());
  const absl::optional<Pose2> anchor_pose = paths.LocalPose(*candidate.anchor);
  return anchor_pose.has_value()
             ? Between(*anchor_pose, candidate.submap_local_pose) * in_submap
             : in_submap;
}

}  // namespace

void SetWindow(const SearchPlannerOptions& options,
               const Eigen::Matrix3d& covariance, SearchPlan* const plan) {
  plan->covariance = covariance;
  plan->translation_sigma = uncertainty::WorstTranslationSigma(covariance);
  plan->rotation_sigma = std::sqrt(std::max(0., covariance(2, 2)));
  plan->linear_window =
      std::max(options.window_sigmas * plan->translation_sigma,
               options.min_linear_window);
  plan->angular_window = std::max(options.min_angular_window,
                                  options.window_sigmas * plan->rotation_sigma);
}

Eigen::Matrix3d ExpectedCovariance(const SearchPlannerOptions& options,
                                   const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d expected = covariance;
  expected.diagonal().head<2>().array() +=
      Squared(options.min_linear_window / options.window_sigmas);
  expected(2, 2) += Squared(options.min_angular_window / options.window_sigmas);
  return expected;
}

Eigen::Matrix3d ExpectedCovariance(const SearchPlannerOptions& options,
                                   const SearchPlan& plan) {
  if (!plan.covariance.isZero(0.)) {
    return ExpectedCovariance(options, plan.covariance);
  }
  const double translation = plan.linear_window / options.window_sigmas;
  const double rotation = plan.angular_window / options.window_sigmas;
  return ExpectedCovariance(
      options, Eigen::Vector3d(Squared(translation), Squared(translation),
                               Squared(rotation))
                   .asDiagonal());
}

SearchPlanner::SearchPlanner(const SearchPlannerOptions& options,
                             const Eigen::Matrix3d& loop_covariance,
                             const double reach,
                             const double default_linear_window,
                             const double default_angular_window,
                             const uncertainty::PathUncertainty* const paths)
    : options_(options),
      loop_covariance_(loop_covariance),
      pass_limits_{options.redundant_distance, options.max_passes_per_place},
      reach_(reach),
      default_linear_window_(default_linear_window),
      default_angular_window_(default_angular_window),
      paths_(CHECK_NOTNULL(paths)),
      least_uncertain_paths_(kLoopSpacing, paths) {}

bool SearchPlanner::HasNear(const Nodes& nodes, const LoopCandidate& candidate,
                            const double distance,
                            const double duration) const {
  if (distance <= 0.) return false;
  const double ticks = 1e7 * duration;
  const auto near = [&](const Nodes::value_type& other) {
    if (std::abs(static_cast<double>(other.second - candidate.node_time)) >
        ticks) {
      return false;
    }
    const absl::optional<double> travelled =
        paths_->Travelled(other.first, candidate.node);
    return travelled.has_value() && *travelled < distance;
  };
  const auto after = nodes.lower_bound(candidate.node);
  if (after != nodes.end() && near(*after)) return true;
  return after != nodes.begin() && near(*std::prev(after));
}

bool SearchPlanner::PlanWindow(const LoopCandidate& candidate,
                               SearchPlan* const plan) {
  const double distance = candidate.SearchCenter().translation().norm();
  const absl::optional<uncertainty::UncertainPose> path =
      candidate.anchor.has_value()
          ? least_uncertain_paths_.Between(*candidate.anchor, candidate.node)
          : absl::nullopt;
  if (!path.has_value()) {
    plan->out_of_reach = distance > reach_;
    plan->linear_window = default_linear_window_;
    plan->angular_window = default_angular_window_;
    return false;
  }
  SetWindow(options_, path->covariance, plan);
  const double wanted = options_.window_sigmas * plan->translation_sigma;
  plan->full_submap =
      wanted > options_.max_linear_window && options_.global_search;
  // The host predicts without what was learnt of the drift.
  const Pose2 offset =
      paths_->drift_version() > 0
          ? Between(path->pose, HostPrediction(*paths_, candidate))
          : Pose2();
  plan->covariance.diagonal() +=
      Eigen::Vector3d(offset.x, offset.y, NormalizeAngle(offset.theta))
          .cwiseAbs2() /
      Squared(options_.window_sigmas);
  plan->linear_window =
      std::min(plan->linear_window + offset.translation().norm(),
               options_.max_linear_window);
  plan->angular_window = std::min(
      kPi, plan->angular_window + std::abs(NormalizeAngle(offset.theta)));
  plan->out_of_reach =
      distance > reach_ + (plan->full_submap ? wanted : plan->linear_window);
  return true;
}

bool SearchPlanner::IsRedundant(const LoopCandidate& candidate) const {
  const auto memory = submaps_.find(candidate.submap);
  return memory != submaps_.end() &&
         HasNear(memory->second.accepted, candidate,
                 options_.redundant_distance, options_.redundant_time);
}

SearchPlan SearchPlanner::PlanAlone(const LoopCandidate& candidate) {
  SearchPlan plan;
  // First what costs little: most candidates end here.
  if (IsRedundant(candidate)) {
    plan.skipped = LoopDecision::SKIPPED_REDUNDANT;
    return plan;
  }
  const auto found = submaps_.find(candidate.submap);
  const SubmapMemory* const memory =
      found == submaps_.end() ? nullptr : &found->second;
  const bool near_searched =
      memory != nullptr &&
      HasNear(memory->searched, candidate, options_.search_spacing,
              options_.redundant_time);
  // Searching whole submaps from a stationary robot would cost too much, so
  // that time does not count.
  const bool near_searched_fully =
      memory != nullptr &&
      HasNear(memory->searched_fully, candidate, options_.full_search_spacing,
              std::numeric_limits<double>::infinity());
  if (near_searched && (near_searched_fully || !options_.global_search)) {
    plan.skipped = LoopDecision::SKIPPED_SPACING;
    return plan;
  }
  const bool is_certain = PlanWindow(candidate, &plan) &&
                          plan.translation_sigma < options_.informative_sigma;
  if (plan.out_of_reach) return plan;
  if (is_certain) {
    plan.skipped = LoopDecision::SKIPPED_UNINFORMATIVE;
  } else if (plan.full_submap ? near_searched_fully : near_searched) {
    plan.skipped = LoopDecision::SKIPPED_SPACING;
  } else if (IsTied(candidate, plan)) {
    plan.skipped = LoopDecision::SKIPPED_UNINFORMATIVE;
  }
  return plan;
}

bool SearchPlanner::HasEnoughPasses(const SubmapMemory& memory,
                                    const LoopCandidate& candidate) const {
  return candidate.predicted.has_value() &&
         memory.passes.Count(*candidate.predicted) >= pass_limits_.most;
}

bool SearchPlanner::IsTied(const LoopCandidate& candidate,
                           const SearchPlan& plan) const {
  if (plan.full_submap || plan.translation_sigma <= 0. ||
      plan.translation_sigma >= options_.saturated_sigma) {
    return false;
  }
  const auto planned = planned_passes_.find(candidate.submap);
  if (planned != planned_passes_.end() &&
      !planned->second.Takes(candidate.node, candidate.SearchCenter(),
                             pass_limits_, *paths_)) {
    return true;
  }
  if (plan.translation_sigma >=
      kTiedSigmas * uncertainty::WorstTranslationSigma(loop_covariance_)) {
    return false;
  }
  const auto memory = submaps_.find(candidate.submap);
  return memory != submaps_.end() && HasEnoughPasses(memory->second, candidate);
}

bool SearchPlanner::IsSaturated(const LoopCandidate& candidate) const {
  const auto memory = submaps_.find(candidate.submap);
  return memory != submaps_.end() &&
         (memory->second.accepted.size() >=
              static_cast<size_t>(options_.saturating_loops) ||
          HasEnoughPasses(memory->second, candidate));
}

bool SearchPlanner::IsEnoughFor(const LoopCandidate& candidate,
                                const SearchPlan& plan) {
  if (plan.out_of_reach) return false;
  if (plan.skipped == LoopDecision::SKIPPED_REDUNDANT) return true;
  SearchPlan window = plan;
  // Not planned where the submap was searched a moment ago.
  if (window.translation_sigma <= 0. && !PlanWindow(candidate, &window)) {
    return plan.is_searched();
  }
  return window.translation_sigma < options_.saturated_sigma;
}

double SearchPlanner::Promise(const LoopCandidate& candidate,
                              const SearchPlan& plan) const {
  const double sigma = std::max(plan.translation_sigma, 1e-3);
  const double gain =
      std::log1p(sigma / uncertainty::WorstTranslationSigma(loop_covariance_));
  const double beyond = std::max(
      0., candidate.SearchCenter().translation().norm() - 0.5 * reach_);
  const double scale = sigma + 0.25 * reach_;
  return gain * std::exp(-0.5 * beyond * beyond / (scale * scale));
}

void SearchPlanner::ApplyCap(
    const std::vector<const LoopCandidate*>& candidates,
    const std::vector<size_t>& of_node, std::vector<SearchPlan>* const plans) {
  std::vector<size_t> indices;
  for (const size_t i : of_node) {
    if ((*plans)[i].is_searched()) indices.push_back(i);
  }
  const size_t cap = static_cast<size_t>(options_.max_searches_per_node);
  std::vector<double> promise(indices.size());
  std::vector<size_t> order(indices.size());
  std::iota(order.begin(), order.end(), 0);
  for (size_t k = 0; k < indices.size(); ++k) {
    promise[k] = Promise(*candidates[indices[k]], (*plans)[indices[k]]);
  }
  std::stable_sort(
      order.begin(), order.end(),
      [&](const size_t a, const size_t b) { return promise[a] > promise[b]; });
  size_t num_searched = 0;
  size_t num_searched_fully = 0;
  for (const size_t k : order) {
    const LoopCandidate& candidate = *candidates[indices[k]];
    SearchPlan& plan = (*plans)[indices[k]];
    if (num_searched < cap &&
        (!plan.full_submap || num_searched_fully < kFullSearchesPerNode) &&
        credit_.Pay(plan)) {
      ++num_searched;
      if (plan.full_submap) ++num_searched_fully;
      continue;
    }
    plan.skipped = LoopDecision::SKIPPED_BUDGET;
    // The next node may try.
    submaps_[candidate.submap].Searched(plan)->erase(candidate.node);
  }
}

void SearchPlanner::Remember(const uncertainty::VertexId& node,
                             const int64_t time, Nodes* const nodes) {
  nodes->emplace(node, time);
  if (nodes->size() > kMaxNodesPerSubmap) nodes->erase(nodes->begin());
}

void SearchPlanner::PlanAndNote(const LoopCandidate& candidate,
                                SearchPlan* const plan) {
  *plan = PlanAlone(candidate);
  if (!plan->is_searched()) return;
  Remember(candidate.node, candidate.node_time,
           submaps_[candidate.submap].Searched(*plan));
  planned_passes_[candidate.submap].Add(
      candidate.node, candidate.SearchCenter(), pass_limits_, *paths_);
}

void SearchPlanner::PlanNode(
    const std::vector<const LoopCandidate*>& candidates,
    const std::vector<size_t>& indices, std::vector<SearchPlan>* const plans) {
  // With their distances, nearest first.
  std::vector<std::pair<double, size_t>> saturated;
  for (const size_t i : indices) {
    if (IsSaturated(*candidates[i])) {
      saturated.emplace_back(candidates[i]->SearchCenter().translation().norm(),
                             i);
    } else {
      PlanAndNote(*candidates[i], &(*plans)[i]);
    }
  }
  std::sort(saturated.begin(), saturated.end());
  int num_searched = 0;
  bool is_recorded = false;
  for (const auto& entry : saturated) {
    SearchPlan& plan = (*plans)[entry.second];
    if (num_searched < options_.max_saturated_searches_per_node) {
      PlanAndNote(*candidates[entry.second], &plan);
      if (IsEnoughFor(*candidates[entry.second], plan)) ++num_searched;
      continue;
    }
    // One record for all, or the records would grow with every visit.
    plan.skipped = LoopDecision::SKIPPED_UNINFORMATIVE;
    plan.out_of_reach = is_recorded || entry.first > reach_;
    is_recorded = is_recorded || !plan.out_of_reach;
  }
}

std::vector<SearchPlan> SearchPlanner::Plan(
    const std::vector<const LoopCandidate*>& candidates) {
  std::map<uncertainty::NodeId, std::vector<size_t>> of_node;
  for (size_t i = 0; i < candidates.size(); ++i) {
    EarnCredit(candidates[i]->node);
    of_node[candidates[i]->node].push_back(i);
  }
  std::vector<SearchPlan> plans(candidates.size());
  planned_passes_.clear();
  // One by one, since the searches of a burst space each other out.
  for (const auto& entry : of_node) PlanNode(candidates, entry.second, &plans);
  for (const auto& entry : of_node) {
    ApplyCap(candidates, entry.second, &plans);
    for (const size_t i : entry.second) {
      plans[i].num_places = static_cast<int>(entry.second.size());
    }
  }
  return plans;
}

void SearchPlanner::EarnCredit(const uncertainty::NodeId& node) {
  const absl::optional<uncertainty::NodeId> last =
      credit_.NewestNode(node.trajectory_id);
  const absl::optional<double> travelled =
      last.has_value() ? paths_->Travelled(*last, node) : absl::nullopt;
  credit_.AddNode(node, travelled.value_or(0.));
}

void SearchPlanner::RemoveAcceptedLoop(const uncertainty::VertexId& anchor,
                                       const uncertainty::NodeId& node) {
  const uncertainty::VertexId end = node;
  least_uncertain_paths_.RemoveIf([&](const uncertainty::LoopEdge& loop) {
    return loop.a == anchor && loop.b == end;
  });
}

void SearchPlanner::AddAcceptedLoop(const LoopCandidate& candidate,
                                    const uncertainty::LoopEdge& loop) {
  credit_.Reward(candidate.plan);
  SubmapMemory& memory = submaps_[candidate.submap];
  Remember(loop.b, candidate.node_time, &memory.accepted);
  memory.passes.Add(loop.b, candidate.match.refined, pass_limits_, *paths_);
  least_uncertain_paths_.Add(loop);
}

void SearchPlanner::ForgetLoops(const int trajectory_id,
                                const int submap_trajectory_id,
                                const int last_node_index) {
  const auto is_old = [&](const uncertainty::VertexId& node) {
    return node.IsNodeOf(trajectory_id) && node.index() <= last_node_index;
  };
  // Between trajectories the anchor is the submap itself.
  least_uncertain_paths_.RemoveIf([&](const uncertainty::LoopEdge& loop) {
    return is_old(loop.b) && loop.a.IsSubmapOf(submap_trajectory_id);
  });
  for (auto& submap : submaps_) {
    if (submap.first.trajectory_id != submap_trajectory_id) continue;
    submap.second.passes.Forget(trajectory_id, last_node_index);
    Nodes& accepted = submap.second.accepted;
    for (auto it = accepted.begin(); it != accepted.end();) {
      it = is_old(it->first) ? accepted.erase(it) : std::next(it);
    }
  }
}

void SearchPlanner::DeleteSubmap(const uncertainty::SubmapId& submap) {
  submaps_.erase(submap);
}

void SearchPlanner::DeleteTrajectory(const int trajectory_id) {
  least_uncertain_paths_.RemoveIf([&](const uncertainty::LoopEdge& loop) {
    return loop.a.trajectory_id() == trajectory_id ||
           loop.b.trajectory_id() == trajectory_id;
  });
}

}  // namespace loop_closure
}  // namespace cartographer_ext
