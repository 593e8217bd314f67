// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The objective of a search. A run has several metrics; the objective is a
// weighted sum of some of them, aggregated over the recordings.
//
//   objective = "relations"
//   objective = { relations = 1., cpu_seconds = 0.001 }
//
// | name | meaning |
// |-------------------------|------------------------------------------------|
// | relations | mean translational error of the relations, m | | relations_loop
// | the same of those that close loops | | relations_median | their median, m |
// | relations_rotation | mean rotational error, degrees | | broken_fraction |
// share of relations off by more than 0.5 m | | ate | root mean square distance
// to the reference, m | | rpe | relative error over a metre, m | |
// precision_at_recall | share of wrong loops where at least | | |
// `target_recall` of the revisits are closed, | | | else 1 + the missing share
// of that recall | | wall_seconds | of the run | | cpu_seconds | of the run,
// all threads | | loop_search_cpu_seconds | of the loop search | |
// self_consistency        | no ground truth: shares of nodes, rays, loop   | |
// | cycles that contradict the map, and how much | | | walls thicken when seen
// again |
//
// Smaller is better for each.
#ifndef CARTOGRAPHER_EXT_TUNING_OBJECTIVE_H_
#define CARTOGRAPHER_EXT_TUNING_OBJECTIVE_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace tuning {

struct Objective {
  enum class Aggregation { kMean, kMax, kGeometricMean };

  std::map<std::string, double> weights = {{"relations", 1.}};
  Aggregation aggregation = Aggregation::kMean;
  double target_recall = 0.5;

  bool Wants(const std::string& metric) const {
    return weights.count(metric) > 0;
  }
};

std::vector<std::string> ObjectiveNames();

// Parses a Lua value: a name, or a table of weights.
absl::StatusOr<std::map<std::string, double>> ParseWeights(
    const nlohmann::json& value);

// Parses a flag: "relations" or "relations:1,cpu_seconds:0.001".
absl::StatusOr<std::map<std::string, double>> ParseWeights(
    const std::string& text);

// mean, max or geometric_mean.
absl::StatusOr<Objective::Aggregation> ParseAggregation(
    const std::string& name);

// The weighted sum for one run. An error names a metric that is missing
// (relations without ground truth, for example) or not finite.
absl::StatusOr<double> EvaluateRun(
    const Objective& objective, const std::map<std::string, double>& metrics);

// Aggregates over the recordings. In the geometric mean, halving an error has
// the same effect on each, regardless of its size; values are at least 1e-9.
double Aggregate(const Objective& objective, const std::vector<double>& values);

// 1 - precision where recall reaches the target, else 2 - (recall / target).
double PrecisionAtRecall(double precision, double recall, double target);

// Tests whether a result is better on held-out recordings, by the relative
// gains 1 - after / before of their objectives. With three or more recordings
// the mean gain must be significantly above zero by a one-sided t-test at 5 %;
// with one or two, each must improve. The mean must always exceed `least_gain`.
// Empty if the result is better, otherwise the reason why not.
std::string WhyNotBetter(const std::vector<double>& before,
                         const std::vector<double>& after, double least_gain);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_OBJECTIVE_H_
