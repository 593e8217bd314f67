// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/evaluation/replay_plan.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

struct Span {
  io::TimeNs begin = std::numeric_limits<io::TimeNs>::max();
  io::TimeNs end = std::numeric_limits<io::TimeNs>::min();
};

// Nodes in the order in which they are to be fed.
std::vector<GraphId> FeedingOrder(const MapGraph& graph) {
  std::map<int, Span> spans;
  std::vector<GraphId> order;
  for (const auto& entry : graph.nodes) {
    order.push_back(entry.first);
    Span& span = spans[entry.first.trajectory_id];
    span.begin = std::min(span.begin, entry.second.time);
    span.end = std::max(span.end, entry.second.time);
  }
  bool overlap = false;
  for (auto a = spans.begin(); a != spans.end(); ++a) {
    for (auto b = std::next(a); b != spans.end(); ++b) {
      overlap = overlap || (a->second.begin <= b->second.end &&
                            b->second.begin <= a->second.end);
    }
  }
  if (overlap) {
    std::stable_sort(order.begin(), order.end(),
                     [&](const GraphId& a, const GraphId& b) {
                       return graph.nodes.at(a).time < graph.nodes.at(b).time;
                     });
  }
  return order;
}

// Decides on the submaps of one trajectory, node by node.
class SubmapChain {
 public:
  SubmapChain(const int trajectory_id, const MapGraph& graph,
              ReplayPlan* const plan)
      : trajectory_id_(trajectory_id), graph_(graph), plan_(plan) {}

  // `stored`: indices of the stored submaps of the node, growing.
  absl::Status Add(const GraphId& node_id, const std::vector<int>& stored) {
    if (stored.size() > 2) {
      return absl::InvalidArgumentError(
          absl::StrCat("node ", ToString(node_id), " was inserted in ",
                       stored.size(), " submaps"));
    }
    std::vector<int> next = Choose(stored);
    if (next.empty()) {
      return absl::FailedPreconditionError(absl::StrCat(
          "submaps next to node ", ToString(node_id),
          " have been trimmed: the order of insertion cannot be had again"));
    }
    const size_t step = plan_->steps.size();
    for (const int submap : next) plan_->submaps[submap].last_step = step;
    plan_->steps.push_back({node_id, next});
    active_ = std::move(next);
    return absl::OkStatus();
  }

 private:
  int StoredIndex(const int submap) const {
    return plan_->submaps[submap].stored_index;
  }

  int Make(const int stored_index) {
    ReplaySubmap submap;
    submap.trajectory_id = trajectory_id_;
    submap.stored_index = stored_index;
    submap.first_step = plan_->steps.size();
    if (stored_index >= 0) {
      submap.finished =
          graph_.submaps.at({trajectory_id_, stored_index}).finished;
    } else {
      ++plan_->num_placeholders;
    }
    plan_->submaps.push_back(submap);
    return static_cast<int>(plan_->submaps.size()) - 1;
  }

  // Empty where `stored` cannot follow on the active submaps.
  std::vector<int> Choose(const std::vector<int>& stored) {
    if (active_.empty()) return First(stored);
    const int newest = active_.back();
    // The node may stay where the one before was, as long as the stored ones
    // are among these and the others are placeholders.
    if (Stays(stored)) {
      if (!IsSecondMissing()) return active_;
      return {newest, Make(-1)};
    }
    if (stored.empty()) {
      // Unfinished submaps were not stored.
      if (plan_->submaps[newest].is_placeholder()) {
        return {newest, Make(-1)};
      }
      return {};
    }
    if (StoredIndex(newest) == stored.front()) {
      return {newest, Make(stored.size() == 2 ? stored[1] : -1)};
    }
    if (plan_->submaps[newest].is_placeholder() && stored.size() == 1) {
      return {newest, Make(stored[0])};
    }
    return {};
  }

  std::vector<int> First(const std::vector<int>& stored) {
    if (stored.empty()) return {Make(-1)};
    std::vector<int> result;
    for (const int index : stored) result.push_back(Make(index));
    return result;
  }

  bool Stays(const std::vector<int>& stored) const {
    size_t found = 0;
    for (const int submap : active_) {
      const int index = StoredIndex(submap);
      if (index < 0) continue;
      if (std::find(stored.begin(), stored.end(), index) == stored.end()) {
        return false;
      }
      ++found;
    }
    return found == stored.size();
  }

  // The first submap is alone for half of its nodes only.
  bool IsSecondMissing() const {
    if (active_.size() != 1) return false;
    const ReplaySubmap& first = plan_->submaps[active_[0]];
    if (!first.finished) return false;
    int nodes = 0;
    for (size_t i = first.first_step; i < plan_->steps.size(); ++i) {
      if (plan_->steps[i].node_id.trajectory_id == trajectory_id_) ++nodes;
    }
    const GraphSubmap& stored =
        graph_.submaps.at({trajectory_id_, first.stored_index});
    return 2 * nodes >= stored.num_range_data;
  }

  const int trajectory_id_;
  const MapGraph& graph_;
  ReplayPlan* const plan_;
  std::vector<int> active_;  // positions in the plan
};

}  // namespace

absl::StatusOr<ReplayPlan> MakeReplayPlan(const MapGraph& graph) {
  std::map<GraphId, std::vector<int>> submaps_of_node;
  for (const auto& inserted : graph.InsertedNodes()) {
    // Of a trajectory's own submaps only: nodes are not inserted in others.
    if (graph.submaps.count(inserted.first) == 0) continue;
    for (const GraphId& node : inserted.second) {
      if (node.trajectory_id != inserted.first.trajectory_id) {
        return absl::InvalidArgumentError(
            absl::StrCat("node ", ToString(node), " was inserted in submap ",
                         ToString(inserted.first), " of another trajectory"));
      }
      submaps_of_node[node].push_back(inserted.first.index);
    }
  }
  ReplayPlan plan;
  std::map<int, SubmapChain> chains;
  for (const GraphId& id : FeedingOrder(graph)) {
    std::vector<int>& stored = submaps_of_node[id];
    std::sort(stored.begin(), stored.end());
    stored.erase(std::unique(stored.begin(), stored.end()), stored.end());
    const int trajectory_id = id.trajectory_id;
    SubmapChain& chain =
        chains.emplace(trajectory_id, SubmapChain(trajectory_id, graph, &plan))
            .first->second;
    const absl::Status status = chain.Add(id, stored);
    if (!status.ok()) return status;
  }
  return plan;
}

}  // namespace evaluation
}  // namespace cartographer_ext
