// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/pair_planner.h"

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>

#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/uncertainty/least_uncertain_paths.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::constraints::proto::ConstraintBuilderOptions;
using proto::LoopDecision;

}  // namespace

PairPlanner::PairPlanner(const ConstraintBuilderOptions& options,
                         const LoopOptions& extension,
                         const uncertainty::PathUncertainty* const paths)
    : options_(options),
      extension_(extension),
      search_planner_(extension.search, LoopCovariance(extension),
                      options.max_constraint_distance(),
                      options.fast_correlative_scan_matcher_options()
                          .linear_search_window(),
                      options.fast_correlative_scan_matcher_options()
                          .angular_search_window(),
                      paths),
      localization_(extension.relocalization.map, paths) {}

SearchPlan PairPlanner::PlanLikeStock(const LoopCandidate& candidate) {
  SearchPlan plan;
  const auto& window = options_.fast_correlative_scan_matcher_options();
  plan.linear_window = window.linear_search_window();
  plan.angular_window = window.angular_search_window();
  plan.out_of_reach = candidate.SearchCenter().translation().norm() >
                      options_.max_constraint_distance();
  if (plan.out_of_reach) return plan;
  auto* const sampler =
      &samplers_
           .emplace(std::piecewise_construct,
                    std::forward_as_tuple(candidate.submap),
                    std::forward_as_tuple(options_.sampling_ratio()))
           .first->second;
  if (!sampler->Pulse()) plan.skipped = LoopDecision::SKIPPED_SAMPLER;
  return plan;
}

void PairPlanner::PlanQuery(const std::vector<size_t>& group,
                            Session* const session) {
  const std::vector<LoopCandidate>& proposed = session->proposed;
  std::set<int> indices;
  for (const size_t i : group) indices.insert(proposed[i].submap.submap_index);
  const int64_t query = num_queries_++;
  std::vector<size_t> order;
  for (const size_t i : group) {
    const int index = proposed[i].submap.submap_index;
    const bool is_covered = index % 2 == 1 && indices.count(index - 1) > 0 &&
                            indices.count(index + 1) > 0;
    if (!is_covered) {
      order.push_back(i);
      continue;
    }
    Planned followed;
    followed.proposed = i;
    followed.plan.full_submap = true;
    followed.plan.skipped = LoopDecision::SKIPPED_REDUNDANT;
    followed.plan.query = query;
    session->planned.push_back(followed);
  }
  // Those first that have waited longest.
  std::stable_sort(order.begin(), order.end(),
                   [&](const size_t a, const size_t b) {
                     return last_queries_[proposed[a].submap] <
                            last_queries_[proposed[b].submap];
                   });
  const size_t cap =
      static_cast<size_t>(extension_.relocalization.max_submaps_per_query);
  for (size_t k = 0; k < order.size(); ++k) {
    Planned searched;
    searched.proposed = order[k];
    searched.plan.full_submap = true;
    if (k < cap) {
      searched.plan.query = query;
      last_queries_[proposed[order[k]].submap] = query + 1;
    } else {
      searched.plan.skipped = LoopDecision::SKIPPED_BUDGET;
    }
    session->planned.push_back(searched);
  }
}

void PairPlanner::PlanInterTrajectory(const std::vector<size_t>& group,
                                      Session* const session) {
  const LoopCandidate& first = session->proposed[group.front()];
  const int map_id = first.submap.trajectory_id;
  const uncertainty::NodeId node = first.node;
  const auto skip = [session](const size_t i,
                              const LoopDecision::Reason reason) {
    Planned skipped;
    skipped.proposed = i;
    skipped.plan.skipped = reason;
    session->planned.push_back(skipped);
  };
  if (live_trajectories_.count(node.trajectory_id) == 0) {
    for (const size_t i : group) skip(i, LoopDecision::SKIPPED_LOADED);
    return;
  }
  const MapLocalization::Plan plan =
      localization_.PlanNode(node, map_id, first.predicted.has_value());
  if (plan.newly_lost) {
    LostPlace place;
    place.trajectory_id = node.trajectory_id;
    place.map_trajectory_id = map_id;
    place.by_decisions = plan.by_decisions;
    place.last_node_index =
        localization_.LastNodeBeforeLost(node.trajectory_id, map_id);
    search_planner_.ForgetLoops(node.trajectory_id, map_id,
                                place.last_node_index);
    session->lost->push_back(place);
  }
  for (const size_t i : group) {
    if (plan.around_prediction) {
      session->around.push_back(i);
    } else if (!plan.everywhere) {
      skip(i, LoopDecision::SKIPPED_SPACING);
    }
  }
  if (plan.everywhere) PlanQuery(group, session);
}

