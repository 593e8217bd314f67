// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/relocalizer.h"

#include <algorithm>
#include <iterator>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {

Relocalizer::Relocalizer(const RelocalizationOptions& options,
                         const double min_score)
    : options_(options), min_score_(min_score) {}

Relocalizer::RunAndMap Relocalizer::KeyOf(const PlaceQuery& query) {
  CHECK(!query.jobs.empty());
  const LoopCandidate& first = query.jobs.front()->candidate;
  return std::make_pair(first.node.trajectory_id, first.submap.trajectory_id);
}

PlaceQuery Relocalizer::MakeQuery(const std::vector<SearchJob*>& jobs,
                                  const MapLocalization& localization) {
  PlaceQuery query;
  query.jobs = jobs;
  const RunAndMap key = KeyOf(query);
  State& state = states_[key];
  if (state.places == nullptr) {
    state.places = std::make_shared<PlaceSearch>(options_, min_score_);
  }
  query.places = state.places;
  query.is_known = localization.IsKnown(key.first, key.second);
  const auto forget = forget_up_to_.find(key);
  if (forget != forget_up_to_.end()) {
    query.forget_up_to = forget->second;
    forget_up_to_.erase(forget);
  }
  return query;
}

std::weak_ptr<cartographer::common::Task>* Relocalizer::LastTask(
    const PlaceQuery& query) {
  return &states_.at(KeyOf(query)).last_task;
}

void Relocalizer::ReportDecision(const PlaceQuery& query,
                                 MapLocalization* const localization) const {
  if (!query.is_known || !query.result.decided ||
      !query.jobs.front()->candidate.predicted.has_value()) {
    return;
  }
  // By the submap that was matched: the host may have moved others.
  for (const SearchJob* const job : query.jobs) {
    const LoopCandidate& candidate = job->candidate;
    if (candidate.submap.submap_index != query.result.decided_submap) continue;
    localization->AddDecision(
        candidate.node, candidate.submap.trajectory_id,
        query.places->IsSamePlace(
            candidate.submap_local_pose * candidate.SearchCenter(),
            query.result.decided_pose));
  }
}

void Relocalizer::ForgetPlaces(const int trajectory_id,
                               const int map_trajectory_id,
                               const int last_node) {
  forget_up_to_[std::make_pair(trajectory_id, map_trajectory_id)] = last_node;
}

void Relocalizer::DeleteNodes(const int trajectory_id, const int last_node) {
  for (const auto& state : states_) {
    if (state.first.first != trajectory_id) continue;
    int& forget = forget_up_to_.emplace(state.first, -1).first->second;
    forget = std::max(forget, last_node);
  }
}

void Relocalizer::DeleteTrajectory(const int trajectory_id) {
  const auto is_of_it = [trajectory_id](const RunAndMap& key) {
    return key.first == trajectory_id || key.second == trajectory_id;
  };
  for (auto it = states_.begin(); it != states_.end();) {
    it = is_of_it(it->first) ? states_.erase(it) : std::next(it);
  }
  for (auto it = forget_up_to_.begin(); it != forget_up_to_.end();) {
    it = is_of_it(it->first) ? forget_up_to_.erase(it) : std::next(it);
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
