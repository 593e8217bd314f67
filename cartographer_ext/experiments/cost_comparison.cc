// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/cost_comparison.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/progress.h"
#include "cartographer_ext/io/bounded_json.h"
#include "cartographer_ext/io/keyed_journal.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace experiments {
namespace {

using optimization::PoseGraph;
using optimization::WhitenedEdge;

struct Start {
  std::string name;
  std::vector<Pose2> poses;
};

std::vector<Start> Starts(const PoseGraph& graph) {
  std::vector<Start> result = {{"given", graph.poses}};
  result.push_back(
      {"tree", optimization::SpanningTree(
                   graph, std::vector<double>(graph.edges.size(), 1.))});
  std::vector<Pose2> chordal = optimization::ChainOdometry(graph);
  if (optimization::RobustChordalPoses(optimization::Whiten(graph.edges),
                                       &chordal)) {
    result.push_back({"chordal", std::move(chordal)});
  }
  return result;
}

// Lowers the comparison's best rival, whose poses are `best`, by those that
// solve `graph`; costs are those of `edges` truncated at the gate.
absl::Status RaceRivals(const PoseGraph& graph, const std::string& noise,
                        const optimization::OptimizeOptions& options,
                        const std::vector<WhitenedEdge>& edges,
                        const double gate, CostComparison* const comparison,
                        std::vector<Pose2>* const best) {
  const auto race = [&](const std::string& start, const std::string& kernel,
                        const std::vector<Pose2>& poses) -> absl::Status {
    optimization::OptimizeOptions rival = options;
    rival.method = kernel;
    rival.start = poses;
    const auto result = optimization::Optimize(graph, rival);
    if (!result.ok()) return result.status();
    const double cost = optimization::TruncatedCost(edges, result->poses, gate);
    if (cost < comparison->rival_cost) {
      comparison->rival_cost = cost;
      comparison->rival = absl::StrCat(start, kernel, noise);
      *best = result->poses;
    }
    return absl::OkStatus();
  };
  for (const Start& start : Starts(graph)) {
    for (const char* kernel :
         {"none", "huber", "gm", "dcs", "acs", "gnc_tls"}) {
      const absl::Status status =
          race(absl::StrCat(start.name, ", "), kernel, start.poses);
      if (!status.ok()) return status;
    }
  }
  // Several trajectories cannot be replayed.
  race("", "r_isam", {}).IgnoreError();
  return absl::OkStatus();
}

absl::Status Compare(const PoseGraph& graph, const SweepOptions& options,
                     CostComparison* const comparison) {
  optimization::OptimizeOptions automatic = options.optimize;
  automatic.method = "auto";
  const auto result = optimization::Optimize(graph, automatic);
  if (!result.ok()) return result.status();
  comparison->poses = graph.poses.size();
  comparison->loops = optimization::CountLoops(graph.edges);
  comparison->cpu_seconds = result->cpu_seconds;
  comparison->member = result->member;
  const PoseGraph scaled = optimization::WithNoiseScale(
      graph, result->applied_odometry_scale, result->applied_loop_scale);
  const std::vector<WhitenedEdge> edges = optimization::Whiten(scaled.edges);
  const double gate = result->applied_gate;
  comparison->cost = optimization::TruncatedCost(edges, result->poses, gate);
  comparison->rival_cost = std::numeric_limits<double>::infinity();
  std::vector<Pose2> rival;
  absl::Status status =
      RaceRivals(graph, "", options.optimize, edges, gate, comparison, &rival);
  if (!status.ok()) return status;
  if (result->applied_odometry_scale != 1. ||
      result->applied_loop_scale != 1.) {
    status = RaceRivals(scaled, ", scaled noise", options.optimize, edges, gate,
                        comparison, &rival);
    if (!status.ok()) return status;
  }
  // A relative difference of a cost near zero is meaningless.
  comparison->excess = (comparison->cost - comparison->rival_cost) /
                       std::max(comparison->rival_cost, 1e-6);
  if (comparison->excess > kCostTolerance) {
    comparison->estimated_excess =
        ExcessWithNoise(graph, result->noise, result->poses, rival);
  }
  return absl::OkStatus();
}

bool IsAbove(const CostComparison& comparison) {
  return comparison.excess > kCostTolerance;
}

// Whatever the noise.
bool IsAboveInBoth(const CostComparison& comparison) {
  return IsAbove(comparison) && comparison.estimated_excess > kCostTolerance;
}

nlohmann::ordered_json ToJson(const CostComparison& comparison) {
  return {{"dataset", comparison.dataset},
          {"type", comparison.type},
          {"requested_count", comparison.requested_count},
          {"count", comparison.count},
          {"seed", comparison.seed},
          {"poses", comparison.poses},
          {"loops", comparison.loops},
          {"cpu_seconds", comparison.cpu_seconds},
          {"cost", comparison.cost},
          {"member", comparison.member},
          {"rival", comparison.rival},
          {"rival_cost", comparison.rival_cost},
          {"excess", comparison.excess},
          {"estimated_excess", comparison.estimated_excess}};
}

bool FromJson(const nlohmann::json& json, CostComparison* const comparison) {
  for (const char* key :
       {"dataset", "type", "requested_count", "member", "rival"}) {
    if (!json.contains(key) || !json[key].is_string()) return false;
  }
  for (const char* key :
       {"cpu_seconds", "cost", "rival_cost", "excess", "estimated_excess"}) {
    if (!json.contains(key) || !json[key].is_number()) return false;
  }
  if (!io::TakeInt(json, "count", &comparison->count) ||
      !io::TakeInt(json, "seed", &comparison->seed) ||
      !io::TakeInt(json, "poses", &comparison->poses) ||
      !io::TakeInt(json, "loops", &comparison->loops)) {
    return false;
  }
  comparison->dataset = json["dataset"].get<std::string>();
  comparison->type = json["type"].get<std::string>();
  comparison->requested_count = json["requested_count"].get<std::string>();
  comparison->cpu_seconds = json["cpu_seconds"].get<double>();
  comparison->cost = json["cost"].get<double>();
  comparison->member = json["member"].get<std::string>();
  comparison->rival = json["rival"].get<std::string>();
  comparison->rival_cost = json["rival_cost"].get<double>();
  comparison->excess = json["excess"].get<double>();
  comparison->estimated_excess = json["estimated_excess"].get<double>();
  return true;
}

std::string Key(const std::string& source, const CostComparison& comparison) {
  return absl::StrCat(source, "|", comparison.type, "|",
                      comparison.requested_count, "|", comparison.seed);
}

// What has been compared, by the name that was asked for, type, count and seed.
using CostJournal = io::KeyedJournal<CostComparison>;

absl::Status OpenJournal(const SweepOptions& options, CostJournal* journal) {
  return journal->Open(
      options.journal_filename,
      {"cartographer_ext_compare_cost", "journal of costs", "comparison",
       "graphs were generated or solved with other options"},
      JournalFingerprint(options),
      [](const nlohmann::json& line)
          -> absl::StatusOr<std::pair<std::string, CostComparison>> {
        CostComparison comparison;
        if (!line.is_object() || !line.contains("source") ||
            !line["source"].is_string() || !FromJson(line, &comparison)) {
          return absl::InvalidArgumentError("not a comparison of costs");
        }
        return std::make_pair(
            Key(line["source"].get<std::string>(), comparison), comparison);
      });
}

// Compares one data set, or where there is none the family `name`, with the
// outliers and the seed of `comparison`.
absl::Status CompareOnce(const SweepOptions& options, const std::string& name,
                         const SweepGraph* const loaded,
                         CostJournal* const journal,
                         CostComparison* const comparison) {
  const std::string source =
      absl::StrCat(loaded == nullptr ? "family " : "", name);
  const CostComparison* const known = journal->Find(Key(source, *comparison));
  if (known != nullptr) {
    *comparison = *known;
    return absl::OkStatus();
  }
  absl::StatusOr<SweepGraph> family;
  if (loaded == nullptr) {
    family = MakeFamilyGraph(name, comparison->seed);
    if (!family.ok()) return family.status();
  }
  const SweepGraph& dataset = loaded != nullptr ? *loaded : *family;
  const auto count =
      OutlierCount(comparison->requested_count, dataset.num_loops);
  if (!count.ok()) return count.status();
  comparison->dataset = dataset.name;
  comparison->count = comparison->type == "none" ? 0 : *count;
  const auto graph = WithOutliers(options, dataset, comparison->type,
                                  comparison->count, comparison->seed);
  if (!graph.ok()) return graph.status();
  const absl::Status status = Compare(*graph, options, comparison);
  if (!status.ok()) return status;
  nlohmann::ordered_json line = ToJson(*comparison);
  line["source"] = source;
  return journal->Append(line);
}

}  // namespace