void PairPlanner::PlanAroundPredictions(Session* const session) {
  std::vector<size_t>& around = session->around;
  std::sort(around.begin(), around.end());
  std::vector<SearchPlan> plans;
  if (extension_.search.enabled) {
    std::vector<const LoopCandidate*> candidates;
    for (const size_t i : around) candidates.push_back(&session->proposed[i]);
    plans = search_planner_.Plan(candidates);
  } else {
    for (const size_t i : around) {
      plans.push_back(PlanLikeStock(session->proposed[i]));
    }
  }
  for (size_t k = 0; k < plans.size(); ++k) {
    Planned planned;
    planned.proposed = around[k];
    planned.plan = plans[k];
    session->planned.push_back(planned);
  }
}

std::vector<LoopCandidate> PairPlanner::Plan(
    const std::vector<LoopCandidate>& proposed,
    std::vector<LostPlace>* const lost) {
  if (proposed.empty()) return {};
  live_trajectories_.insert(proposed.front().node.trajectory_id);
  Session session{proposed, {}, {}, lost};
  // By node and trajectory of the submap.
  std::map<std::pair<uncertainty::NodeId, int>, std::vector<size_t>>
      inter_trajectory;
  for (size_t i = 0; i < proposed.size(); ++i) {
    const LoopCandidate& candidate = proposed[i];
    if (extension_.relocalization.enabled && candidate.is_inter_trajectory()) {
      inter_trajectory[std::make_pair(candidate.node,
                                      candidate.submap.trajectory_id)]
          .push_back(i);
    } else if (!candidate.predicted.has_value()) {
      Planned whole;
      whole.proposed = i;
      whole.plan.full_submap = true;
      session.planned.push_back(whole);
    } else {
      session.around.push_back(i);
    }
  }
  for (const auto& group : inter_trajectory) {
    PlanInterTrajectory(group.second, &session);
  }
  PlanAroundPredictions(&session);
  // In the order of the proposals.
  std::stable_sort(session.planned.begin(), session.planned.end(),
                   [](const Planned& a, const Planned& b) {
                     return a.proposed < b.proposed;
                   });
  std::vector<LoopCandidate> candidates;
  candidates.reserve(session.planned.size());
  for (const Planned& planned : session.planned) {
    candidates.push_back(proposed[planned.proposed]);
    candidates.back().plan = planned.plan;
  }
  return candidates;
}

loop_closure::PathBetween PairPlanner::PathsWithout(
    const LoopEnds& ends) const {
  const auto paths = std::make_shared<uncertainty::LeastUncertainPaths>(
      search_planner_.PathsWithout([&](const uncertainty::LoopEdge& loop) {
        return ends.count(std::make_pair(loop.a, loop.b)) != 0;
      }));
  return
      [paths](const uncertainty::VertexId& a, const uncertainty::VertexId& b) {
        return paths->Between(a, b);
      };
}

bool PairPlanner::AddAcceptedLoop(
    const LoopCandidate& accepted,
    const absl::optional<uncertainty::LoopEdge>& loop) {
  if (loop.has_value()) {
    search_planner_.AddAcceptedLoop(accepted, *loop);
  }
  return accepted.is_inter_trajectory() &&
         localization_.AddAcceptedLoop(accepted.node,
                                       accepted.submap.trajectory_id);
}

void PairPlanner::DeleteSubmap(const uncertainty::SubmapId& submap) {
  search_planner_.DeleteSubmap(submap);
  samplers_.erase(submap);
  last_queries_.erase(submap);
}

void PairPlanner::DeleteTrajectory(const int trajectory_id) {
  search_planner_.DeleteTrajectory(trajectory_id);
  localization_.DeleteTrajectory(trajectory_id);
  live_trajectories_.erase(trajectory_id);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
