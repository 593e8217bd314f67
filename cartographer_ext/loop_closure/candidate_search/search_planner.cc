// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/search_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;

// A whole submap costs a hundred windows.
constexpr size_t kFullSearchesPerNode = 1;
// Loops nearer than this to each other give the same paths, metres.
constexpr double kLoopSpacing = 3.;
// A saturated submap gives way to the others after this many searches without
// an accepted loop. Loops are accepted in rounds, within which there are a dozen
// of searches.
constexpr size_t kPatience = 24;
// A new submap meets the nodes of all earlier visits at once. Of those that are
// not known to be out of its reach so many are considered for each loop that it
// needs, the oldest first.
constexpr size_t kOlderNodes = 10;

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

SearchPlanner::SearchPlanner(const SearchPlannerOptions& options,
                             const Eigen::Matrix3d& loop_covariance,
                             const double reach,
                             const double default_linear_window,
                             const double default_angular_window,
                             const uncertainty::PathUncertainty* const paths)
    : options_(options),
      loop_covariance_(loop_covariance),
      reach_(reach),
      default_linear_window_(default_linear_window),
      default_angular_window_(default_angular_window),
      paths_(CHECK_NOTNULL(paths)),
      least_uncertain_paths_(kLoopSpacing, paths) {}

absl::optional<uncertainty::UncertainPose> SearchPlanner::PathOf(
    const LoopCandidate& candidate, const Root root) {
  if (!candidate.anchor.has_value()) return absl::nullopt;
  if (root == Root::kAnchor) {
    return least_uncertain_paths_.Between(*candidate.anchor, candidate.node);
  }
  const absl::optional<uncertainty::UncertainPose> path =
      least_uncertain_paths_.Between(candidate.node, *candidate.anchor);
  if (!path.has_value()) return absl::nullopt;
  return Invert(*path);
}

bool SearchPlanner::PlanWindow(const LoopCandidate& candidate, const Root root,
                               SearchPlan* const plan) {
  const double distance = candidate.SearchCenter().translation().norm();
  const absl::optional<uncertainty::UncertainPose> path =
      PathOf(candidate, root);
  if (!path.has_value()) {
    plan->out_of_reach = distance > reach_;
    plan->linear_window = default_linear_window_;
    plan->angular_window = default_angular_window_;
    return false;
  }
  plan->translation_sigma =
      uncertainty::WorstTranslationSigma(path->covariance);
  plan->rotation_sigma = std::sqrt(std::max(0., path->covariance(2, 2)));
  const double wanted = options_.window_sigmas * plan->translation_sigma;
  plan->full_submap =
      wanted > options_.max_linear_window && options_.global_search;
  // The host predicts without what was learnt of the drift.
  const Pose2 offset =
      paths_->drift_version() > 0
          ? Between(path->pose, HostPrediction(*paths_, candidate))
          : Pose2();
  plan->linear_window = std::min(std::max(wanted, options_.min_linear_window) +
                                     offset.translation().norm(),
                                 options_.max_linear_window);
  plan->angular_window =
      std::min(kPi, std::max(options_.min_angular_window,
                             options_.window_sigmas * plan->rotation_sigma) +
                        std::abs(NormalizeAngle(offset.theta)));
  const double limit =
      reach_ + (plan->full_submap ? wanted : plan->linear_window);
  plan->out_of_reach = distance > limit;
  if (plan->out_of_reach) {
    FarNode far;
    far.node = candidate.node;
    far.limit = limit;
    far.growth = std::max(1., options_.window_sigmas * plan->rotation_sigma);
    far.drift_version = paths_->drift_version();
    submaps_[candidate.submap].far = far;
  }
  return true;
}

SearchPlan SearchPlanner::PlanAlone(const LoopCandidate& candidate,
                                    const Root root) {
  SearchPlan plan;
  // First what costs little: most candidates end here.
  const auto found = submaps_.find(candidate.submap);
  const SearchMemory* const memory =
      found == submaps_.end() ? nullptr : &found->second;
  if (memory != nullptr &&
      HasNear(memory->accepted, candidate, options_.redundant_distance,
              options_.redundant_time)) {
    plan.skipped = LoopDecision::SKIPPED_REDUNDANT;
    return plan;
  }
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
  const bool is_certain = PlanWindow(candidate, root, &plan) &&
                          plan.translation_sigma < options_.informative_sigma;
  if (plan.out_of_reach) return plan;
  if (is_certain) {
    plan.skipped = LoopDecision::SKIPPED_UNINFORMATIVE;
  } else if (plan.full_submap ? near_searched_fully : near_searched) {
    plan.skipped = LoopDecision::SKIPPED_SPACING;
  }
  return plan;
}

