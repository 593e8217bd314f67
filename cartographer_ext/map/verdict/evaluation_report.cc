// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/evaluation_report.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using nlohmann::ordered_json;

constexpr double kBrokenFraction = 0.02;
constexpr double kDoubtfulFraction = 0.002;
constexpr double kBrokenRmse = 1.;      // metres
constexpr double kDoubtfulRmse = 0.5;   // metres
constexpr double kLargeResidual = 0.5;  // metres

enum Severity { kUnknown, kSound, kDoubtful, kBroken };
constexpr const char* kWords[] = {"unknown", "sound", "doubtful", "broken"};

ordered_json ToJson(const RelationsSummary& summary) {
  ordered_json json;
  json["count"] = summary.count;
  json["translation"] = evaluation::ToJson(summary.translation);
  json["squared_translation"] = {{"mean", summary.squared_translation.mean},
                                 {"std", summary.squared_translation.std}};
  json["rotation_degrees"] = evaluation::ToJson(summary.rotation_degrees);
  json["squared_rotation_degrees"] = {
      {"mean", summary.squared_rotation_degrees.mean},
      {"std", summary.squared_rotation_degrees.std}};
  json["fraction_above_half_metre"] = summary.fraction_above_half_metre;
  return json;
}

ordered_json ToJson(const RelationsMetric& metric) {
  ordered_json json = ToJson(metric.all);
  json["not_covered"] = metric.num_not_covered;
  json["loop"] = ToJson(metric.loop);
  json["sequential"] = ToJson(metric.sequential);
  return json;
}

ordered_json OrNull(const absl::optional<double>& value) {
  return value.has_value() ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json ToJson(const LoopStatistics& loops) {
  ordered_json json;
  json["accepted"] = loops.accepted;
  // A map does not store which candidates were rejected; its side file does.
  json["rejected"] = loops.rejected.value_or(0);
  json["rejected_is_known"] = loops.rejected.has_value();
  json["judged"] = loops.judged;
  json["correct"] = loops.correct;
  json["precision"] = OrNull(loops.precision);
  json["revisits"] = loops.revisits;
  json["revisits_closed"] = loops.revisits_closed;
  json["recall"] = OrNull(loops.recall);
  json["residual_translation"] = evaluation::ToJson(loops.residual_translation);
  json["residual_rotation_degrees"] =
      evaluation::ToJson(loops.residual_rotation_degrees);
  return json;
}

std::string Row(const std::string& label, const RelationsSummary& summary) {
  return absl::StrFormat(
      "  %-11s %6d   %7.4f %7.4f %7.4f   %7.3f %7.3f %7.3f   %6.2f %%\n", label,
      summary.count, summary.translation.mean, summary.translation.std,
      summary.translation.median, summary.rotation_degrees.mean,
      summary.rotation_degrees.std, summary.rotation_degrees.median,
      100. * summary.fraction_above_half_metre);
}

std::string Table(const std::string& title, const RelationsMetric& metric) {
  std::string text = absl::StrCat(
      title, "\n",
      "                       translation [m]           rotation [deg]\n"
      "               count      mean     std  median      mean     std  median"
      "   > 0.5 m\n");
  absl::StrAppend(&text, Row("all", metric.all), Row("loops", metric.loop),
                  Row("sequential", metric.sequential));
  if (metric.num_not_covered > 0) {
    absl::StrAppend(&text, "  ", metric.num_not_covered,
                    " relations are outside the trajectory\n");
  }
  return text;
}

std::string Percent(const absl::optional<double>& value) {
  return value.has_value() ? absl::StrFormat("%.1f %%", 100. * *value)
                           : std::string("unknown");
}

}  // namespace

Verdict Judge(const Evaluation& evaluation) {
  Severity severity = kUnknown;
  Verdict verdict;
  const auto raise = [&](const Severity to) {
    severity = std::max(severity, to);
  };
  if (evaluation.relations.has_value()) {
    // The sequential relations look good in a folded map, too.
    const bool has_loops = evaluation.relations->loop.count > 0;
    const RelationsSummary& summary =
        has_loops ? evaluation.relations->loop : evaluation.relations->all;
    const double fraction = summary.fraction_above_half_metre;
    raise(fraction > kBrokenFraction     ? kBroken
          : fraction > kDoubtfulFraction ? kDoubtful
                                         : kSound);
    verdict.reasons.push_back(absl::StrFormat(
        "%.1f %% of the %d %s are off by more than half a metre",
        100. * fraction, summary.count,
        has_loops ? "relations that close loops" : "relations"));
  }
  if (evaluation.trajectory.has_value()) {
    const double rmse = evaluation.trajectory->ate.rmse;
    raise(rmse > kBrokenRmse     ? kBroken
          : rmse > kDoubtfulRmse ? kDoubtful
                                 : kSound);
    verdict.reasons.push_back(absl::StrFormat(
        "the trajectory is %.3f m from the reference (root mean square)",
        rmse));
  }
  if (evaluation.consistency.has_value()) {
    const SelfConsistency& consistency = *evaluation.consistency;
    if (severity == kUnknown) {
      raise(consistency.word == "broken"     ? kBroken
            : consistency.word == "doubtful" ? kDoubtful
            : consistency.word == "sound"    ? kSound
                                             : kUnknown);
    }
    const size_t headline = verdict.reasons.size();
    verdict.reasons.insert(verdict.reasons.end(), consistency.reasons.begin(),
                           consistency.reasons.end());
    if (consistency.word != kWords[severity] &&
        headline < verdict.reasons.size()) {
      verdict.reasons[headline] =
          absl::StrCat("without ground truth the verdict would be ",
                       consistency.word, ": ", verdict.reasons[headline]);
    }
  }
  if (evaluation.loops.has_value() && evaluation.loops->accepted > 0) {
    const auto& loops = evaluation.loops->loops;
    const auto num_large = std::count_if(
        loops.begin(), loops.end(), [](const LoopJudgement& loop) {
          return loop.residual_translation > kLargeResidual;
        });
    const double fraction =
        static_cast<double>(num_large) / static_cast<double>(loops.size());
    // Loops that the optimisation has overruled do no harm where truth, or the
    // map itself, finds none.
    if (severity == kUnknown && !evaluation.consistency.has_value() &&
        fraction > kBrokenFraction) {
      raise(kDoubtful);
    }
    verdict.reasons.push_back(absl::StrFormat(
        "%d of the %d loops disagree with the map by more than half a metre",
        num_large, loops.size()));
    if (evaluation.loops->precision.has_value()) {
      verdict.reasons.push_back(
          absl::StrFormat("%d of the %d loops that can be judged are right",
                          evaluation.loops->correct, evaluation.loops->judged));
    }
  }
  verdict.word = kWords[severity];
  return verdict;
}

