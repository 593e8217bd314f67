// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/result_writer.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/types/optional.h"
#include "cartographer_ext/configuration/lua_value.h"
#include "cartographer_ext/tuning/comparable_trials.h"
#include "cartographer_ext/tuning/sensitivity.h"

namespace cartographer_ext {
namespace tuning {
namespace {

constexpr char kBlockName[] = "cartographer_ext";

// "-31.2 %"; empty if unknown.
std::string Change(const double before, const double after) {
  if (!(std::abs(before) > 0.)) return "";
  return absl::StrFormat("%+.1f %%", 100. * (after / before - 1.));
}

// The names of the journal tell by their sizes whether files are still the same:
// "run.clf@48213+run.tum@1034" is "run.clf".
std::string ShownName(const std::string& name) {
  for (size_t at = name.find('@'); at != std::string::npos;
       at = name.find('@', at + 1)) {
    const size_t end = name.find_first_not_of("0123456789", at + 1);
    if (end != at + 1 && (end == std::string::npos || name[end] == '+')) {
      return name.substr(0, at);
    }
  }
  return name;
}

absl::optional<double> ObjectiveOf(const absl::optional<Trial>& trial) {
  if (!trial.has_value() || !trial->ok) return absl::nullopt;
  return trial->objective;
}

// Our blocks may be one table in several places, and tables in them may be left
// out, so those that lead to a key are replaced by copies.
constexpr char kCopyFunction[] = R"(
local function copied(original)
  local copy = {}
  for key, value in pairs(original or {}) do copy[key] = value end
  return copy
end
)";

std::string CopyTables(const std::string& key,
                       std::set<std::string>* const copied) {
  const std::vector<std::string> parts = absl::StrSplit(key, '.');
  std::string text, path;
  bool in_block = false;
  for (size_t i = 0; i + 1 < parts.size(); ++i) {
    absl::StrAppend(&path, i > 0 ? "." : "", parts[i]);
    in_block |= parts[i] == kBlockName;
    if (in_block && copied->insert(path).second) {
      absl::StrAppend(&text, path, " = copied(", path, ")\n");
    }
  }
  return text;
}

std::string Gain(const KeyResult& key, const Trial& best,
                 const size_t num_inputs) {
  if (!key.gain.has_value()) return "gain not measured";
  return absl::StrFormat(
      "gain %.4g (%.1f %% of the result), better on %d of %d recordings",
      *key.gain,
      best.objective != 0. ? 100. * *key.gain / std::abs(best.objective) : 0.,
      key.better_on, num_inputs);
}

std::string NothingText(const TuneResult& result) {
  return result.not_confirmed.empty()
             ? "Nothing was better than the initial configuration."
             : absl::StrCat(
                   "Nothing is changed: the gain on the inputs is not "
                   "confirmed, ",
                   result.not_confirmed, ".");
}

nlohmann::ordered_json TrialJson(const std::vector<Parameter>& parameters,
                                 const Trial& trial) {
  nlohmann::ordered_json json;
  json["values"] = ToAssignment(parameters, trial.point);
  json["fidelity"] = trial.fidelity;
  json["status"] = trial.ok ? "ok" : "failed";
  if (trial.ok) {
    json["objective"] = trial.objective;
    json["objectives"] = trial.objectives;
  } else {
    json["message"] = trial.message;
  }
  return json;
}

nlohmann::ordered_json OrNull(const absl::optional<double>& value) {
  if (!value.has_value()) return nullptr;
  return *value;
}

}  // namespace

std::string Confidence(const KeyResult& key, const size_t num_inputs) {
  if (!key.gain.has_value()) return "not measured";
  const size_t better = static_cast<size_t>(key.better_on);
  if (better == num_inputs && num_inputs >= 3) return "high";
  if (better == num_inputs && num_inputs == 2) return "medium";
  if (num_inputs > 2 && 3 * better >= 2 * num_inputs) return "medium";
  return "low";
}

std::string ToLuaFile(const TuneResult& result, const ResultContext& context) {
  std::string text = absl::StrCat(
      "-- Found by cartographer_ext_tune for ", context.configuration,
      ". A complete configuration; use it with ", context.configuration,
      "\n-- and what it includes in the folders searched:\n"
      "--   -configuration_directory=.,",
      absl::StrJoin(context.directories, ","),
      " -configuration_basename=", context.filename, "\n--\n");
  absl::StrAppendFormat(&text, "-- Objective: %s, %.6g -> %.6g",
                        context.objective, result.baseline.objective,
                        result.best.objective);
  const std::string change =
      Change(result.baseline.objective, result.best.objective);
  absl::StrAppend(&text, change.empty() ? "" : " (" + change + ")", "\n");
  for (size_t i = 0; i < context.inputs.size(); ++i) {
    absl::StrAppendFormat(
        &text, "--   %s: %.6g -> %.6g\n", ShownName(context.inputs[i].name),
        result.baseline.objectives[i], result.best.objectives[i]);
  }
  const auto before = ObjectiveOf(result.baseline_holdout);
  const auto after = ObjectiveOf(result.best_holdout);
  if (before.has_value() && after.has_value()) {
    absl::StrAppendFormat(&text, "-- Held out: %.6g -> %.6g\n", *before,
                          *after);
  } else if (result.best_holdout.has_value()) {
    absl::StrAppend(&text, "-- Held out: unknown, a run failed\n");
  }
  for (const FoldResult& fold : result.folds) {
    absl::StrAppendFormat(&text,
                          "-- Searched without %d of them: %.6g -> "
                          "%.6g on these\n",
                          fold.held_out.size(), fold.before, fold.after);
  }
  const std::string include =
      absl::StrCat("include ", evaluation::ToLua(context.configuration));
  if (result.keys.empty()) {
    return absl::StrCat(text, "--\n-- ", NothingText(result), "\nreturn ",
                        include, "\n");
  }
  std::set<std::string> copied;
  std::string assignments;
  std::string includes;
  for (const KeyResult& key : result.keys) {
    const std::string comment = absl::StrCat(
        Gain(key, result.best, context.inputs.size()),
        "; confidence: ", Confidence(key, context.inputs.size()), "\n");
    if (IsIncludeKey(key.key)) {
      absl::StrAppend(&includes, "\n-- Not there before; ", comment, "include ",
                      evaluation::ToLua(key.after), "\n");
      continue;
    }
    absl::StrAppend(&assignments,
                    "\n-- Before: ", evaluation::ToLua(key.before), "; ",
                    comment, CopyTables(key.key, &copied), key.key, " = ",
                    evaluation::ToLua(key.after), "\n");
  }
  // It returns the very tables that are changed below.
  absl::StrAppend(&text, "\nlocal configuration = ", include, "\n", includes,
                  copied.empty() ? "" : kCopyFunction, assignments,
                  "\nreturn configuration\n");
  return text;
}

std::string ToText(const TuneResult& result, const ResultContext& context) {
  std::string text;
  int failed = 0, partial = 0;
  for (const Trial& trial : result.trials) {
    failed += !trial.ok;
    partial += trial.ok && trial.fidelity != 1.;
  }
  absl::StrAppendFormat(
      &text,
      "Trials     %d (%d on a part of the recordings, %d failed), %d runs, %d "
      "more known from the journal, %.0f CPU s\n",
      result.trials.size(), partial, failed, result.num_runs,
      result.num_known_runs, result.cpu_seconds);
  absl::StrAppendFormat(
      &text, "Objective  %s: %.6g -> %.6g  %s\n", context.objective,
      result.baseline.objective, result.best.objective,
      Change(result.baseline.objective, result.best.objective));
  for (size_t i = 0; i < context.inputs.size(); ++i) {
    absl::StrAppendFormat(
        &text, "           %-40s %.6g -> %.6g  %s\n",
        ShownName(context.inputs[i].name), result.baseline.objectives[i],
        result.best.objectives[i],
        Change(result.baseline.objectives[i], result.best.objectives[i]));
  }
  if (result.best_holdout.has_value()) {
    const auto before = ObjectiveOf(result.baseline_holdout);
    const auto after = ObjectiveOf(result.best_holdout);
    if (before.has_value() && after.has_value()) {
      absl::StrAppendFormat(&text, "Held out   %.6g -> %.6g  %s\n", *before,
                            *after, Change(*before, *after));
    } else {
      absl::StrAppend(&text, "Held out   ",
                      after.has_value() ? result.baseline_holdout->message
                                        : result.best_holdout->message,
                      "\n");
    }
  }
  for (const FoldResult& fold : result.folds) {
    absl::StrAppendFormat(&text, "Fold       %.6g -> %.6g  %s on", fold.before,
                          fold.after, Change(fold.before, fold.after));
    for (const std::string& name : fold.held_out) {
      absl::StrAppend(&text, " ", ShownName(name));
    }
    absl::StrAppend(&text, "\n");
  }
  if (result.keys.empty()) {
    absl::StrAppend(&text, NothingText(result), "\n");
  }
  for (const KeyResult& key : result.keys) {
    absl::StrAppend(&text, "\n", key.key, "\n  ", evaluation::ToLua(key.before),
                    " -> ", evaluation::ToLua(key.after), ", ",
                    Gain(key, result.best, context.inputs.size()),
                    ", confidence: ", Confidence(key, context.inputs.size()),
                    "\n");
  }
  const ComparableTrials trials = SelectComparable(result.trials);
  if (trials.points.size() < kLeastTrialsForSensitivity) {
    absl::StrAppendFormat(
        &text, "\nSensitivity: unknown from %s, at least %d are needed\n",
        ToText(trials), kLeastTrialsForSensitivity);
    return text;
  }
  absl::StrAppend(&text, "\nSensitivity, from ", ToText(trials),
                  ":\n  effect  trend  key\n");
  auto sensitivities =
      ComputeSensitivity(context.parameters, trials.points, trials.objectives);
  std::stable_sort(sensitivities.begin(), sensitivities.end(),
                   [](const Sensitivity& a, const Sensitivity& b) {
                     return a.effect > b.effect;
                   });
  for (const Sensitivity& sensitivity : sensitivities) {
    absl::StrAppendFormat(&text, "  %6.2f  %+5.2f  %s\n", sensitivity.effect,
                          sensitivity.trend, sensitivity.key);
  }
  return text;
}

nlohmann::ordered_json ToJson(const TuneResult& result,
                              const ResultContext& context) {
  nlohmann::ordered_json json;
  json["configuration"] = context.configuration;
  json["objective"] = context.objective;
  for (const TuneInput& input : context.inputs) {
    json["inputs"].push_back(input.name);
  }
  nlohmann::ordered_json keys = nlohmann::ordered_json::object();
  nlohmann::ordered_json details = nlohmann::ordered_json::array();
  for (const KeyResult& key : result.keys) {
    keys[key.key] = key.after;
    details.push_back({{"key", key.key},
                       {"before", key.before},
                       {"after", key.after},
                       {"gain", OrNull(key.gain)},
                       {"better_on", key.better_on},
                       {"confidence", Confidence(key, context.inputs.size())}});
  }
  json["baseline"] = {
      {"objective", result.baseline.objective},
      {"objectives", result.baseline.objectives},
      {"holdout", OrNull(ObjectiveOf(result.baseline_holdout))}};
  json["best"] = {{"objective", result.best.objective},
                  {"objectives", result.best.objectives},
                  {"holdout", OrNull(ObjectiveOf(result.best_holdout))},
                  {"keys", keys}};
  json["changes"] = details;
  json["not_confirmed"] = result.not_confirmed;
  json["trials"] = result.trials.size();
  json["runs"] = result.num_runs;
  json["runs_from_journal"] = result.num_known_runs;
  json["cpu_seconds"] = result.cpu_seconds;
  json["ended_by_budget"] = result.ended_by_budget;
  json["folds"] = nlohmann::ordered_json::array();
  for (const FoldResult& fold : result.folds) {
    json["folds"].push_back(
        {{"held_out", fold.held_out},
         {"values", ToAssignment(context.parameters, fold.point)},
         {"before", fold.before},
         {"after", fold.after}});
  }
  const ComparableTrials trials = SelectComparable(result.trials);
  json["sensitivity_trials"] = {{"fidelity", trials.fidelity},
                                {"count", trials.points.size()}};
  json["sensitivity"] = nlohmann::ordered_json::array();
  for (const Sensitivity& sensitivity : ComputeSensitivity(
           context.parameters, trials.points, trials.objectives)) {
    json["sensitivity"].push_back({{"key", sensitivity.key},
                                   {"effect", sensitivity.effect},
                                   {"trend", sensitivity.trend}});
  }
  json["trial_list"] = nlohmann::ordered_json::array();
  for (const Trial& trial : result.trials) {
    json["trial_list"].push_back(TrialJson(context.parameters, trial));
  }
  return json;
}

}  // namespace tuning
}  // namespace cartographer_ext
