// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/max_clique.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// A step with n candidates compares up to n^2 / 2 pairs; this many pairs count
// as one more step.
constexpr int64_t kPairsPerStep = 1024;

class Search {
 public:
  Search(const CompatibilityGraph& graph, const std::vector<double>& weights,
         const MaxCliqueOptions& options)
      : graph_(graph), weights_(weights), options_(options) {}

  MaxCliqueResult Run(const std::vector<int>& start) {
    const int n = graph_.num_vertices();
    std::vector<int> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::vector<double> neighbourhood(n, 0.);
    for (int u = 0; u < n; ++u) {
      neighbourhood[u] = weights_[u];
      for (int v = 0; v < n; ++v) {
        if (v != u && graph_.HasEdge(u, v)) neighbourhood[u] += weights_[v];
      }
    }
    std::sort(order.begin(), order.end(), [&](const int a, const int b) {
      return neighbourhood[a] != neighbourhood[b]
                 ? neighbourhood[a] > neighbourhood[b]
                 : a < b;
    });
    if (!start.empty()) Grow(start, order);
    const size_t starts = std::min<size_t>(order.size(), 32);
    for (size_t s = 0; s < starts; ++s) Grow({order[s]}, order);
    std::vector<int> current;
    Expand(order, 0., &current);
    result_.exact = !stopped_;
    std::sort(result_.vertices.begin(), result_.vertices.end());
    return result_;
  }

 private:
  // Offers the clique of the vertices of `start` that are joined to all before
  // them, grown in the given order.
  void Grow(const std::vector<int>& start, const std::vector<int>& order) {
    std::vector<int> clique;
    double weight = 0.;
    for (const std::vector<int>* const vertices : {&start, &order}) {
      for (const int v : *vertices) {
        // A vertex is not joined to itself.
        if (std::all_of(clique.begin(), clique.end(),
                        [&](const int u) { return graph_.HasEdge(v, u); })) {
          clique.push_back(v);
          weight += weights_[v];
        }
      }
    }
    Offer(clique, weight);
  }

  void Offer(const std::vector<int>& clique, const double weight) {
    if (weight > result_.weight) {
      result_.weight = weight;
      result_.vertices = clique;
    }
  }

  // Splits the candidates greedily into independent sets. A clique takes at
  // most one vertex of each, so the sum of the heaviest of each set bounds what
  // the candidates up to a position can add.
  void Colour(const std::vector<int>& candidates, std::vector<int>* sorted,
              std::vector<double>* bounds) const {
    std::vector<int> open = candidates;
    double bound = 0.;
    while (!open.empty()) {
      std::vector<int> colour_class, rest;
      double heaviest = 0.;
      for (const int v : open) {
        bool independent = true;
        for (const int u : colour_class) {
          if (graph_.HasEdge(u, v)) {
            independent = false;
            break;
          }
        }
        if (independent) {
          colour_class.push_back(v);
          heaviest = std::max(heaviest, weights_[v]);
        } else {
          rest.push_back(v);
        }
      }
      bound += heaviest;
      for (const int v : colour_class) {
        sorted->push_back(v);
        bounds->push_back(bound);
      }
      open.swap(rest);
    }
  }

  void Expand(const std::vector<int>& candidates, const double weight,
              std::vector<int>* const current) {
    const int64_t num = static_cast<int64_t>(candidates.size());
    result_.steps += 1 + num * num / kPairsPerStep;
    if (result_.steps > options_.max_steps) {
      stopped_ = true;
      return;
    }
    if (candidates.empty()) {
      Offer(*current, weight);
      return;
    }
    std::vector<int> sorted;
    std::vector<double> bounds;
    Colour(candidates, &sorted, &bounds);
    for (int i = static_cast<int>(sorted.size()) - 1; i >= 0; --i) {
      if (weight + bounds[i] <= result_.weight) return;
      const int v = sorted[i];
      std::vector<int> next;
      for (int j = 0; j < i; ++j) {
        if (graph_.HasEdge(v, sorted[j])) next.push_back(sorted[j]);
      }
      current->push_back(v);
      Expand(next, weight + weights_[v], current);
      current->pop_back();
      if (stopped_) return;
    }
  }

