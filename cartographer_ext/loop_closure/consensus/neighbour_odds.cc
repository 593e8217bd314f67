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

double Likelihood(const double a, const double b,
                  const FollowedMatch& followed) {
  return std::exp(LogBeta(a + followed.num_found, b + followed.num_missed) -
                  LogBeta(a, b));
}

}  // namespace

void ShareAlike::AddWrong(const FollowedMatch& followed) {
  if (followed.num_found + followed.num_missed == 0) return;
  ++num_wrong_;
  // More likely those of a right one.
  num_alike_ += OddsOfNeighbours(followed, 0.) > 1.;
}

double ShareAlike::Mean() const {
  return (kPriorAlike + num_alike_) / (kPriorWrong + num_wrong_);
}

double OddsOfNeighbours(const FollowedMatch& followed,
                        const double share_alike) {
  const double right = Likelihood(2., 1., followed);
  const double wrong =
      Likelihood(1., followed.by_verification ? 2. : 4., followed);
  return right / ((1. - share_alike) * wrong + share_alike * right);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
