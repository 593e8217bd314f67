// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/pair_planner.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "cartographer/common/time.h"
#include "cartographer_ext/loop_closure/dropin/node_geometry.h"
#include "cartographer_ext/loop_closure/loop_options.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::NodeId;
using cartographer::mapping::constraints::proto::ConstraintBuilderOptions;
using proto::LoopDecision;

SearchPair MakeSearchPair(const OfferedPair& pair) {
  SearchPair search;
  search.submap_trajectory_id = pair.submap_id.trajectory_id;
  search.submap_index = pair.submap_id.submap_index;
  search.anchor = pair.anchor;
  search.node = ToKey(pair.node_id);
  search.node_time = cartographer::common::ToUniversal(pair.node->time);
  search.predicted = pair.predicted;
  return search;
}

void Skip(const std::vector<size_t>& group, const LoopDecision::Reason reason,
          std::vector<PlannedPair>* const planned) {
  for (const size_t i : group) {
    PlannedPair skipped;
    skipped.pair = i;
    skipped.plan.skipped = reason;
    planned->push_back(skipped);
  }
}

}  // namespace

PairPlanner::PairPlanner(const ConstraintBuilderOptions& options,
                         const proto::LoopClosureOptions& extension,
                         const uncertainty::PathUncertainty* const paths)
    : options_(options),
      extension_(extension),
      search_planner_(extension.search(), LoopCovariance(extension),
                      options.max_constraint_distance(),
                      options.fast_correlative_scan_matcher_options()
                          .linear_search_window(),
                      options.fast_correlative_scan_matcher_options()
                          .angular_search_window(),
                      paths),
      localization_(ToMapLocalizationOptions(extension), paths) {}

SearchPlan PairPlanner::PlanLikeStock(const OfferedPair& pair) {
  SearchPlan plan;
  const auto& window = options_.fast_correlative_scan_matcher_options();
  plan.linear_window = window.linear_search_window();
  plan.angular_window = window.angular_search_window();
  plan.out_of_reach =
      pair.predicted.translation().norm() > options_.max_constraint_distance();
  if (plan.out_of_reach) return plan;
  auto* const sampler =
      &samplers_
           .emplace(std::piecewise_construct,
                    std::forward_as_tuple(pair.submap_id),
                    std::forward_as_tuple(options_.sampling_ratio()))
           .first->second;
  if (!sampler->Pulse()) plan.skipped = LoopDecision::SKIPPED_SAMPLER;
  return plan;
}

void PairPlanner::PlanQuery(const std::vector<OfferedPair>& pairs,
                            const std::vector<size_t>& group,
                            std::vector<PlannedPair>* const planned) {
  std::set<int> indices;
  for (const size_t i : group) indices.insert(pairs[i].submap_id.submap_index);
  const int64_t query = num_queries_++;
  std::vector<size_t> order;
  for (const size_t i : group) {
    const int index = pairs[i].submap_id.submap_index;
    const bool covered = index % 2 == 1 && indices.count(index - 1) > 0 &&
                         indices.count(index + 1) > 0;
    if (!covered) {
      order.push_back(i);
      continue;
    }
    PlannedPair followed;
    followed.pair = i;
    followed.plan.full_submap = true;
    followed.plan.skipped = LoopDecision::SKIPPED_REDUNDANT;
    followed.query = query;
    planned->push_back(followed);
  }
  // Those first that have waited longest.
  std::stable_sort(order.begin(), order.end(),
                   [&](const size_t a, const size_t b) {
                     return last_queries_[pairs[a].submap_id] <
                            last_queries_[pairs[b].submap_id];
                   });
  const size_t cap =
      static_cast<size_t>(extension_.localization().max_submaps_per_query());
  for (size_t k = 0; k < order.size(); ++k) {
    PlannedPair searched;
    searched.pair = order[k];
    searched.plan.full_submap = true;
    if (k < cap) {
      searched.query = query;
      last_queries_[pairs[order[k]].submap_id] = query + 1;
    } else {
      searched.plan.skipped = LoopDecision::SKIPPED_BUDGET;
    }
    planned->push_back(searched);
  }
}

