// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/least_uncertain_paths.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <queue>
#include <set>
#include <utility>

#include "glog/logging.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

constexpr size_t kNone = std::numeric_limits<size_t>::max();
// Bounds of memory and work. Later loops are not stored; beyond the number of
// trees all are searched again.
constexpr size_t kMaxLoops = 5000;
constexpr size_t kMaxTrees = 4;

double TranslationVariance(const UncertainPose& pose) {
  return pose.covariance.topLeftCorner<2, 2>().trace();
}

}  // namespace

LeastUncertainPaths::LeastUncertainPaths(const double spacing,
                                         const double stretch,
                                         const PathUncertainty* const paths)
    : spacing_(spacing), stretch_(stretch), paths_(CHECK_NOTNULL(paths)) {}

bool LeastUncertainPaths::HasNear(const LoopEdge& loop) const {
  const auto is_near = [this](const VertexId& u, const VertexId& v) {
    const absl::optional<double> distance = paths_->Travelled(u, v);
    return distance.has_value() && *distance <= spacing_;
  };
  const auto any_near = [&](const std::vector<VertexId>& others) {
    return std::any_of(
        others.begin(), others.end(),
        [&](const VertexId& other) { return is_near(other, loop.a); });
  };
  const auto middle = ends_.lower_bound(loop.b);
  for (auto it = middle; it != ends_.end() && is_near(it->first, loop.b);
       ++it) {
    if (any_near(it->second)) return true;
  }
  for (auto it = middle; it != ends_.begin();) {
    --it;
    if (!is_near(it->first, loop.b)) break;
    if (any_near(it->second)) return true;
  }
  return false;
}

void LeastUncertainPaths::AppendSteps(
    const VertexId& from,
    std::vector<std::pair<double, VertexId>>* const steps) const {
  const auto append = [&](const VertexId& to) {
    const absl::optional<double> cost = paths_->PathCost(from, to);
    if (cost.has_value()) steps->emplace_back(*cost, to);
  };
  auto after = across_.lower_bound(from);
  if (after != across_.begin()) append(std::prev(after)->first);
  if (after != across_.end() && after->first == from) {
    steps->insert(steps->end(), after->second.begin(), after->second.end());
    ++after;
  }
  if (after != across_.end()) append(after->first);
}

bool LeastUncertainPaths::HasPath(const VertexId& a, const VertexId& b,
                                  const double bound) const {
  std::map<VertexId, double> reached = {{a, 0.}};
  std::set<std::pair<double, VertexId>> queue = {{0., a}};
  std::vector<std::pair<double, VertexId>> steps;
  while (!queue.empty()) {
    const double cost = queue.begin()->first;
    const VertexId at = queue.begin()->second;
    queue.erase(queue.begin());
    const absl::optional<double> rest = paths_->PathCost(at, b);
    if (rest.has_value() && cost + *rest <= bound) return true;
    steps.clear();
    AppendSteps(at, &steps);
    for (const auto& step : steps) {
      const double next = cost + step.first;
      if (next > bound) continue;
      const auto known = reached.emplace(step.second, next);
      if (!known.second) {
        if (known.first->second <= next) continue;
        queue.erase(std::make_pair(known.first->second, step.second));
        known.first->second = next;
      }
      queue.emplace(next, step.second);
    }
  }
  return false;
}

void LeastUncertainPaths::Store(const LoopEdge& loop) {
  const double cost = paths_->PathCostOf(loop.pose.covariance);
  ends_[loop.b].push_back(loop.a);
  across_[loop.a].emplace_back(cost, loop.b);
  across_[loop.b].emplace_back(cost, loop.a);
}

bool LeastUncertainPaths::MakeRoom() {
  if (loops_.size() < kMaxLoops) return true;
  RemoveIf([this](const LoopEdge& loop) {
    return !paths_->LocalPose(loop.a).has_value() ||
           !paths_->LocalPose(loop.b).has_value();
  });
  return loops_.size() < kMaxLoops;
}

void LeastUncertainPaths::Add(const LoopEdge& loop) {
  if (HasNear(loop) ||
      HasPath(loop.a, loop.b,
              stretch_ * paths_->PathCostOf(loop.pose.covariance)) ||
      !MakeRoom()) {
    return;
  }
  loops_.push_back(loop);
  Store(loop);
  is_built_ = false;
}

void LeastUncertainPaths::RemoveIf(
    const std::function<bool(const LoopEdge&)>& condition) {
  const auto end = std::remove_if(loops_.begin(), loops_.end(), condition);
  if (end == loops_.end()) return;
  loops_.erase(end, loops_.end());
  ends_.clear();
  across_.clear();
  for (const LoopEdge& loop : loops_) Store(loop);
  is_built_ = false;
}

void LeastUncertainPaths::BuildVertices() {
  is_built_ = true;
  trees_.clear();
  vertices_.clear();
  index_of_.clear();
  for (const LoopEdge& loop : loops_) {
    index_of_.emplace(loop.a, 0);
    index_of_.emplace(loop.b, 0);
  }
  for (auto& entry : index_of_) {
    const size_t index = vertices_.size();
    entry.second = index;
    Vertex vertex;
    vertex.id = entry.first;
    vertex.before = kNone;
    vertex.after = kNone;
    vertex.cost_after = 0.;
    if (index > 0 && vertices_.back().id.InSequenceWith(vertex.id)) {
      vertex.before = index - 1;
      vertices_.back().after = index;
    }
    vertices_.push_back(std::move(vertex));
  }
  for (size_t i = 0; i < loops_.size(); ++i) {
    vertices_[index_of_.at(loops_[i].a)].loops.push_back(i);
    vertices_[index_of_.at(loops_[i].b)].loops.push_back(i);
  }
  MeasureSteps();
}

