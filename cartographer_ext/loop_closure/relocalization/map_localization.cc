// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/relocalization/map_localization.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
MapLocalization::MapLocalization(
    const MapLocalizationOptions& options,
    const uncertainty::PathUncertainty* const paths)
    : options_(options), paths_(CHECK_NOTNULL(paths)) {}

// Also where the distance is not known any more: it is a long one then.
bool MapLocalization::Farther(const uncertainty::NodeId& node, const int before,
                              const double distance) const {
  if (before < 0) return true;
  const absl::optional<double> travelled =
      paths_->Travelled(uncertainty::NodeId{node.trajectory_id, before}, node);
  return !travelled.has_value() || *travelled >= distance;
}

void MapLocalization::BecomeLost(State* const state) const {
  state->known = false;
  state->decisions.clear();
  state->last_searched = -1;
  state->last_before_lost = state->last_accepted;
}

MapLocalization::Plan MapLocalization::PlanNode(const uncertainty::NodeId& node,
                                                const int map_trajectory_id,
                                                const bool is_predicted) {
  const auto inserted = states_.emplace(
      std::make_pair(node.trajectory_id, map_trajectory_id), State());
  State& state = inserted.first->second;
  if (inserted.second) state.first_node = node.node_index;
  Plan plan;
  if (state.known) {
    const auto elsewhere =
        std::count(state.decisions.begin(), state.decisions.end(), false);
    plan.by_decisions = elsewhere >= options_.watches;
    if (plan.by_decisions ||
        Farther(node, state.last_accepted, options_.lost_distance)) {
      BecomeLost(&state);
      plan.newly_lost = true;
    }
  }
  if (state.known) {
    plan.around_prediction = is_predicted;
    plan.everywhere =
        Farther(node, state.last_searched, options_.watch_spacing);
  } else {
    // Who has been lost is not believed to be where the host thinks.
    plan.around_prediction =
        is_predicted && !state.was_known &&
        !Farther(node, state.first_node, options_.lost_distance);
    plan.everywhere =
        !plan.around_prediction &&
        Farther(node, state.last_searched, options_.query_spacing);
  }
  if (plan.everywhere) state.last_searched = node.node_index;
  return plan;
}

bool MapLocalization::AddAcceptedLoop(const uncertainty::NodeId& node,
                                      const int map_trajectory_id) {
  State& state = states_[std::make_pair(node.trajectory_id, map_trajectory_id)];
  // One that waited since before the run was lost is no new evidence.
  if (node.node_index <= state.last_before_lost) return false;
  state.last_accepted = std::max(state.last_accepted, node.node_index);
  if (state.known) return false;
  const bool again = state.was_known;
  state.known = true;
  state.was_known = true;
  state.decisions.clear();
  return again;
}

void MapLocalization::AddDecision(const uncertainty::NodeId& node,
                                  const int map_trajectory_id,
                                  const bool agrees) {
  State& state = states_[std::make_pair(node.trajectory_id, map_trajectory_id)];
  if (!state.known) return;
  state.decisions.push_back(agrees);
  if (state.decisions.size() > static_cast<size_t>(options_.watches) + 1) {
    state.decisions.pop_front();
  }
}

bool MapLocalization::IsKnown(const int trajectory_id,
                              const int map_trajectory_id) const {
  const auto it =
      states_.find(std::make_pair(trajectory_id, map_trajectory_id));
  return it != states_.end() && it->second.known;
}

int MapLocalization::LastNodeBeforeLost(const int trajectory_id,
                                        const int map_trajectory_id) const {
  const auto it =
      states_.find(std::make_pair(trajectory_id, map_trajectory_id));
  return it == states_.end() ? -1 : it->second.last_before_lost;
}

void MapLocalization::DeleteTrajectory(const int trajectory_id) {
  for (auto it = states_.begin(); it != states_.end();) {
    const bool is_of_it =
        it->first.first == trajectory_id || it->first.second == trajectory_id;
    it = is_of_it ? states_.erase(it) : std::next(it);
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