bool SearchPlanner::IsSaturated(const uncertainty::SubmapId& submap) const {
  const auto found = submaps_.find(submap);
  return found != submaps_.end() &&
         found->second.accepted.size() >=
             static_cast<size_t>(options_.saturating_loops);
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
    submaps_[candidate.submap]
        .Searched(plan.full_submap)
        ->Erase(candidate.node);
  }
}

void SearchPlanner::PlanAndNote(const LoopCandidate& candidate, const Root root,
                                SearchPlan* const plan) {
  *plan = PlanAlone(candidate, root);
  if (!plan->is_searched()) return;
  SearchMemory& memory = submaps_[candidate.submap];
  memory.Searched(plan->full_submap)->Add(candidate.node, candidate.node_time);
  ++memory.num_unanswered;
}

void SearchPlanner::PlanNode(
    const std::vector<const LoopCandidate*>& candidates,
    const std::vector<size_t>& indices, std::vector<SearchPlan>* const plans) {
  std::map<int, std::vector<size_t>> saturated;  // by trajectory
  const Root root = indices.size() > 1 ? Root::kNode : Root::kAnchor;
  for (const size_t i : indices) {
    if (IsSaturated(candidates[i]->submap)) {
      saturated[candidates[i]->submap.trajectory_id].push_back(i);
    } else {
      PlanAndNote(*candidates[i], root, &(*plans)[i]);
    }
  }
  for (auto& entry : saturated) {
    PlanSaturated(candidates, std::move(entry.second), plans);
  }
}

void SearchPlanner::PlanSaturated(
    const std::vector<const LoopCandidate*>& candidates,
    std::vector<size_t> indices, std::vector<SearchPlan>* const plans) {
  // The patience with it, whether there is a path, how near it is, how old.
  const auto order_of = [&](const size_t i) {
    const LoopCandidate& candidate = *candidates[i];
    const double distance = candidate.SearchCenter().translation().norm();
    return std::make_tuple(
        submaps_[candidate.submap].num_unanswered / kPatience,
        !candidate.anchor.has_value(), std::floor(4. * distance / reach_),
        candidate.submap);
  };
  std::sort(indices.begin(), indices.end(),
            [&](const size_t a, const size_t b) {
              return order_of(a) < order_of(b);
            });
  const LoopCandidate& first = *candidates[indices.front()];
  SearchMemory& group = saturated_[first.submap.trajectory_id];
  bool is_tied =
      IsTied(first.submap.trajectory_id, first.node, first.node_time);
  bool is_recorded = false;
  for (const size_t i : indices) {
    const LoopCandidate& candidate = *candidates[i];
    SearchPlan& plan = (*plans)[i];
    if (!is_tied) {
      PlanAndNote(candidate, Root::kNode, &plan);
      // Without a path the uncertainty is not known.
      if (plan.out_of_reach || plan.translation_sigma <= 0. ||
          plan.translation_sigma >= options_.saturated_sigma) {
        continue;
      }
      is_tied = true;
      if (plan.is_searched()) {
        group.searched.Add(candidate.node, candidate.node_time);
      }
      continue;
    }
    // One record for all, or the records would grow with every visit.
    plan.skipped = LoopDecision::SKIPPED_UNINFORMATIVE;
    plan.out_of_reach =
        is_recorded || candidate.SearchCenter().translation().norm() > reach_;
    is_recorded = is_recorded || !plan.out_of_reach;
  }
}

bool SearchPlanner::IsTied(const int submap_trajectory_id,
                           const uncertainty::NodeId& node,
                           const int64_t node_time) const {
  const auto found = saturated_.find(submap_trajectory_id);
  if (found == saturated_.end()) return false;
  const auto has_near = [&](const RememberedNodes& nodes) {
    return nodes.HasNear(*paths_, node, node_time, options_.search_spacing,
                         options_.redundant_time);
  };
  return has_near(found->second.accepted) || has_near(found->second.searched);
}

