// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/robustness_sweep.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/common/progress.h"
#include "cartographer_ext/experiments/sweep_graphs.h"
#include "cartographer_ext/io/bounded_json.h"
#include "cartographer_ext/io/keyed_journal.h"
#include "cartographer_ext/map/pose_graph_files.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace experiments {
namespace {

using evaluation::ReadTruth;
using optimization::PoseGraph;

std::string Key(const SweepRun& run) {
  return absl::StrCat(run.is_family ? "family " : "", run.dataset, "|",
                      run.kernel, "|", run.type, "|", run.count, "|", run.seed);
}

// The runs that are done, by Key().
using SweepJournal = io::KeyedJournal<SweepRun>;

absl::Status OpenJournal(const SweepOptions& options, SweepJournal* journal) {
  return journal->Open(
      options.journal_filename,
      {"cartographer_ext_robustness", "robustness journal", "sweep",
       "its runs had other options"},
      JournalFingerprint(options),
      [](const nlohmann::json& line)
          -> absl::StatusOr<std::pair<std::string, SweepRun>> {
        SweepRun run;
        if (!FromJson(line, &run)) {
          return absl::InvalidArgumentError("not a run of a sweep");
        }
        return std::make_pair(Key(run), run);
      });
}

double AteLimit(const SweepOptions& options, const SweepGraph& dataset,
                const std::string& type) {
  if (dataset.is_family) {
    return options.ate_limit + 0.5 * dataset.inherent_ate;
  }
  const auto limit = options.ate_limits.find(dataset.name);
  if (limit != options.ate_limits.end()) return limit->second;
  return type[0] == 'L' ? options.ate_limit_local : options.ate_limit;
}

absl::Status RunOne(const SweepOptions& options, const SweepGraph& dataset,
                    SweepRun* const run) {
  const size_t first_outlier = dataset.graph.edges.size();
  const auto with_outliers =
      WithOutliers(options, dataset, run->type, run->count, run->seed);
  if (!with_outliers.ok()) return with_outliers.status();
  const PoseGraph& graph = *with_outliers;
  optimization::OptimizeOptions optimize = options.optimize;
  optimize.method = run->kernel;
  const auto result = optimization::Optimize(graph, optimize);
  if (!result.ok()) return result.status();
  run->cpu_seconds = result->cpu_seconds;
  run->iterations = result->iterations;
  run->converged = result->converged;
  run->ate =
      optimization::AbsoluteTrajectoryError(result->poses, dataset.optimum);
  run->rpe = optimization::RelativePoseError(graph.edges, result->poses,
                                             dataset.optimum);
  run->truncated = result->truncated_chi2;
  run->selected_truncated = result->member.empty()
                                ? result->truncated_chi2
                                : result->member_truncated_chi2;
  const std::vector<double>& steps = result->step_seconds;
  if (!steps.empty()) {
    run->step_mean =
        1e3 * std::accumulate(steps.begin(), steps.end(), 0.) / steps.size();
    run->step_p99 = 1e3 * NearestRankQuantile(steps, 0.99);
    run->step_max = 1e3 * NearestRankQuantile(steps, 1.);
  }
  const auto truth = options.truths.find(dataset.name);
  if (truth != options.truths.end()) {
    const auto poses = ReadTruth(graph, result->poses, truth->second);
    if (!poses.ok()) return poses.status();
    run->ate_truth =
        optimization::AbsoluteTrajectoryError(result->poses, *poses);
  }
  run->success_by_ate = run->ate <= AteLimit(options, dataset, run->type);
  const double deviation = DeviationFromOptimum(dataset, result->poses);
  if (std::isfinite(deviation)) run->deviation = deviation;
  run->success = run->success_by_ate || deviation <= kSameMap;
  run->inherent_ate = dataset.inherent_ate;
  // What the right map costs in the metric of the result.
  std::vector<optimization::WhitenedEdge> edges = optimization::WithNoiseScale(
      optimization::Whiten(graph.edges), result->applied_odometry_scale,
      result->applied_loop_scale);
  const optimization::LoopScore score = optimization::ScoreLoops(
      edges, first_outlier, result->accepted, dataset.optimum);
  run->precision = score.precision;
  run->recall = score.recall;
  std::vector<Pose2> right = dataset.optimum;
  const auto fixed = optimization::Whiten(optimization::FixedPoseEdges(graph));
  edges.insert(edges.end(), fixed.begin(), fixed.end());
  optimization::PolishTruncated(edges, result->applied_gate, 30, &right,
                                nullptr);
  edges.resize(graph.edges.size());
  run->right_truncated =
      optimization::TruncatedCost(edges, right, result->applied_gate);
  run->undecidable =
      !run->success && run->truncated < run->right_truncated * (1. - 1e-9);
  return absl::OkStatus();
}

}  // namespace

nlohmann::ordered_json ToJson(const SweepRun& run) {
  nlohmann::ordered_json json;
  json["dataset"] = run.dataset;
  json["kernel"] = run.kernel;
  json["type"] = run.type;
  json["count"] = run.count;
  json["requested_count"] = run.requested_count;
  json["seed"] = run.seed;
  json["cpu_seconds"] = run.cpu_seconds;
  json["ate"] = run.ate;
  json["ate_truth"] = run.ate_truth;
  json["rpe"] = run.rpe;
  json["precision"] = run.precision;
  json["recall"] = run.recall;
  json["truncated"] = run.truncated;
  json["selected_truncated"] = run.selected_truncated;
  json["iterations"] = run.iterations;
  json["converged"] = run.converged;
  if (run.kernel == "r_isam") {
    json["step_milliseconds"] = {
        {"mean", run.step_mean}, {"p99", run.step_p99}, {"max", run.step_max}};
  }
  json["deviation"] = run.deviation;
  json["success"] = run.success;
  json["success_by_ate"] = run.success_by_ate;
  json["right_truncated"] = run.right_truncated;
  json["undecidable"] = run.undecidable;
  if (run.is_family) {
    json["family"] = run.dataset;
    json["inherent_ate"] = run.inherent_ate;
  }
  return json;
}