  const CompatibilityGraph& graph_;
  const std::vector<double>& weights_;
  const MaxCliqueOptions& options_;
  MaxCliqueResult result_;
  bool stopped_ = false;
};

// The vertices that hang together by missing edges, ascending. Two vertices of
// different sets are joined, so that maximum cliques of the sets make one of
// the whole graph. Loops mostly agree: the sets are many and small.
std::vector<std::vector<int>> SplitByConflicts(
    const CompatibilityGraph& graph) {
  std::vector<std::vector<int>> sets;
  std::vector<int> open(graph.num_vertices());
  std::iota(open.begin(), open.end(), 0);
  while (!open.empty()) {
    std::vector<int> set = {open.front()};
    open.erase(open.begin());
    for (size_t i = 0; i < set.size(); ++i) {
      const auto rest = std::stable_partition(
          open.begin(), open.end(),
          [&](const int v) { return graph.HasEdge(set[i], v); });
      set.insert(set.end(), rest, open.end());
      open.erase(rest, open.end());
    }
    std::sort(set.begin(), set.end());
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace

CompatibilityGraph::CompatibilityGraph(const int num_vertices)
    : num_vertices_(num_vertices),
      num_words_((num_vertices + 63) / 64),
      bits_(static_cast<size_t>(num_vertices) * ((num_vertices + 63) / 64)) {
  CHECK_GE(num_vertices, 0);
}

void CompatibilityGraph::AddEdge(const int u, const int v) {
  CHECK_GE(u, 0);
  CHECK_LT(u, num_vertices_);
  CHECK_GE(v, 0);
  CHECK_LT(v, num_vertices_);
  CHECK_NE(u, v);
  bits_[static_cast<size_t>(u) * num_words_ + (v >> 6)] |= uint64_t{1}
                                                           << (v & 63);
  bits_[static_cast<size_t>(v) * num_words_ + (u >> 6)] |= uint64_t{1}
                                                           << (u & 63);
}

MaxCliqueResult MaxWeightClique(const CompatibilityGraph& graph,
                                const std::vector<double>& weights,
                                const MaxCliqueOptions& options,
                                const std::vector<int>& start) {
  CHECK_EQ(weights.size(), static_cast<size_t>(graph.num_vertices()));
  for (const double weight : weights) CHECK_GT(weight, 0.);
  std::vector<std::vector<int>> sets = SplitByConflicts(graph);
  // The large ones share what the small ones leave.
  std::stable_sort(sets.begin(), sets.end(),
                   [](const std::vector<int>& a, const std::vector<int>& b) {
                     return a.size() < b.size();
                   });
  MaxCliqueResult result;
  result.exact = true;
  MaxCliqueOptions left = options;
  for (const std::vector<int>& set : sets) {
    const int n = static_cast<int>(set.size());
    CompatibilityGraph part(n);
    std::vector<double> part_weights(n);
    for (int i = 0; i < n; ++i) {
      part_weights[i] = weights[set[i]];
      for (int j = 0; j < i; ++j) {
        if (graph.HasEdge(set[i], set[j])) part.AddEdge(i, j);
      }
    }
    std::vector<int> part_start;
    for (const int v : start) {
      const auto it = std::lower_bound(set.begin(), set.end(), v);
      if (it != set.end() && *it == v) {
        part_start.push_back(static_cast<int>(it - set.begin()));
      }
    }
    const MaxCliqueResult clique =
        Search(part, part_weights, left).Run(part_start);
    for (const int v : clique.vertices) result.vertices.push_back(set[v]);
    result.weight += clique.weight;
    result.exact = result.exact && clique.exact;
    result.steps += clique.steps;
    left.max_steps = std::max<int64_t>(0, options.max_steps - result.steps);
  }
  std::sort(result.vertices.begin(), result.vertices.end());
  return result;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