ordered_json ToJson(const Statistics& statistics) {
  return {{"count", statistics.count}, {"mean", statistics.mean},
          {"std", statistics.std},     {"median", statistics.median},
          {"rmse", statistics.rmse},   {"max", statistics.max}};
}

ordered_json ToJson(const Evaluation& evaluation) {
  ordered_json json;
  json["trajectory_metres"] = evaluation.trajectory_metres;
  if (evaluation.relations.has_value()) {
    json["relations"] = ToJson(*evaluation.relations);
  }
  if (evaluation.node_relations.has_value()) {
    json["node_relations"] = ToJson(*evaluation.node_relations);
  }
  if (evaluation.trajectory.has_value()) {
    json["ate"] = ToJson(evaluation.trajectory->ate);
    json["ate"]["rotation_degrees"] =
        ToJson(evaluation.trajectory->ate_rotation_degrees);
    json["rpe"] = ToJson(evaluation.trajectory->rpe);
    json["rpe"]["rotation_degrees"] =
        ToJson(evaluation.trajectory->rpe_rotation_degrees);
    json["rpe"]["distance_metres"] = evaluation.trajectory->rpe_distance;
  }
  if (evaluation.loops.has_value()) {
    json["loops"] = ToJson(*evaluation.loops);
  }
  if (evaluation.consistency.has_value()) {
    json["consistency"] = ToJson(*evaluation.consistency);
  }
  const Verdict verdict = Judge(evaluation);
  json["verdict"] = verdict.word;
  json["reasons"] = verdict.reasons;
  return json;
}

std::string ToText(const Evaluation& evaluation) {
  std::string text;
  if (evaluation.relations.has_value()) {
    absl::StrAppend(&text, Table("Relations", *evaluation.relations));
  }
  if (evaluation.node_relations.has_value()) {
    absl::StrAppend(&text,
                    Table("Relations, at the nodes and interpolated in time",
                          *evaluation.node_relations));
  }
  if (evaluation.trajectory.has_value()) {
    const TrajectoryErrors& errors = *evaluation.trajectory;
    absl::StrAppendFormat(
        &text,
        "Absolute trajectory error   rmse %.4f m  mean %.4f m  max %.4f m  "
        "(%d poses, %.1f m)\n",
        errors.ate.rmse, errors.ate.mean, errors.ate.max, errors.num_pairs,
        evaluation.trajectory_metres);
    if (errors.rpe.count > 0) {
      absl::StrAppendFormat(
          &text,
          "Relative error over %.1f m   rmse %.4f m  mean %.4f m  max %.4f m  "
          "mean %.3f deg\n",
          errors.rpe_distance, errors.rpe.rmse, errors.rpe.mean, errors.rpe.max,
          errors.rpe_rotation_degrees.mean);
    } else {
      absl::StrAppendFormat(
          &text, "Relative error over %.1f m   unknown: no two poses are %s\n",
          errors.rpe_distance, "that far apart along the path");
    }
  }
  if (evaluation.loops.has_value()) {
    const LoopStatistics& loops = *evaluation.loops;
    absl::StrAppendFormat(&text, "Loops   %d accepted", loops.accepted);
    if (loops.judged > 0) {
      absl::StrAppendFormat(&text, ", precision %s (%d judged)",
                            Percent(loops.precision), loops.judged);
    }
    if (loops.revisits > 0) {
      absl::StrAppendFormat(&text, ", recall %s (%d of %d revisits)",
                            Percent(loops.recall), loops.revisits_closed,
                            loops.revisits);
    }
    absl::StrAppend(&text, "\n");
    absl::StrAppendFormat(&text,
                          "        residuals in the map: mean %.4f m, max %.4f "
                          "m, mean %.3f deg\n",
                          loops.residual_translation.mean,
                          loops.residual_translation.max,
                          loops.residual_rotation_degrees.mean);
  }
  if (evaluation.consistency.has_value()) {
    absl::StrAppend(&text, ToText(*evaluation.consistency));
  }
  const Verdict verdict = Judge(evaluation);
  absl::StrAppend(&text, "Verdict: ", verdict.word, "\n");
  for (const std::string& reason : verdict.reasons) {
    absl::StrAppend(&text, "  ", reason, "\n");
  }
  return text;
}

}  // namespace evaluation
}  // namespace cartographer_ext
