// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_ways.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr size_t kNone = std::numeric_limits<size_t>::max();
// Bounds of memory and work. Later loops are left out, the oldest trees made
// again.
constexpr size_t kMaxLoops = 5000;
constexpr size_t kMaxTrees = 500;

double TranslationVariance(const UncertainPose& pose) {
  return pose.covariance.topLeftCorner<2, 2>().trace();
}

}  // namespace

LoopWays::LoopWays(const double spacing, const PathUncertainty* const paths)
    : spacing_(spacing), paths_(CHECK_NOTNULL(paths)) {}

bool LoopWays::HasNear(const LoopEdge& loop) const {
  const auto is_near = [this](const NodeKey& u, const NodeKey& v) {
    const absl::optional<double> way = paths_->Travelled(u, v);
    return way.has_value() && *way <= spacing_;
  };
  const auto any_near = [&](const std::vector<NodeKey>& anchors) {
    return std::any_of(
        anchors.begin(), anchors.end(),
        [&](const NodeKey& anchor) { return is_near(anchor, loop.a); });
  };
  const auto middle = by_node_.lower_bound(loop.b);
  for (auto it = middle; it != by_node_.end() && is_near(it->first, loop.b);
       ++it) {
    if (any_near(it->second)) return true;
  }
  for (auto it = middle; it != by_node_.begin();) {
    --it;
    if (!is_near(it->first, loop.b)) break;
    if (any_near(it->second)) return true;
  }
  return false;
}

void LoopWays::Add(const LoopEdge& loop) {
  if (loops_.size() >= kMaxLoops || HasNear(loop)) return;
  loops_.push_back(loop);
  by_node_[loop.b].push_back(loop.a);
  is_built_ = false;
}

void LoopWays::RemoveIf(const std::function<bool(const LoopEdge&)>& condition) {
  const auto end = std::remove_if(loops_.begin(), loops_.end(), condition);
  if (end == loops_.end()) return;
  loops_.erase(end, loops_.end());
  by_node_.clear();
  for (const LoopEdge& loop : loops_) by_node_[loop.b].push_back(loop.a);
  is_built_ = false;
}

void LoopWays::BuildVertices() {
  is_built_ = true;
  trees_.clear();
  vertices_.clear();
  vertex_of_.clear();
  for (const LoopEdge& loop : loops_) {
    vertex_of_.emplace(loop.a, 0);
    vertex_of_.emplace(loop.b, 0);
  }
  for (auto& entry : vertex_of_) {
    const size_t index = vertices_.size();
    entry.second = index;
    Vertex vertex;
    vertex.node = entry.first;
    vertex.before = kNone;
    vertex.after = kNone;
    if (index > 0 &&
        vertices_.back().node.trajectory_id == vertex.node.trajectory_id) {
      vertex.before = index - 1;
      vertices_.back().after = index;
    }
    vertices_.push_back(std::move(vertex));
  }
  for (size_t i = 0; i < loops_.size(); ++i) {
    vertices_[vertex_of_.at(loops_[i].a)].loops.push_back(i);
    vertices_[vertex_of_.at(loops_[i].b)].loops.push_back(i);
  }
}

std::vector<size_t> LoopWays::Around(const NodeKey& node) const {
  std::vector<size_t> around;
  const auto after = vertex_of_.lower_bound(node);
  if (after != vertex_of_.end() &&
      after->first.trajectory_id == node.trajectory_id) {
    around.push_back(after->second);
    if (after->first == node) return around;
  }
  if (after != vertex_of_.begin()) {
    const auto before = std::prev(after);
    if (before->first.trajectory_id == node.trajectory_id) {
      around.push_back(before->second);
    }
  }
  return around;
}

