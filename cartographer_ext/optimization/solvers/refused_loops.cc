// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/refused_loops.h"

#include <cmath>
#include <set>

namespace cartographer_ext {
namespace optimization {
namespace {

double LogBeta(const double a, const double b) {
  return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
}

}  // namespace

Acceptance CountAccepted(const std::vector<WhitenedEdge>& edges,
                         const std::vector<bool>& accepted, const size_t begin,
                         const size_t end) {
  std::set<int> all, in_force;
  for (size_t i = begin; i != end; ++i) {
    if (!edges[i].is_loop) continue;
    all.insert(StretchOf(edges[i]));
    if (accepted[i]) in_force.insert(StretchOf(edges[i]));
  }
  Acceptance result;
  result.accepted = in_force.size();
  result.stretches = all.size();
  return result;
}

double ChanceOfSoFew(const Acceptance& before, const Acceptance& now) {
  const double a = before.accepted + 1.;
  const double b = before.stretches - before.accepted + 1.;
  const double n = now.stretches;
  double result = 0.;
  for (int k = 0; k <= now.accepted; ++k) {
    // Binomial coefficient n over k, and the mean of p^k (1 - p)^(n - k).
    const double log_ways = -std::log(n + 1.) - LogBeta(n - k + 1., k + 1.);
    result += std::exp(log_ways + LogBeta(a + k, b + n - k) - LogBeta(a, b));
  }
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
