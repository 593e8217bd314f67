// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/submap_store.h"

#include <algorithm>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer/mapping/internal/constraints/constraint_builder_2d.h"
#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"
#include "cartographer_ext/loop_closure/dropin/node_geometry.h"

namespace cartographer_ext {
namespace loop_closure {

using cartographer::mapping::Submap2D;
using cartographer::mapping::constraints::ComputeSubmapPose;
using uncertainty::SubmapId;

constexpr int SubmapEntry::kUnknownNode;

SubmapStore::SubmapStore(
    const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
        options,
    const LoopOptions& extension)
    : with_views_(extension.temporal.enabled),
      num_neighbours_(extension.temporal.num_neighbours),
      cache_(options.fast_correlative_scan_matcher_options(),
             extension.temporal.comparison, extension.max_cache_bytes) {}

void SubmapStore::AddNode(const uncertainty::NodeId& node, const int64_t time) {
  const NewestNode added{node.node_index, time};
  const auto newest = newest_nodes_.emplace(node.trajectory_id, added).first;
  if (added.node_index >= newest->second.node_index) newest->second = added;
}

std::shared_ptr<SubmapEntry> SubmapStore::AddPair(
    const SubmapId& submap_id, const Submap2D* const submap,
    const int node_trajectory_id) {
  std::shared_ptr<SubmapEntry>& entry = submaps_[submap_id];
  const auto newest = newest_nodes_.find(submap_id.trajectory_id);
  if (entry == nullptr) {
    // Set once: tasks read it.
    entry = std::make_shared<SubmapEntry>();
    entry->submap = submap;
    entry->cached = absl::make_unique<CachedSubmap>(num_submaps_++, submap);
    entry->local_pose = ToPose2(ComputeSubmapPose(*submap));
    entry->first_group = num_groups_;
    if (newest != newest_nodes_.end()) {
      entry->newest_node_at_first = newest->second.node_index;
      entry->time_at_first = newest->second.time;
    }
  } else if (entry->newest_node_bound == SubmapEntry::kUnknownNode &&
             num_groups_ > entry->first_group &&
             node_trajectory_id == submap_id.trajectory_id) {
    // A later node of its own trajectory meets it as a complete one.
    entry->newest_node_bound = newest->second.node_index;
  }
  return entry;
}

std::shared_ptr<SubmapEntry> SubmapStore::Find(const SubmapId& id) const {
  const auto it = submaps_.find(id);
  return it == submaps_.end() ? nullptr : it->second;
}

bool SubmapStore::HasSubmapsOf(const int trajectory_id) const {
  const auto it = submaps_.lower_bound(
      SubmapId{trajectory_id, std::numeric_limits<int>::min()});
  return it != submaps_.end() && it->first.trajectory_id == trajectory_id;
}

int SubmapStore::NewestNodeIndex(const int trajectory_id) const {
  const auto it = newest_nodes_.find(trajectory_id);
  return it == newest_nodes_.end() ? -1 : it->second.node_index;
}

int SubmapStore::Erase(const SubmapId& id) {
  const auto it = submaps_.find(id);
  if (it == submaps_.end()) return SubmapEntry::kUnknownNode;
  const int newest_node = it->second->newest_node_bound;
  if (it->second->is_searched) {
    ConstraintMetrics::Global()->num_matchers->Set(--num_searched_);
  }
  cache_.Erase(*it->second->cached);
  submaps_.erase(it);
  return newest_node;
}

int SubmapStore::OldestNode(const SubmapId& id) const {
  // Two submaps are active at a time, so the nodes of this one are newer than
  // the end of the last but one.
  const auto before =
      submaps_.find(SubmapId{id.trajectory_id, id.submap_index - 2});
  return before == submaps_.end()
             ? 0
             : std::max(0, before->second->newest_node_at_first);
}

absl::optional<uncertainty::VertexId> SubmapStore::Anchor(
    const SubmapId& id, const SubmapEntry& entry, const int node_trajectory_id,
    const uncertainty::PathUncertainty& paths) const {
  if (node_trajectory_id != id.trajectory_id) {
    return uncertainty::VertexId(id);
  }
  if (entry.newest_node_at_first < 0) return absl::nullopt;
  const absl::optional<uncertainty::NodeId> nearest =
      paths.Nearest(id.trajectory_id, entry.local_pose.translation(),
                    OldestNode(id), entry.newest_node_at_first);
  if (!nearest.has_value()) return absl::nullopt;
  return uncertainty::VertexId(*nearest);
}

LoopCandidate SubmapStore::MakeCandidate(
    const SubmapId& id, const SubmapEntry& entry, const int node_trajectory_id,
    const uncertainty::PathUncertainty& paths) const {
  LoopCandidate candidate;
  candidate.submap = id;
  candidate.submap_local_pose = entry.local_pose;
  // Of another trajectory: as old as can be.
  candidate.submap_age = 1e9;
  if (node_trajectory_id == id.trajectory_id) {
    candidate.first_submap_node = OldestNode(id);
    candidate.last_submap_node = entry.newest_node_at_first;
  }
  candidate.anchor = Anchor(id, entry, node_trajectory_id, paths);
  return candidate;
}

void SubmapStore::AnnounceSearch(const SubmapId& id) {
  SubmapEntry* const entry = submaps_.at(id).get();
  if (!entry->is_searched) {
    entry->is_searched = true;
    ConstraintMetrics::Global()->num_matchers->Set(++num_searched_);
  }
  if (!with_views_) return;
  for (int k = -num_neighbours_; k <= num_neighbours_; ++k) {
    const auto it =
        submaps_.find(SubmapId{id.trajectory_id, id.submap_index + k});
    if (it != submaps_.end()) it->second->is_compared = true;
  }
}

void SubmapStore::AddMaps(LoopCandidate* const candidate) {
  for (int k = 0; k <= 2 * num_neighbours_; ++k) {
    // The submap, then its neighbours from near to far.
    const int offset = k % 2 == 1 ? (k + 1) / 2 : -k / 2;
    const auto it =
        submaps_.find(SubmapId{candidate->submap.trajectory_id,
                               candidate->submap.submap_index + offset});
    if (it == submaps_.end() || !it->second->is_compared) continue;
    candidate->views.push_back(cache_.View(it->second->cached.get()));
    candidate->maps.push_back(ReferenceMap{candidate->views.back().get(),
                                           candidate->submap_local_pose});
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
