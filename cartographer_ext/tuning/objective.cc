// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/objective.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/types/optional.h"

namespace cartographer_ext {
namespace tuning {
namespace {

absl::Status CheckWeights(const std::map<std::string, double>& weights) {
  const std::vector<std::string> names = ObjectiveNames();
  if (weights.empty()) return absl::InvalidArgumentError("no objective");
  for (const auto& entry : weights) {
    if (std::find(names.begin(), names.end(), entry.first) == names.end()) {
      return absl::InvalidArgumentError(
          absl::StrCat("unknown objective '", entry.first, "', known are ",
                       absl::StrJoin(names, ", ")));
    }
    if (!std::isfinite(entry.second) || entry.second <= 0.) {
      return absl::InvalidArgumentError(absl::StrCat(
          "the weight of objective '", entry.first, "' must be above 0"));
    }
  }
  return absl::OkStatus();
}

// 95 % quantiles of Student's t by degrees of freedom, from 2 on; the last one
// is used for all above.
double Quantile(const size_t degrees_of_freedom) {
  constexpr double kQuantiles[] = {2.920, 2.353, 2.132, 2.015, 1.943,
                                   1.895, 1.860, 1.833, 1.812};
  constexpr size_t kLast = sizeof(kQuantiles) / sizeof(kQuantiles[0]) - 1;
  return kQuantiles[std::min(degrees_of_freedom - 2, kLast)];
}

}  // namespace

std::vector<std::string> ObjectiveNames() {
  return {"relations",
          "relations_loop",
          "relations_median",
          "relations_rotation",
          "broken_fraction",
          "ate",
          "rpe",
          "precision_at_recall",
          "wall_seconds",
          "cpu_seconds",
          "loop_search_cpu_seconds",
          "self_consistency"};
}

absl::StatusOr<std::map<std::string, double>> ParseWeights(
    const nlohmann::json& value) {
  std::map<std::string, double> weights;
  if (value.is_string()) {
    weights[value.get<std::string>()] = 1.;
  } else if (value.is_object()) {
    for (const auto& item : value.items()) {
      if (!item.value().is_number()) {
        return absl::InvalidArgumentError(absl::StrCat(
            "the weight of objective '", item.key(), "' is not a number"));
      }
      weights[item.key()] = item.value().get<double>();
    }
  } else {
    return absl::InvalidArgumentError(
        "objective is neither a name nor a table of weights");
  }
  const absl::Status status = CheckWeights(weights);
  if (!status.ok()) return status;
  return weights;
}

absl::StatusOr<std::map<std::string, double>> ParseWeights(
    const std::string& text) {
  std::map<std::string, double> weights;
  for (const absl::string_view entry :
       absl::StrSplit(text, ',', absl::SkipEmpty())) {
    const std::vector<std::string> parts = absl::StrSplit(entry, ':');
    double weight = 1.;
    if (parts.size() > 2 ||
        (parts.size() == 2 && !absl::SimpleAtod(parts[1], &weight))) {
      return absl::InvalidArgumentError(
          absl::StrCat("objective '", entry, "' is not name:weight"));
    }
    weights[parts[0]] = weight;
  }
  const absl::Status status = CheckWeights(weights);
  if (!status.ok()) return status;
  return weights;
}

absl::StatusOr<Objective::Aggregation> ParseAggregation(
    const std::string& name) {
  if (name == "mean") return Objective::Aggregation::kMean;
  if (name == "max") return Objective::Aggregation::kMax;
  if (name == "geometric_mean") return Objective::Aggregation::kGeometricMean;
  return absl::InvalidArgumentError(absl::StrCat(
      "aggregation '", name, "' is not one of mean, max, geometric_mean"));
}

absl::StatusOr<double> EvaluateRun(
    const Objective& objective, const std::map<std::string, double>& metrics) {
  double sum = 0.;
  const auto value_of = [&metrics](const std::string& name) {
    const auto found = metrics.find(name);
    return found == metrics.end() ? absl::nullopt
                                  : absl::make_optional(found->second);
  };
  for (const auto& entry : objective.weights) {
    absl::optional<double> value = value_of(entry.first);
    if (entry.first == "precision_at_recall") {
      const auto precision = value_of("loop_precision");
      const auto recall = value_of("loop_recall");
      if (precision.has_value() && recall.has_value()) {
        value = PrecisionAtRecall(*precision, *recall, objective.target_recall);
      }
    }
    if (!value.has_value()) {
      return absl::InvalidArgumentError(absl::StrCat(
          "the run gave no '", entry.first, "'; does it have ground truth?"));
    }
    sum += entry.second * *value;
  }
  if (!std::isfinite(sum)) {
    return absl::InvalidArgumentError("the objective is not finite");
  }
  return sum;
}

double Aggregate(const Objective& objective,
                 const std::vector<double>& values) {
  constexpr double kSmallest = 1e-9;
  if (values.empty()) return 0.;
  double sum = 0.;
  for (const double value : values) {
    switch (objective.aggregation) {
      case Objective::Aggregation::kMean:
        sum += value;
        break;
      case Objective::Aggregation::kMax:
        sum = std::max(sum, value);
        break;
      case Objective::Aggregation::kGeometricMean:
        sum += std::log(std::max(value, kSmallest));
        break;
    }
  }
  if (objective.aggregation == Objective::Aggregation::kMax) return sum;
  const double mean = sum / static_cast<double>(values.size());
  return objective.aggregation == Objective::Aggregation::kMean
             ? mean
             : std::exp(mean);
}

double PrecisionAtRecall(const double precision, const double recall,
                         const double target) {
  if (recall >= target) return 1. - precision;
  return 2. - recall / target;
}

std::string WhyNotBetter(const std::vector<double>& before,
                         const std::vector<double>& after,
                         const double least_gain) {
  const size_t count = std::min(before.size(), after.size());
  if (count == 0) return "no held-out recording could be judged";
  std::vector<double> gains;
  double mean = 0.;
  for (size_t i = 0; i != count; ++i) {
    const double scale = std::max(std::abs(before[i]), std::abs(after[i]));
    gains.push_back(scale > 0. ? (before[i] - after[i]) / scale : 0.);
    mean += gains.back() / static_cast<double>(count);
  }
  const std::string gain = absl::StrFormat("%+.1f %%", -100. * mean);
  if (!(mean > least_gain)) {
    return absl::StrFormat("held-out recordings change by %s", gain);
  }
  if (count < 3) {
    if (*std::min_element(gains.begin(), gains.end()) > 0.) return "";
    return absl::StrFormat(
        "held-out recordings change by %s, but not all of them improve", gain);
  }
  double squares = 0.;
  for (const double one : gains) squares += (one - mean) * (one - mean);
  const double error =
      std::sqrt(squares / static_cast<double>(count * (count - 1)));
  if (mean > Quantile(count - 1) * error) return "";
  return absl::StrFormat(
      "held-out recordings change by %s +- %.1f %%, which is not significant",
      gain, 100. * error);
}

}  // namespace tuning
}  // namespace cartographer_ext
