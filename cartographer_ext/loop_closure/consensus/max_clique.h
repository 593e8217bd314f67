// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Maximum compatible loop subset as a maximum weight clique (paper G, improved
// graph optimisation 2024, eq. 21):
//
//   S* = argmax |S|_0  over S in {0,1}^n  subject to e_uv S_u S_v <= Delta
//
// Vertices are loops, edges join compatible pairs, weights count the distinct
// revisits a vertex represents (consecutive nodes matched to one submap are one
// piece of evidence, not many). Components that are not connected by
// contradictions are solved separately. Exact branch and bound with a greedy
// colouring bound, started from a greedy clique and stopped after a fixed
// amount of work, so that the result does not depend on the speed of the
// machine.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_MAX_CLIQUE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_MAX_CLIQUE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cartographer_ext {
namespace loop_closure {

// Undirected graph on n vertices, no self edges.
class CompatibilityGraph {
 public:
  explicit CompatibilityGraph(int num_vertices);

  int num_vertices() const { return num_vertices_; }
  void AddEdge(int u, int v);
  bool HasEdge(int u, int v) const {
    return (row(u)[v >> 6] >> (v & 63)) & uint64_t{1};
  }
  int num_words() const { return num_words_; }
  // Neighbours of u as a bit set of num_words() words.
  const uint64_t* row(int u) const {
    return &bits_[static_cast<size_t>(u) * num_words_];
  }

 private:
  int num_vertices_;
  int num_words_;
  std::vector<uint64_t> bits_;
};

// Limits of the search.
struct MaxCliqueOptions {
  // Limit of search nodes; one with many candidates counts as several.
  // Deterministic; a few milliseconds.
  int64_t max_steps = 100000;
};

// A maximum weight clique.
struct MaxCliqueResult {
  std::vector<int> vertices;  // ascending
  double weight = 0.;
  bool exact = false;  // false if the limit was reached
  int64_t steps = 0;
};

// `weights[v]` > 0. Of several maximum cliques the one found first in the fixed
// search order is returned; the order depends on the input only. The search
// starts from the clique `start`, grown greedily, where that is heavier than
// the greedy ones; vertices of it that are not joined to those before are left
// out.
MaxCliqueResult MaxWeightClique(const CompatibilityGraph& graph,
                                const std::vector<double>& weights,
                                const MaxCliqueOptions& options,
                                const std::vector<int>& start = {});

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_MAX_CLIQUE_H_
