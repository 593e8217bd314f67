// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/dtw.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

struct Cell {
  double cost = std::numeric_limits<double>::infinity();
  int length = 0;

  bool BetterThan(const Cell& other) const {
    return cost < other.cost || (cost == other.cost && length < other.length);
  }
};

}  // namespace

int VariableWindow(const VariableWindowOptions& options, const double age) {
  const double growth = 1. - std::exp(-options.gamma * std::max(0., age));
  const double length = options.base + options.span * growth;  // C eq. 4
  return std::max(1, static_cast<int>(std::lround(length)));
}

absl::optional<DtwResult> DynamicTimeWarping(
    const int num_query, const int num_reference,
    const std::vector<double>& local_cost, const double band) {
  CHECK_GE(num_query, 0);
  CHECK_GE(num_reference, 0);
  CHECK_EQ(local_cost.size(),
           static_cast<size_t>(num_query) * static_cast<size_t>(num_reference));
  if (num_query == 0 || num_reference == 0) return absl::nullopt;

  // Reference position on the straight line for query i.
  const double slope =
      num_query > 1 ? static_cast<double>(num_reference - 1) / (num_query - 1)
                    : 0.;
  const auto in_band = [&](const int i, const int j) {
    // A single query element has to cover the whole reference.
    return band < 0. || num_query == 1 || std::abs(j - slope * i) <= band;
  };

  std::vector<Cell> previous(num_reference), current(num_reference);
  for (int i = 0; i < num_query; ++i) {
    for (int j = 0; j < num_reference; ++j) {
      current[j] = Cell();
      const double cost =
          local_cost[static_cast<size_t>(i) * num_reference + j];
      if (std::isnan(cost) || !in_band(i, j)) continue;
      Cell best;
      if (i == 0 && j == 0) {
        best.cost = 0.;
      } else {
        if (i > 0 && j > 0) best = previous[j - 1];
        if (i > 0 && previous[j].BetterThan(best)) best = previous[j];
        if (j > 0 && current[j - 1].BetterThan(best)) best = current[j - 1];
      }
      current[j].cost = best.cost + cost;
      current[j].length = best.length + 1;
    }
    std::swap(previous, current);
  }
  const Cell& last = previous.back();
  if (!std::isfinite(last.cost)) return absl::nullopt;
  DtwResult result;
  result.cost = last.cost;
  result.path_length = last.length;
  return result;
}

absl::optional<DtwResult> AsymmetricTimeWarping(
    const int num_query, const int num_reference,
    const std::vector<double>& local_cost, const double band,
    const int max_advance, std::vector<int>* const path) {
  CHECK_GE(num_query, 0);
  CHECK_GE(num_reference, 0);
  CHECK_GE(max_advance, 0);
  CHECK_EQ(local_cost.size(),
           static_cast<size_t>(num_query) * static_cast<size_t>(num_reference));
  if (num_query == 0 || num_reference == 0) return absl::nullopt;

  const double slope =
      num_query > 1 ? static_cast<double>(num_reference - 1) / (num_query - 1)
                    : 0.;
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> previous(num_reference, 0.), current(num_reference);
  std::vector<int> come_from;
  if (path != nullptr) come_from.resize(local_cost.size());
  for (int i = 0; i < num_query; ++i) {
    // Seen from the end, where the band is anchored.
    const double line = num_reference - 1 - slope * (num_query - 1 - i);
    for (int j = 0; j < num_reference; ++j) {
      current[j] = infinity;
      const double cost =
          local_cost[static_cast<size_t>(i) * num_reference + j];
      if (std::isnan(cost) || (band >= 0. && std::abs(j - line) > band)) {
        continue;
      }
      double best = i == 0 ? 0. : infinity;
      int from = j;
      for (int k = std::max(0, j - max_advance); i > 0 && k <= j; ++k) {
        if (previous[k] < best) {
          best = previous[k];
          from = k;
        }
      }
      current[j] = best + cost;
      if (path != nullptr) {
        come_from[static_cast<size_t>(i) * num_reference + j] = from;
      }
    }
    std::swap(previous, current);
  }
  if (!std::isfinite(previous.back())) return absl::nullopt;
  DtwResult result;
  result.cost = previous.back();
  result.path_length = num_query;
  if (path != nullptr) {
    path->resize(num_query);
    int j = num_reference - 1;
    for (int i = num_query - 1; i >= 0; --i) {
      (*path)[i] = j;
      j = come_from[static_cast<size_t>(i) * num_reference + j];
    }
  }
  return result;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