double ExcessWithNoise(const PoseGraph& graph,
                       const optimization::NoiseScale& noise,
                       const std::vector<Pose2>& poses,
                       const std::vector<Pose2>& rival) {
  std::vector<WhitenedEdge> edges =
      optimization::WithNoiseScale(optimization::Whiten(graph.edges),
                                   noise.odometry.factor, noise.loops.factor);
  for (const WhitenedEdge& edge :
       optimization::Whiten(optimization::FixedPoseEdges(graph))) {
    edges.push_back(edge);
  }
  const auto polished_cost = [&](std::vector<Pose2> polished) {
    optimization::PolishTruncated(edges, optimization::kChi2Gate,
                                  optimization::kFullPolishRounds, &polished,
                                  nullptr);
    return optimization::TruncatedCost(edges, polished);
  };
  const double lowest = polished_cost(rival);
  return (polished_cost(poses) - lowest) / std::max(lowest, 1e-6);
}

absl::StatusOr<std::vector<CostComparison>> CompareCosts(
    const SweepOptions& options) {
  const absl::Status known = CheckSweepOptions(options);
  if (!known.ok()) return known;
  std::vector<CostComparison> cells;
  for (const std::string& type : options.types) {
    for (const std::string& count : options.counts) {
      CostComparison cell;
      cell.type = type;
      cell.requested_count = type == "none" ? "0" : count;
      cells.push_back(cell);
      if (type == "none") break;
    }
  }
  std::vector<std::string> names = options.datasets;
  names.insert(names.end(), options.families.begin(), options.families.end());
  CostJournal journal;
  const absl::Status opened = OpenJournal(options, &journal);
  if (!opened.ok()) return opened;
  std::vector<CostComparison> result;
  Progress progress("graphs", names.size() * cells.size() * options.seeds);
  for (size_t n = 0; n != names.size(); ++n) {
    absl::StatusOr<SweepGraph> loaded;
    const bool is_family = n >= options.datasets.size();
    if (!is_family) {
      loaded = LoadSweepGraph(options, names[n]);
      if (!loaded.ok()) return loaded.status();
    }
    for (const CostComparison& cell : cells) {
      for (int k = 0; k != options.seeds; ++k) {
        CostComparison comparison = cell;
        comparison.seed = options.first_seed + k;
        const absl::Status status =
            CompareOnce(options, names[n], is_family ? nullptr : &*loaded,
                        &journal, &comparison);
        if (!status.ok()) return status;
        result.push_back(comparison);
        progress.Update(result.size(), comparison.dataset);
        // Without outliers the seed changes nothing but a family's graph.
        if (!is_family && cell.type == "none") break;
      }
    }
  }
  progress.Finish();
  return result;
}

