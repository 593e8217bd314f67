// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/typical_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cartographer_ext {
namespace loop_closure {

double SectorSeen(const std::vector<Eigen::Vector2f>& points) {
  constexpr int kBins = 72;
  std::array<bool, kBins> seen{};
  for (const Eigen::Vector2f& point : points) {
    const double turns =
        (std::atan2(point.y(), point.x()) + kPi) / (2. * kPi);  // in [0, 1]
    seen[std::min(kBins - 1, static_cast<int>(turns * kBins))] = true;
  }
  // The longest run of empty bins, once round and on to its end.
  int longest = 0;
  int empty = 0;
  for (int i = 0; i < 2 * kBins; ++i) {
    empty = seen[i % kBins] ? 0 : empty + 1;
    longest = std::max(longest, std::min(empty, kBins));
  }
  return 2. * kPi * (kBins - longest) / kBins;
}

void TypicalFit::Add(const int trajectory_id, const double fit,
                     const double sector) {
  Fits& fits =
      fits_.emplace(trajectory_id, Fits(options_.window)).first->second;
  fits.scores.Add(fit);
  fits.sectors.Add(sector);
}

double TypicalFit::Scale(const int trajectory_id) const {
  const auto found = fits_.find(trajectory_id);
  if (!is_on() || found == fits_.end() ||
      found->second.scores.size() < options_.min_fits) {
    return 1.;
  }
  const Fits& fits = found->second;
  const double least = fits.sectors.Mean() < options_.narrow_sector
                           ? options_.least_scale_of_narrow
                           : options_.least_scale;
  return std::min(1., std::max(least, fits.scores.Mean() / options_.reference));
}

}  // namespace loop_closure
}  // namespace cartographer_ext