bool FromJson(const nlohmann::json& json, SweepRun* const run) {
  if (!json.is_object()) return false;
  for (const char* key : {"dataset", "kernel", "type", "requested_count"}) {
    if (!json.contains(key) || !json[key].is_string()) return false;
  }
  for (const char* key : {"cpu_seconds", "ate", "ate_truth", "rpe", "precision",
                          "recall", "truncated", "selected_truncated"}) {
    if (!json.contains(key) || !json[key].is_number()) return false;
  }
  for (const char* key : {"converged", "success"}) {
    if (!json.contains(key) || !json[key].is_boolean()) return false;
  }
  if (!io::TakeInt(json, "count", &run->count) ||
      !io::TakeInt(json, "seed", &run->seed) ||
      !io::TakeInt(json, "iterations", &run->iterations)) {
    return false;
  }
  run->dataset = json["dataset"].get<std::string>();
  run->kernel = json["kernel"].get<std::string>();
  run->type = json["type"].get<std::string>();
  run->requested_count = json["requested_count"].get<std::string>();
  run->cpu_seconds = json["cpu_seconds"].get<double>();
  run->ate = json["ate"].get<double>();
  run->ate_truth = json["ate_truth"].get<double>();
  run->rpe = json["rpe"].get<double>();
  run->precision = json["precision"].get<double>();
  run->recall = json["recall"].get<double>();
  run->truncated = json["truncated"].get<double>();
  run->selected_truncated = json["selected_truncated"].get<double>();
  run->converged = json["converged"].get<bool>();
  run->success = json["success"].get<bool>();
  // Missing from journals of earlier versions.
  run->deviation = io::NumberIn(json, "deviation", -1.);
  run->success_by_ate = io::TruthIn(json, "success_by_ate", run->success);
  run->right_truncated = io::NumberIn(json, "right_truncated", 0.);
  run->undecidable = io::TruthIn(json, "undecidable", false);
  run->is_family = json.contains("family");
  run->inherent_ate = io::NumberIn(json, "inherent_ate", -1.);
  if (json.contains("step_milliseconds")) {
    const nlohmann::json& steps = json["step_milliseconds"];
    for (const char* key : {"mean", "p99", "max"}) {
      if (!steps.contains(key) || !steps[key].is_number()) return false;
    }
    run->step_mean = steps["mean"].get<double>();
    run->step_p99 = steps["p99"].get<double>();
    run->step_max = steps["max"].get<double>();
  }
  return true;
}

absl::StatusOr<std::vector<SweepRun>> RunSweep(const SweepOptions& options) {
  const absl::Status known = CheckSweepOptions(options);
  if (!known.ok()) return known;
  SweepJournal journal;
  const absl::Status opened = OpenJournal(options, &journal);
  if (!opened.ok()) return opened;
  std::vector<SweepRun> runs;
  const int64_t total = (options.datasets.size() + options.families.size()) *
                        options.types.size() * options.counts.size() *
                        options.seeds * options.kernels.size();
  Progress progress("robustness", total);
  // All kernels of one graph with one set of outliers.
  const auto run_kernels =
      [&](const SweepGraph& dataset, const std::string& type,
          const std::string& count_text, const int seed) -> absl::Status {
    const auto count = OutlierCount(count_text, dataset.num_loops);
    if (!count.ok()) return count.status();
    for (const std::string& kernel : options.kernels) {
      SweepRun run;
      run.dataset = dataset.name;
      run.is_family = dataset.is_family;
      run.kernel = kernel;
      run.type = type;
      run.requested_count = count_text;
      run.count = type == "none" ? 0 : *count;
      run.outlier_share = static_cast<double>(run.count) /
                          std::max(1, run.count + dataset.num_loops);
      run.seed = seed;
      const SweepRun* const done = journal.Find(Key(run));
      if (done != nullptr) {
        runs.push_back(*done);
        runs.back().outlier_share = run.outlier_share;
        runs.back().requested_count = count_text;
      } else {
        absl::Status status = RunOne(options, dataset, &run);
        if (status.ok()) status = journal.Append(ToJson(run));
        if (!status.ok()) return status;
        runs.push_back(run);
      }
      progress.Update(runs.size(), Key(run));
    }
    return absl::OkStatus();
  };
  std::vector<std::string> names = options.datasets;
  names.insert(names.end(), options.families.begin(), options.families.end());
  for (size_t n = 0; n != names.size(); ++n) {
    const bool is_family = n >= options.datasets.size();
    absl::StatusOr<SweepGraph> dataset;
    if (!is_family) dataset = LoadSweepGraph(options, names[n]);
    if (!is_family && !dataset.ok()) return dataset.status();
    for (const std::string& type : options.types) {
      for (const std::string& count_text : options.counts) {
        for (int k = 0; k != options.seeds; ++k) {
          const int seed = options.first_seed + k;
          if (is_family) dataset = MakeFamilyGraph(names[n], seed);
          if (!dataset.ok()) return dataset.status();
          const absl::Status status =
              run_kernels(*dataset, type, count_text, seed);
          if (!status.ok()) return status;
        }
      }
    }
  }
  progress.Finish();
  return runs;
}

}  // namespace experiments
}  // namespace cartographer_ext