LoopWays::Tree* LoopWays::TreeOf(const NodeKey& root) {
  const auto known = trees_.find(root);
  if (known != trees_.end()) return &known->second;
  if (trees_.size() >= kMaxTrees) trees_.clear();
  Tree& tree = trees_[root];
  tree.root = root;
  Tree::Branch unreached;
  unreached.effort = std::numeric_limits<double>::infinity();
  unreached.from = kNone;
  unreached.loop = kNone;
  tree.branches.assign(vertices_.size(), unreached);
  // By effort and vertex, so that the result is the same everywhere.
  std::set<std::pair<double, size_t>> queue;
  const auto reach = [&](const size_t vertex, const double effort,
                         const size_t from, const size_t loop) {
    Tree::Branch& branch = tree.branches[vertex];
    if (!(effort < branch.effort)) return;
    queue.erase(std::make_pair(branch.effort, vertex));
    branch.effort = effort;
    branch.from = from;
    branch.loop = loop;
    queue.emplace(effort, vertex);
  };
  for (const size_t vertex : Around(root)) {
    const absl::optional<double> effort =
        paths_->Effort(root, vertices_[vertex].node);
    if (effort.has_value()) reach(vertex, *effort, kNone, kNone);
  }
  while (!queue.empty()) {
    const size_t at = queue.begin()->second;
    const double effort = queue.begin()->first;
    queue.erase(queue.begin());
    const Vertex& vertex = vertices_[at];
    for (const size_t next : {vertex.before, vertex.after}) {
      if (next == kNone) continue;
      const absl::optional<double> step =
          paths_->Effort(vertex.node, vertices_[next].node);
      if (step.has_value()) reach(next, effort + *step, at, kNone);
    }
    for (const size_t loop : vertex.loops) {
      const LoopEdge& edge = loops_[loop];
      const NodeKey& other = edge.a == vertex.node ? edge.b : edge.a;
      reach(vertex_of_.at(other),
            effort + paths_->EffortOf(edge.pose.covariance), at, loop);
    }
  }
  return &tree;
}

const absl::optional<UncertainPose>& LoopWays::WayTo(const size_t vertex,
                                                     Tree* const tree) const {
  // Down to what is composed already, and up again.
  std::vector<size_t> open;
  for (size_t at = vertex; at != kNone && !tree->branches[at].is_composed;
       at = tree->branches[at].from) {
    open.push_back(at);
  }
  for (auto it = open.rbegin(); it != open.rend(); ++it) {
    Tree::Branch& branch = tree->branches[*it];
    branch.is_composed = true;
    const NodeKey& node = vertices_[*it].node;
    if (branch.from == kNone) {
      // Nothing where it was not reached at all.
      branch.way = paths_->Between(tree->root, node);
      continue;
    }
    const absl::optional<UncertainPose>& before =
        tree->branches[branch.from].way;
    if (!before.has_value()) continue;
    if (branch.loop != kNone) {
      const LoopEdge& loop = loops_[branch.loop];
      branch.way =
          Compose(*before, loop.b == node ? loop.pose : Invert(loop.pose));
      continue;
    }
    const absl::optional<UncertainPose> along =
        paths_->Between(vertices_[branch.from].node, node);
    if (along.has_value()) branch.way = Compose(*before, *along);
  }
  return tree->branches[vertex].way;
}

absl::optional<UncertainPose> LoopWays::Between(const NodeKey& a,
                                                const NodeKey& b) {
  absl::optional<UncertainPose> best = paths_->Between(a, b);
  if (loops_.empty()) return best;
  if (!is_built_) BuildVertices();
  Tree* const tree = TreeOf(a);
  for (const size_t vertex : Around(b)) {
    const absl::optional<UncertainPose>& to = WayTo(vertex, tree);
    if (!to.has_value()) continue;
    const absl::optional<UncertainPose> along =
        paths_->Between(vertices_[vertex].node, b);
    if (!along.has_value()) continue;
    const UncertainPose way = Compose(*to, *along);
    if (!best.has_value() ||
        TranslationVariance(way) < TranslationVariance(*best)) {
      best = way;
    }
  }
  return best;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
