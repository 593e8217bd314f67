// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace cartographer_ext {
namespace tuning {
namespace {

constexpr int kGroups = 4;

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.) /
         static_cast<double>(values.size());
}

double SumOfSquares(const std::vector<double>& values, const double mean) {
  double sum = 0.;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum;
}

int GroupOf(const Parameter& parameter, const Value& value) {
  const double unit = parameter.ToUnit(value);
  const int groups = parameter.kind == Parameter::Kind::kChoice
                         ? static_cast<int>(parameter.choices.size())
                         : kGroups;
  return std::min(static_cast<int>(unit * groups), groups - 1);
}

// The correlation ratio, less what is expected of unrelated values (Kelley's
// epsilon squared).
double Effect(const std::vector<int>& groups,
              const std::vector<double>& ranks) {
  const double mean = Mean(ranks);
  const double total = SumOfSquares(ranks, mean);
  std::map<int, std::vector<double>> members;
  for (size_t i = 0; i < ranks.size(); ++i) {
    members[groups[i]].push_back(ranks[i]);
  }
  const double degrees =
      static_cast<double>(ranks.size()) - static_cast<double>(members.size());
  if (total <= 0. || degrees <= 0.) return 0.;
  double within = 0.;
  for (const auto& entry : members) {
    within += SumOfSquares(entry.second, Mean(entry.second));
  }
  const double unexplained =
      (within / degrees) / (total / (static_cast<double>(ranks.size()) - 1.));
  return std::max(0., 1. - unexplained);
}

double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = Mean(a), mean_b = Mean(b);
  double product = 0.;
  for (size_t i = 0; i < a.size(); ++i) {
    product += (a[i] - mean_a) * (b[i] - mean_b);
  }
  const double scale =
      std::sqrt(SumOfSquares(a, mean_a) * SumOfSquares(b, mean_b));
  return scale > 0. ? product / scale : 0.;
}

}  // namespace

std::vector<double> Ranks(const std::vector<double>& values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&values](size_t a, size_t b) {
    return values[a] < values[b];
  });
  std::vector<double> ranks(values.size());
  for (size_t begin = 0; begin < order.size();) {
    size_t end = begin;
    while (end < order.size() && values[order[end]] == values[order[begin]]) {
      ++end;
    }
    const double rank = 0.5 * static_cast<double>(begin + 1 + end);
    for (size_t i = begin; i < end; ++i) ranks[order[i]] = rank;
    begin = end;
  }
  return ranks;
}

std::vector<Sensitivity> ComputeSensitivity(
    const std::vector<Parameter>& parameters, const std::vector<Point>& points,
    const std::vector<double>& objectives) {
  std::vector<Sensitivity> result;
  const std::vector<double> ranks = Ranks(objectives);
  for (size_t i = 0; i < parameters.size(); ++i) {
    Sensitivity sensitivity;
    sensitivity.key = parameters[i].key;
    sensitivity.trials = static_cast<int>(points.size());
    if (points.size() >= kLeastTrialsForSensitivity) {
      std::vector<int> groups;
      std::vector<double> units;
      for (const Point& point : points) {
        groups.push_back(GroupOf(parameters[i], point[i]));
        units.push_back(parameters[i].ToUnit(point[i]));
      }
      sensitivity.effect = Effect(groups, ranks);
      if (parameters[i].kind != Parameter::Kind::kChoice) {
        sensitivity.trend = Correlation(Ranks(units), ranks);
      }
    }
    result.push_back(sensitivity);
  }
  return result;
}

}  // namespace tuning
}  // namespace cartographer_ext