std::string CostTable(const std::vector<CostComparison>& comparisons) {
  struct Row {
    std::string name, type;
    int graphs = 0, above = 0, above_in_both = 0;
    double worst = -1., cpu_seconds = 0.;
  };
  std::vector<Row> rows;
  Row all;
  all.name = "all";
  std::string list;
  const auto add = [](const CostComparison& comparison, Row* const row) {
    ++row->graphs;
    row->above += IsAbove(comparison);
    row->above_in_both += IsAboveInBoth(comparison);
    row->worst = std::max(row->worst, comparison.excess);
    row->cpu_seconds += comparison.cpu_seconds;
  };
  for (const CostComparison& comparison : comparisons) {
    if (rows.empty() || rows.back().name != comparison.dataset ||
        rows.back().type != comparison.type) {
      rows.emplace_back();
      rows.back().name = comparison.dataset;
      rows.back().type = comparison.type;
    }
    add(comparison, &rows.back());
    add(comparison, &all);
    if (!IsAbove(comparison)) continue;
    absl::StrAppendFormat(
        &list,
        "above: %s %s %s seed %d: %.9g (%s), %s %.9g, excess %.2g, with the "
        "estimated noise %.2g\n",
        comparison.dataset, comparison.type, comparison.requested_count,
        comparison.seed, comparison.cost, comparison.member, comparison.rival,
        comparison.rival_cost, comparison.excess, comparison.estimated_excess);
  }
  rows.push_back(all);
  std::string table =
      absl::StrFormat("%-20s %-5s %7s %7s %8s %13s %8s\n", "set", "type",
                      "graphs", "above", "in both", "worst excess", "CPU s");
  for (const Row& row : rows) {
    absl::StrAppendFormat(&table, "%-20s %-5s %7d %7d %8d %13.2g %8.3f\n",
                          row.name, row.type, row.graphs, row.above,
                          row.above_in_both, row.worst,
                          row.cpu_seconds / std::max(1, row.graphs));
  }
  return absl::StrCat(table, list);
}

nlohmann::ordered_json CostJson(
    const std::vector<CostComparison>& comparisons) {
  nlohmann::ordered_json json;
  json["tolerance"] = kCostTolerance;
  json["graphs"] = comparisons.size();
  json["above"] =
      std::count_if(comparisons.begin(), comparisons.end(), IsAbove);
  json["above_in_both"] =
      std::count_if(comparisons.begin(), comparisons.end(), IsAboveInBoth);
  json["comparisons"] = nlohmann::ordered_json::array();
  for (const CostComparison& comparison : comparisons) {
    json["comparisons"].push_back(ToJson(comparison));
    json["comparisons"].back()["above"] = IsAbove(comparison);
  }
  return json;
}

}  // namespace experiments
}  // namespace cartographer_ext