bool SearchPlanner::CanIgnore(
    const uncertainty::SubmapId& submap,
    const absl::optional<uncertainty::VertexId>& anchor,
    const uncertainty::NodeId& node, const int64_t node_time,
    const double distance) {
  if (submap.trajectory_id == node.trajectory_id) {
    // A node whose path is forgotten has been tied, or never will be.
    if (!paths_->LocalPose(node).has_value()) return true;
    if (!anchor.has_value() && distance > reach_) return true;
  }
  SearchMemory& memory = submaps_[submap];
  if (IsStillFar(memory.far, *paths_, node, distance)) return true;
  if (anchor.has_value() && anchor->IsNodeOf(node.trajectory_id) &&
      node.node_index < anchor->index() &&
      ++memory.num_older_nodes >
          kOlderNodes * static_cast<size_t>(options_.saturating_loops)) {
    return true;
  }
  if (!IsSaturated(submap)) return false;
  if (last_tied_.submap_trajectory_id != submap.trajectory_id ||
      last_tied_.node != node) {
    last_tied_.submap_trajectory_id = submap.trajectory_id;
    last_tied_.node = node;
    last_tied_.is_tied = IsTied(submap.trajectory_id, node, node_time);
  }
  return last_tied_.is_tied;
}

std::vector<SearchPlan> SearchPlanner::Plan(
    const std::vector<const LoopCandidate*>& candidates) {
  std::map<uncertainty::NodeId, std::vector<size_t>> of_node;
  for (size_t i = 0; i < candidates.size(); ++i) {
    credit_.AddNode(candidates[i]->node);
    of_node[candidates[i]->node].push_back(i);
  }
  last_tied_.submap_trajectory_id = -1;
  std::vector<SearchPlan> plans(candidates.size());
  // One by one, since the searches of a burst space each other out.
  for (const auto& entry : of_node) PlanNode(candidates, entry.second, &plans);
  for (const auto& entry : of_node) ApplyCap(candidates, entry.second, &plans);
  return plans;
}

void SearchPlanner::AddAcceptedLoop(const LoopCandidate& candidate,
                                    const uncertainty::LoopEdge& loop) {
  credit_.Reward(candidate.plan);
  last_tied_.submap_trajectory_id = -1;
  SearchMemory& memory = submaps_[candidate.submap];
  const uncertainty::NodeId node{loop.b.trajectory_id(), loop.b.index()};
  if (IsSaturated(candidate.submap)) {
    saturated_[candidate.submap.trajectory_id].accepted.Add(
        node, candidate.node_time);
  }
  memory.accepted.Add(node, candidate.node_time);
  memory.num_unanswered = 0;
  least_uncertain_paths_.Add(loop);
}

void SearchPlanner::ForgetLoops(const int trajectory_id,
                                const int submap_trajectory_id,
                                const int last_node_index) {
  // Between trajectories the anchor is the submap itself.
  least_uncertain_paths_.RemoveIf([&](const uncertainty::LoopEdge& loop) {
    return loop.b.IsNodeOf(trajectory_id) &&
           loop.b.index() <= last_node_index &&
           loop.a.IsSubmapOf(submap_trajectory_id);
  });
  for (auto& submap : submaps_) {
    submap.second.far.reset();
    if (submap.first.trajectory_id != submap_trajectory_id) continue;
    submap.second.accepted.EraseUpTo(trajectory_id, last_node_index);
  }
  saturated_[submap_trajectory_id].accepted.EraseUpTo(trajectory_id,
                                                      last_node_index);
}

void SearchPlanner::DeleteSubmap(const uncertainty::SubmapId& submap) {
  submaps_.erase(submap);
}

void SearchPlanner::DeleteTrajectory(const int trajectory_id) {
  least_uncertain_paths_.RemoveIf([&](const uncertainty::LoopEdge& loop) {
    return loop.a.trajectory_id() == trajectory_id ||
           loop.b.trajectory_id() == trajectory_id;
  });
  for (auto& submap : submaps_) submap.second.far.reset();
  saturated_.erase(trajectory_id);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
