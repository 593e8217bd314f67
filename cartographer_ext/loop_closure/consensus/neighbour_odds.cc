// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/neighbour_odds.h"

#include <cmath>

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Prior of the share, in wrong matches.
constexpr double kPriorAlike = 0.5;
constexpr double kPriorWrong = 5.;

double LogBeta(const double a, const double b) {
  return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
}

double Likelihood(const double a, const double b, const int num_found,
                  const int num_missed) {
  return std::exp(LogBeta(a + num_found, b + num_missed) - LogBeta(a, b));
}

}  // namespace

void ShareAlike::AddWrong(const int num_found, const int num_missed) {
  if (num_found + num_missed == 0) return;
  ++num_wrong_;
  // More likely those of a right one.
  num_alike_ += OddsOfNeighbours(num_found, num_missed, 0.) > 1.;
}

double ShareAlike::Mean() const {
  return (kPriorAlike + num_alike_) / (kPriorWrong + num_wrong_);
}

double OddsOfNeighbours(const int num_found, const int num_missed,
                        const double share_alike) {
  const double right = Likelihood(2., 1., num_found, num_missed);
  const double wrong = Likelihood(1., 4., num_found, num_missed);
  return right / ((1. - share_alike) * wrong + share_alike * right);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