void PairPlanner::PlanForeign(const std::vector<OfferedPair>& pairs,
                              const std::vector<size_t>& group,
                              std::vector<PlannedPair>* const planned,
                              std::vector<size_t>* const around,
                              std::vector<LostPlace>* const lost) {
  const OfferedPair& first = pairs[group.front()];
  const int map_id = first.submap_id.trajectory_id;
  const uncertainty::NodeId node = ToKey(first.node_id);
  if (live_trajectories_.count(node.trajectory_id) == 0) {
    Skip(group, LoopDecision::SKIPPED_LOADED, planned);
    return;
  }
  const MapLocalization::Plan plan =
      localization_.PlanNode(node, map_id, !first.is_global);
  if (plan.newly_lost) {
    LostPlace place;
    place.trajectory_id = node.trajectory_id;
    place.map_trajectory_id = map_id;
    place.by_decisions = plan.by_decisions;
    place.last_node_index =
        localization_.LastNodeBeforeLost(node.trajectory_id, map_id);
    search_planner_.ForgetLoops(node.trajectory_id, map_id,
                                place.last_node_index);
    lost->push_back(place);
  }
  if (plan.around_prediction) {
    around->insert(around->end(), group.begin(), group.end());
  }
  if (plan.everywhere) {
    PlanQuery(pairs, group, planned);
  } else if (!plan.around_prediction) {
    Skip(group, LoopDecision::SKIPPED_SPACING, planned);
  }
}

std::vector<PlannedPair> PairPlanner::Plan(
    const std::vector<OfferedPair>& pairs, std::vector<LostPlace>* const lost) {
  std::vector<PlannedPair> planned;
  if (pairs.empty()) return planned;
  live_trajectories_.insert(pairs.front().node_id.trajectory_id);
  std::vector<size_t> around;
  // By node and trajectory of the submap.
  std::map<std::pair<NodeId, int>, std::vector<size_t>> foreign;
  for (size_t i = 0; i < pairs.size(); ++i) {
    const OfferedPair& pair = pairs[i];
    if (extension_.localization().enabled() &&
        pair.submap_id.trajectory_id != pair.node_id.trajectory_id) {
      foreign[std::make_pair(pair.node_id, pair.submap_id.trajectory_id)]
          .push_back(i);
    } else if (pair.is_global) {
      PlannedPair whole;
      whole.pair = i;
      whole.plan.full_submap = true;
      planned.push_back(whole);
    } else {
      around.push_back(i);
    }
  }
  for (const auto& entry : foreign) {
    PlanForeign(pairs, entry.second, &planned, &around, lost);
  }
  std::sort(around.begin(), around.end());
  std::vector<SearchPlan> plans;
  if (extension_.search().enabled()) {
    std::vector<SearchPair> searches;
    for (const size_t i : around) searches.push_back(MakeSearchPair(pairs[i]));
    plans = search_planner_.Plan(searches);
  } else {
    for (const size_t i : around) plans.push_back(PlanLikeStock(pairs[i]));
  }
  for (size_t k = 0; k < plans.size(); ++k) {
    PlannedPair one;
    one.pair = around[k];
    one.plan = plans[k];
    planned.push_back(one);
  }
  // In the order they were offered.
  std::stable_sort(planned.begin(), planned.end(),
                   [](const PlannedPair& a, const PlannedPair& b) {
                     return a.pair < b.pair;
                   });
  return planned;
}

bool PairPlanner::AddAcceptedLoop(
    const SubmapId& submap_id, const uncertainty::NodeId& node,
    const int64_t node_time,
    const absl::optional<uncertainty::LoopEdge>& loop) {
  if (loop.has_value()) {
    search_planner_.AddAcceptedLoop(submap_id.trajectory_id,
                                    submap_id.submap_index, *loop, node_time);
  }
  return submap_id.trajectory_id != node.trajectory_id &&
         localization_.AddAcceptedLoop(node, submap_id.trajectory_id);
}

void PairPlanner::DeleteSubmap(const SubmapId& submap_id) {
  search_planner_.DeleteSubmap(submap_id.trajectory_id, submap_id.submap_index);
  samplers_.erase(submap_id);
  last_queries_.erase(submap_id);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
