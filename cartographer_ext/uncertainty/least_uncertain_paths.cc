// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/least_uncertain_paths.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "glog/logging.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

constexpr size_t kNone = std::numeric_limits<size_t>::max();
// Beyond this number of trees all are searched again.
constexpr size_t kMaxTrees = 500;

double TranslationVariance(const UncertainPose& pose) {
  return pose.covariance.topLeftCorner<2, 2>().trace();
}

}  // namespace

LeastUncertainPaths::LeastUncertainPaths(const double spacing,
                                         const PathUncertainty* const paths,
                                         const size_t max_loops)
    : max_loops_(max_loops), spacing_(spacing), paths_(CHECK_NOTNULL(paths)) {
  CHECK_GE(spacing, 0.);
  CHECK_GT(max_loops, 0u);
}

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

void LeastUncertainPaths::Add(const LoopEdge& loop) {
  if (HasNear(loop)) return;
  loops_.push_back(loop);
  ends_[loop.b].push_back(loop.a);
  is_built_ = false;
  if (loops_.size() > max_loops_) Thin();
}

void LeastUncertainPaths::Thin() {
  spacing_ *= 2.;
  std::vector<LoopEdge> all;
  all.swap(loops_);
  ends_.clear();
  for (const LoopEdge& loop : all) {
    if (HasNear(loop)) continue;
    loops_.push_back(loop);
    ends_[loop.b].push_back(loop.a);
  }
  if (loops_.size() <= max_loops_) return;
  // Nothing is near anything else: the oldest go.
  loops_.erase(loops_.begin(), loops_.end() - max_loops_);
  ends_.clear();
  for (const LoopEdge& loop : loops_) ends_[loop.b].push_back(loop.a);
}

void LeastUncertainPaths::RemoveIf(
    const std::function<bool(const LoopEdge&)>& condition) {
  const auto end = std::remove_if(loops_.begin(), loops_.end(), condition);
  if (end == loops_.end()) return;
  loops_.erase(end, loops_.end());
  ends_.clear();
  for (const LoopEdge& loop : loops_) ends_[loop.b].push_back(loop.a);
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
  std::set<std::pair<double, size_t>> queue;
  const auto reach = [&](const size_t vertex, const double cost,
                         const size_t from, const size_t loop) {
    Tree::Branch& branch = tree->branches[vertex];
    if (!(cost < branch.cost)) return;
    queue.erase(std::make_pair(branch.cost, vertex));
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
    const size_t at = queue.begin()->second;
    const double cost = queue.begin()->first;
    queue.erase(queue.begin());
    const Vertex& vertex = vertices_[at];
    for (const size_t next : {vertex.before, vertex.after}) {
      if (next == kNone) continue;
      const absl::optional<double> step =
          paths_->PathCost(vertex.id, vertices_[next].id);
      if (step.has_value()) reach(next, cost + *step, at, kNone);
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

LeastUncertainPaths LeastUncertainPaths::Without(
    const std::function<bool(const LoopEdge&)>& condition) const {
  LeastUncertainPaths others(spacing_, paths_, max_loops_);
  for (const LoopEdge& loop : loops_) {
    if (condition(loop)) continue;
    others.loops_.push_back(loop);
    others.ends_[loop.b].push_back(loop.a);
  }
  return others;
}

absl::optional<UncertainPose> LeastUncertainPaths::Between(const VertexId& a,
                                                           const VertexId& b) {
  absl::optional<UncertainPose> best = paths_->Between(a, b);
  if (loops_.empty()) return best;
  if (!is_built_) BuildVertices();
  if (drift_version_ != paths_->drift_version()) {
    drift_version_ = paths_->drift_version();
    trees_.clear();
  }
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
