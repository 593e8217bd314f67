// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/replay_plan.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
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

// What the constraints reveal of a stored submap.
struct SubmapUse {
  int last_node = 0;           // index of the last node inserted
  bool has_successor = false;  // a node is in it and in a later one
};

// Plans the submaps of one trajectory, node by node.
class SubmapChain {
 public:
  // `uses`: by index of the stored submap.
  SubmapChain(const int trajectory_id, const MapGraph& graph,
              std::map<int, SubmapUse> uses, ReplayPlan* const plan)
      : trajectory_id_(trajectory_id),
        graph_(graph),
        uses_(std::move(uses)),
        plan_(plan) {}

  // `stored`: indices of the stored submaps of the node, growing.
  absl::Status Add(const GraphId& node_id, const std::vector<int>& stored) {
    if (stored.size() > 2) {
      return absl::InvalidArgumentError(
          absl::StrCat("node ", ToString(node_id), " was inserted into ",
                       stored.size(), " submaps"));
    }
    std::vector<int> next = Choose(node_id, stored);
    if (next.empty()) {
      return absl::FailedPreconditionError(
          absl::StrCat("node ", ToString(node_id),
                       " was inserted into an older submap than the previous "
                       "node: the order of insertion cannot be reconstructed"));
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
      made_.insert(stored_index);
      submap.finished =
          graph_.submaps.at({trajectory_id_, stored_index}).finished;
    } else {
      ++plan_->num_placeholders;
    }
    plan_->submaps.push_back(submap);
    return static_cast<int>(plan_->submaps.size()) - 1;
  }

  // Empty where `stored` cannot follow on the active submaps.
  std::vector<int> Choose(const GraphId& node_id,
                          const std::vector<int>& stored) {
    if (active_.empty()) return First(stored);
    const int newest = active_.back();
    // The node may stay where the one before was, as long as the stored ones
    // are among these and the others are placeholders.
    if (Stays(stored)) {
      if (!IsSecondMissing()) return active_;
      return {newest, Make(-1)};
    }
    if (MustStay(node_id, stored)) {
      ++plan_->num_guessed;
      return active_;
    }
    // Unfinished submaps were not stored.
    if (stored.empty()) return {newest, Make(-1)};
    for (const int index : stored) {
      if (index != StoredIndex(newest) && made_.count(index) > 0) return {};
    }
    if (StoredIndex(newest) == stored.front()) {
      return {newest, Make(stored.size() == 2 ? stored[1] : -1)};
    }
    // Submaps and nodes in between were trimmed. The pose graph wants a chain,
    // so the node counts as inserted in the newest submap, too.
    if (!plan_->submaps[newest].is_placeholder() || stored.size() == 2) {
      ++plan_->num_guessed;
    }
    return {newest, Make(stored.front())};
  }

  // Constraints of the node are missing, though others come later that go on
  // from where the node before was.
  bool MustStay(const GraphId& node_id, const std::vector<int>& stored) const {
    if (stored.empty()) {
      return std::any_of(active_.begin(), active_.end(), [&](const int submap) {
        const auto use = uses_.find(StoredIndex(submap));
        return use != uses_.end() && use->second.last_node > node_id.index;
      });
    }
    if (stored.size() != 1 || active_.size() != 2) return false;
    const int older = StoredIndex(active_.front());
    const int newer = StoredIndex(active_.back());
    if (older == stored.front()) return newer >= 0;
    return newer == stored.front() && uses_.at(newer).has_successor;
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

  // The first submap is alone for half of its nodes only. If a later node is in
  // it and in another, that is the second: nodes whose scans were not inserted
  // are more than the scans of a submap.
  bool IsSecondMissing() const {
    if (active_.size() != 1) return false;
    const ReplaySubmap& first = plan_->submaps[active_[0]];
    if (!first.finished || uses_.at(first.stored_index).has_successor) {
      return false;
    }
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
  const std::map<int, SubmapUse> uses_;
  ReplayPlan* const plan_;
  std::vector<int> active_;  // positions in the plan
  std::set<int> made_;       // stored indices of submaps in the plan
};

}  // namespace

absl::StatusOr<ReplayPlan> MakeReplayPlan(const MapGraph& graph) {
  std::map<GraphId, std::vector<int>> submaps_of_node;
  std::map<int, std::map<int, SubmapUse>> uses;  // trajectory, submap index
  for (const auto& inserted : graph.InsertedNodes()) {
    // Of a trajectory's own submaps only: nodes are not inserted in others.
    if (graph.submaps.count(inserted.first) == 0) continue;
    for (const GraphId& node : inserted.second) {
      if (node.trajectory_id != inserted.first.trajectory_id) {
        return absl::InvalidArgumentError(
            absl::StrCat("node ", ToString(node), " was inserted into submap ",
                         ToString(inserted.first), " of another trajectory"));
      }
      submaps_of_node[node].push_back(inserted.first.index);
      SubmapUse& use = uses[node.trajectory_id][inserted.first.index];
      use.last_node = std::max(use.last_node, node.index);
    }
  }
  for (auto& entry : submaps_of_node) {
    std::vector<int>& stored = entry.second;
    std::sort(stored.begin(), stored.end());
    stored.erase(std::unique(stored.begin(), stored.end()), stored.end());
    if (stored.size() == 2) {
      uses[entry.first.trajectory_id][stored.front()].has_successor = true;
    }
  }
  ReplayPlan plan;
  std::map<int, SubmapChain> chains;
  for (const GraphId& id : FeedingOrder(graph)) {
    const std::vector<int>& stored = submaps_of_node[id];
    const int trajectory_id = id.trajectory_id;
    SubmapChain& chain =
        chains
            .emplace(trajectory_id, SubmapChain(trajectory_id, graph,
                                                uses[trajectory_id], &plan))
            .first->second;
    const absl::Status status = chain.Add(id, stored);
    if (!status.ok()) return status;
  }
  return plan;
}

}  // namespace evaluation
}  // namespace cartographer_ext
