// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The accepted loops of the compatible subset, which may be withdrawn.
#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"

namespace cartographer_ext {
namespace loop_closure {

constexpr int CompatibleSubset::kMostAcceptedLoops;

int CompatibleSubset::NumVerified(const std::vector<LoopEvidence>& loops) {
  return static_cast<int>(
      std::count_if(loops.begin(), loops.end(),
                    [](const LoopEvidence& loop) { return loop.is_verified; }));
}

int CompatibleSubset::NumWrong() const {
  int num_wrong = num_wrong_;
  for (const Cluster& cluster : clusters_) {
    if (cluster.in_subset || cluster.contradictions == 0 ||
        !cluster.leader.is_within_trajectory()) {
      continue;
    }
    num_wrong += NumVerified(cluster.undecided);
  }
  return num_wrong;
}

void CompatibleSubset::Accept(const std::vector<LoopEvidence>& loops,
                              const SubsetReason reason, Cluster* const cluster,
                              std::vector<SubsetDecision>* const decisions) {
  Emit(*cluster, loops, true, reason, decisions);
  cluster->accepted = true;
  if (!cluster->leader.is_within_trajectory()) return;
  for (const LoopEvidence& loop : loops) {
    num_right_ += loop.is_verified;
    cluster->accepted_loops.push_back(loop);
    cluster->accepted_loops.back().was_accepted = false;
  }
  num_accepted_loops_ += static_cast<int>(loops.size());
}

void CompatibleSubset::WithdrawLoops(
    std::vector<LoopEvidence> loops, Cluster* const cluster,
    std::vector<SubsetDecision>* const decisions) {
  for (LoopEvidence& loop : loops) {
    loop.was_accepted = true;
    num_right_ -= loop.is_verified;
  }
  num_accepted_loops_ -= static_cast<int>(loops.size());
  const size_t first = decisions->size();
  Emit(*cluster, loops, false, SubsetReason::kOverturned, decisions);
  for (size_t i = first; i < decisions->size(); ++i) {
    (*decisions)[i].withdrawn = true;
  }
  std::move(loops.begin(), loops.end(), std::back_inserter(cluster->undecided));
}

void CompatibleSubset::Withdraw(std::vector<SubsetDecision>* const decisions) {
  if (!options_.scores_are_probabilities) return;
  for (Cluster& cluster : clusters_) {
    SubsetReason reason;
    if (!cluster.accepted || cluster.accepted_loops.empty() ||
        cluster.in_subset || MayAccept(cluster, &reason)) {
      continue;
    }
    std::vector<LoopEvidence> loops;
    loops.swap(cluster.accepted_loops);
    WithdrawLoops(std::move(loops), &cluster, decisions);
    cluster.accepted = false;
    changed_ = true;
  }
}

std::vector<SubsetDecision> CompatibleSubset::Refute(
    const std::vector<int64_t>& ids) {
  std::vector<SubsetDecision> decisions;
  for (Cluster& cluster : clusters_) {
    std::vector<LoopEvidence>& loops = cluster.accepted_loops;
    const auto refuted = std::stable_partition(
        loops.begin(), loops.end(), [&](const LoopEvidence& loop) {
          return !std::binary_search(ids.begin(), ids.end(), loop.id);
        });
    if (refuted == loops.end()) continue;
    std::vector<LoopEvidence> withdrawn(refuted, loops.end());
    loops.erase(refuted, loops.end());
    for (LoopEvidence& loop : withdrawn) loop.is_refuted = true;
    WithdrawLoops(std::move(withdrawn), &cluster, &decisions);
    if (loops.empty()) cluster.accepted = false;
    changed_ = true;
  }
  return decisions;
}

void CompatibleSubset::BoundAcceptedLoops() {
  for (Cluster& cluster : clusters_) {
    if (num_accepted_loops_ <= kMostAcceptedLoops) return;
    num_accepted_loops_ -= static_cast<int>(cluster.accepted_loops.size());
    cluster.accepted_loops.clear();
  }
}

void CompatibleSubset::ForgetAcceptedLoops(
    const std::function<bool(const LoopEvidence&)>& condition) {
  num_accepted_loops_ = 0;
  for (Cluster& cluster : clusters_) {
    std::vector<LoopEvidence>& loops = cluster.accepted_loops;
    loops.erase(std::remove_if(loops.begin(), loops.end(), condition),
                loops.end());
    num_accepted_loops_ += static_cast<int>(loops.size());
  }
}

std::vector<int64_t> CompatibleSubset::AcceptedLoops() const {
  std::vector<int64_t> ids;
  for (const Cluster& cluster : clusters_) {
    for (const LoopEvidence& loop : cluster.accepted_loops) {
      ids.push_back(loop.id);
    }
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

void CompatibleSubset::ForgetAccepted(
    const std::function<bool(const LoopEvidence&)>& condition) {
  for (int i = num_clusters() - 1; i >= 0; --i) {
    Cluster& cluster = clusters_[i];
    if (!cluster.accepted || !condition(cluster.leader)) continue;
    changed_ = true;
    cluster.accepted = false;
    num_accepted_loops_ -= static_cast<int>(cluster.accepted_loops.size());
    cluster.accepted_loops.clear();
    if (cluster.undecided.empty()) Erase(i);
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
