// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/typical_fit.h"

#include <algorithm>

namespace cartographer_ext {
namespace loop_closure {

void TypicalFit::Add(const int trajectory_id, const double fit) {
  fits_.emplace(trajectory_id, ScoreWindow(options_.window))
      .first->second.Add(fit);
}

double TypicalFit::Scale(const int trajectory_id) const {
  const auto found = fits_.find(trajectory_id);
  if (!is_on() || found == fits_.end() ||
      found->second.size() < options_.min_fits) {
    return 1.;
  }
  return std::min(1., std::max(options_.least_scale,
                               found->second.Mean() / options_.reference));
}

}  // namespace loop_closure
}  // namespace cartographer_ext
