// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/comparable_trials.h"

#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/tuning/objective.h"
#include "cartographer_ext/tuning/sensitivity.h"

namespace cartographer_ext {
namespace tuning {

ComparableTrials SelectComparable(const std::vector<Trial>& trials) {
  std::map<double, size_t> counts;
  for (const Trial& trial : trials) {
    if (trial.ok) ++counts[trial.fidelity];
  }
  ComparableTrials result;
  if (counts[1.] < kLeastTrialsForSensitivity) {
    for (const auto& entry : counts) {
      if (entry.second > counts[result.fidelity]) result.fidelity = entry.first;
    }
  }
  for (const Trial& trial : trials) {
    if (!trial.ok || trial.fidelity != result.fidelity) continue;
    result.points.push_back(trial.point);
    result.objectives.push_back(trial.objective);
  }
  return result;
}

std::string ToText(const ComparableTrials& trials) {
  return absl::StrCat(
      trials.points.size(), " trials on ",
      trials.fidelity == 1.
          ? "whole recordings"
          : absl::StrFormat("the first %.0f %% of the recordings",
                            100. * trials.fidelity));
}

void KeepIfConfirmed(const double least_gain, TuneResult* const result) {
  if (result->keys.empty()) return;
  const Trial& after = *result->best_holdout;
  result->not_confirmed =
      after.ok ? WhyNotBetter(result->baseline_holdout->objectives,
                              after.objectives, least_gain)
               : after.message;
  if (result->not_confirmed.empty()) return;
  result->best = result->baseline;
  result->keys.clear();
}

}  // namespace tuning
}  // namespace cartographer_ext