void LeastUncertainPaths::MeasureSteps() {
  drift_version_ = paths_->drift_version();
  trees_.clear();
  for (Vertex& vertex : vertices_) {
    if (vertex.after == kNone) continue;
    vertex.cost_after = paths_->PathCost(vertex.id, vertices_[vertex.after].id)
                            .value_or(std::numeric_limits<double>::infinity());
  }
}

std::vector<size_t> LeastUncertainPaths::Adjacent(const VertexId& id) const {
  std::vector<size_t> adjacent;
  const auto after = index_of_.lower_bound(id);
  if (after != index_of_.end() && after->first.InSequenceWith(id)) {
    adjacent.push_back(after->second);
    if (after->first == id) return adjacent;
  }
  if (after != index_of_.begin()) {
    const auto before = std::prev(after);
    if (before->first.InSequenceWith(id)) adjacent.push_back(before->second);
  }
  return adjacent;
}

LeastUncertainPaths::Tree* LeastUncertainPaths::TreeOf(const VertexId& root) {
  const auto known = trees_.find(root);
  if (known != trees_.end()) return &known->second;
  if (trees_.size() >= kMaxTrees) trees_.clear();
  Tree& tree = trees_[root];
  tree.root = root;
  Search(&tree);
  return &tree;
}

void LeastUncertainPaths::Search(Tree* const tree) const {
  Tree::Branch unreached;
  unreached.cost = std::numeric_limits<double>::infinity();
  unreached.from = kNone;
  unreached.loop = kNone;
  tree->branches.assign(vertices_.size(), unreached);
  // By cost and vertex, so that the result is the same everywhere.
  using Entry = std::pair<double, size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  const auto reach = [&](const size_t vertex, const double cost,
                         const size_t from, const size_t loop) {
    Tree::Branch& branch = tree->branches[vertex];
    if (!(cost < branch.cost)) return;
    branch.cost = cost;
    branch.from = from;
    branch.loop = loop;
    queue.emplace(cost, vertex);
  };
  for (const size_t vertex : Adjacent(tree->root)) {
    const absl::optional<double> cost =
        paths_->PathCost(tree->root, vertices_[vertex].id);
    if (cost.has_value()) reach(vertex, *cost, kNone, kNone);
  }
  while (!queue.empty()) {
    const double cost = queue.top().first;
    const size_t at = queue.top().second;
    queue.pop();
    if (cost > tree->branches[at].cost) continue;
    const Vertex& vertex = vertices_[at];
    if (vertex.before != kNone) {
      reach(vertex.before, cost + vertices_[vertex.before].cost_after, at,
            kNone);
    }
    if (vertex.after != kNone) {
      reach(vertex.after, cost + vertex.cost_after, at, kNone);
    }
    for (const size_t loop : vertex.loops) {
      const LoopEdge& edge = loops_[loop];
      const VertexId& other = edge.a == vertex.id ? edge.b : edge.a;
      reach(index_of_.at(other),
            cost + paths_->PathCostOf(edge.pose.covariance), at, loop);
    }
  }
}

const absl::optional<UncertainPose>& LeastUncertainPaths::PoseOf(
    const size_t vertex, Tree* const tree) const {
  // Down to what is composed already, and up again.
  std::vector<size_t> pending;
  for (size_t at = vertex; at != kNone && !tree->branches[at].is_composed;
       at = tree->branches[at].from) {
    pending.push_back(at);
  }
  for (auto it = pending.rbegin(); it != pending.rend(); ++it) {
    Tree::Branch& branch = tree->branches[*it];
    branch.is_composed = true;
    const VertexId& id = vertices_[*it].id;
    if (branch.from == kNone) {
      // Empty where the search did not reach it.
      branch.pose = paths_->Between(tree->root, id);
      continue;
    }
    const absl::optional<UncertainPose>& before =
        tree->branches[branch.from].pose;
    if (!before.has_value()) continue;
    if (branch.loop != kNone) {
      const LoopEdge& loop = loops_[branch.loop];
      branch.pose =
          Compose(*before, loop.b == id ? loop.pose : Invert(loop.pose));
      continue;
    }
    const absl::optional<UncertainPose> along =
        paths_->Between(vertices_[branch.from].id, id);
    if (along.has_value()) branch.pose = Compose(*before, *along);
  }
  return tree->branches[vertex].pose;
}

absl::optional<UncertainPose> LeastUncertainPaths::Between(const VertexId& a,
                                                           const VertexId& b) {
  absl::optional<UncertainPose> best = paths_->Between(a, b);
  if (loops_.empty()) return best;
  if (!is_built_) BuildVertices();
  if (drift_version_ != paths_->drift_version()) MeasureSteps();
  Tree* const tree = TreeOf(a);
  for (const size_t vertex : Adjacent(b)) {
    const absl::optional<UncertainPose>& to = PoseOf(vertex, tree);
    if (!to.has_value()) continue;
    const absl::optional<UncertainPose> along =
        paths_->Between(vertices_[vertex].id, b);
    if (!along.has_value()) continue;
    const UncertainPose path = Compose(*to, *along);
    if (!best.has_value() ||
        TranslationVariance(path) < TranslationVariance(*best)) {
      best = path;
    }
  }
  return best;
}

}  // namespace uncertainty
}  // namespace cartographer_ext
