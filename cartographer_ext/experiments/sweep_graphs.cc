// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/sweep_graphs.h"

#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/experiments/graph_families.h"
#include "cartographer_ext/experiments/outliers/outlier_generator.h"
#include "cartographer_ext/map/pose_graph_files.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace experiments {

using evaluation::ReadPoseGraph;
using optimization::PoseGraph;
using optimization::PoseGraphEdge;

namespace {

bool Exists(const std::string& path) {
  struct stat unused;
  return stat(path.c_str(), &unused) == 0;
}

// Plain least squares to the last digit.
double SolveToTheEnd(const std::vector<optimization::WhitenedEdge>& edges,
                     std::vector<Pose2>* const poses) {
  optimization::SolverOptions options;
  options.max_iterations = 500;
  options.cost_tolerance = 1e-10;
  return optimization::SolveRobust(edges, options, poses).final_cost;
}

// The lowest cost that plain least squares reaches, as given poses may lead to
// a local minimum.
std::vector<Pose2> OptimumOfRightLoops(const PoseGraph& graph) {
  const std::vector<optimization::WhitenedEdge> edges =
      optimization::Whiten(graph.edges);
  const std::vector<double> all(edges.size(), 1.);
  std::vector<std::vector<Pose2>> starts = {
      graph.poses, optimization::ChainOdometry(graph),
      optimization::SpanningTree(graph, all)};
  std::vector<Pose2> chordal = graph.poses;
  if (optimization::ChordalPoses(edges, all, &chordal)) {
    starts.push_back(chordal);
  }
  optimization::SolverOptions huber;
  huber.kernel = optimization::DefaultKernel(optimization::KernelType::kHuber);
  std::vector<Pose2> best = graph.poses;
  double lowest = std::numeric_limits<double>::infinity();
  for (const std::vector<Pose2>& start : starts) {
    for (const bool by_huber : {false, true}) {
      std::vector<Pose2> poses = start;
      if (by_huber) optimization::SolveRobust(edges, huber, &poses);
      const double cost = SolveToTheEnd(edges, &poses);
      // Not for the sake of rounding.
      if (cost > lowest * (1. - 1e-9)) continue;
      lowest = cost;
      best = std::move(poses);
    }
  }
  return best;
}

}  // namespace

std::string JournalFingerprint(const SweepOptions& options) {
  return absl::StrCat("group_size ", options.group_size, ", adaptive_gate ",
                      options.optimize.adaptive_gate, ", lowest_cost ",
                      options.optimize.lowest_cost, ", max_seconds ",
                      options.optimize.max_seconds);
}

absl::Status CheckSweepOptions(const SweepOptions& options) {
  for (const std::string& kernel : options.kernels) {
    const std::vector<std::string>& names = optimization::MethodNames();
    if (std::find(names.begin(), names.end(), kernel) == names.end()) {
      return absl::InvalidArgumentError(
          absl::StrCat("unknown kernel '", kernel, "'"));
    }
  }
  for (const std::string& type : options.types) {
    if (type == "none") continue;
    const auto known = optimization::OutlierTypeFromName(type);
    if (!known.ok()) return known.status();
  }
  for (const std::string& family : options.families) {
    const auto known = GenerateFamilyGraph(family, options.first_seed);
    if (!known.ok()) return known.status();
  }
  return absl::OkStatus();
}

std::string DatasetName(const std::string& dataset) {
  std::string name = std::filesystem::path(dataset).filename().string();
  for (const char* suffix : {".xz", ".gz", ".bz2", ".g2o"}) {
    name = std::string(absl::StripSuffix(name, suffix));
  }
  return name;
}

absl::StatusOr<SweepGraph> LoadSweepGraph(const SweepOptions& options,
                                          const std::string& dataset) {
  std::string filename = dataset;
  for (const char* suffix : {".g2o.xz", ".g2o.gz", ".g2o"}) {
    const std::string candidate =
        absl::StrCat(options.data_directory, "/", dataset, suffix);
    if (!Exists(filename) && Exists(candidate)) filename = candidate;
  }
  if (!Exists(filename)) {
    return absl::NotFoundError(
        absl::StrCat("data set ", dataset, ": there is no such file, and none ",
                     "of that name in ", options.data_directory));
  }
  auto graph = ReadPoseGraph(filename);
  if (!graph.ok()) return graph.status();
  SweepGraph result;
  result.name = DatasetName(dataset);
  result.graph = *std::move(graph);
  result.optimum = result.graph.poses;
  // Sets that come with wrong loops of their own have no plain optimum.
  const bool own_outliers = options.truths.count(result.name) > 0;
  if (own_outliers) {
    optimization::OptimizeOptions automatic;
    const auto best = optimization::Optimize(result.graph, automatic);
    if (best.ok()) result.optimum = best->poses;
  } else {
    result.optimum = OptimumOfRightLoops(result.graph);
    result.right_edges = optimization::Whiten(result.graph.edges);
  }
  result.num_loops = optimization::CountLoops(result.graph.edges);
  return result;
}

absl::StatusOr<SweepGraph> MakeFamilyGraph(const std::string& family,
                                           const int seed) {
  auto generated = GenerateFamilyGraph(family, seed);
  if (!generated.ok()) return generated.status();
  SweepGraph result;
  result.name = family;
  result.is_family = true;
  // From the truth and with the noise as it is, whatever the matrices claim.
  PoseGraph honest = generated->graph;
  for (PoseGraphEdge& edge : honest.edges) {
    edge.information /= edge.is_loop ? generated->loop_confidence
                                     : generated->odometry_confidence;
    result.num_loops += edge.is_loop;
  }
  result.optimum = generated->truth;
  const auto fixed = optimization::FixedPoseEdges(honest);
  honest.edges.insert(honest.edges.end(), fixed.begin(), fixed.end());
  result.right_edges = optimization::Whiten(honest.edges);
  SolveToTheEnd(result.right_edges, &result.optimum);
  result.inherent_ate =
      optimization::AbsoluteTrajectoryError(result.optimum, generated->truth);
  result.graph = std::move(generated->graph);
  return result;
}

double DeviationFromOptimum(const SweepGraph& dataset,
                            const std::vector<Pose2>& poses) {
  if (dataset.right_edges.empty()) {
    return std::numeric_limits<double>::infinity();
  }
  const auto chi2 = [&](const std::vector<Pose2>& at) {
    double sum = 0.;
    for (const double value :
         optimization::Chi2OfEdges(dataset.right_edges, at)) {
      sum += value;
    }
    return sum;
  };
  const double least = chi2(dataset.optimum);
  const double redundancy =
      3. * dataset.right_edges.size() - 3. * (dataset.optimum.size() - 1.);
  const double variance =
      redundancy > 0. ? std::min(1., least / redundancy) : 1.;
  // Where the reference is not the end of a flat valley, less is as far.
  const double excess = std::abs(chi2(poses) - least);
  return excess == 0. ? 0. : std::sqrt(excess / variance);
}

absl::StatusOr<int> OutlierCount(const std::string& text, const int num_loops) {
  absl::string_view number = text;
  const bool is_percentage = absl::ConsumeSuffix(&number, "%");
  double value;
  if (!absl::SimpleAtod(number, &value) || !(value >= 0.) || value > 1e6 ||
      (is_percentage && value > 99.)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "outlier count '", text, "' is neither a number nor at most 99%"));
  }
  if (!is_percentage) return static_cast<int>(value);
  return static_cast<int>(std::lround(num_loops * value / (100. - value)));
}

absl::StatusOr<PoseGraph> WithOutliers(const SweepOptions& options,
                                       const SweepGraph& dataset,
                                       const std::string& type, const int count,
                                       const int seed) {
  PoseGraph graph = dataset.graph;
  if (type == "none") return graph;
  optimization::OutlierOptions outliers;
  outliers.type = *optimization::OutlierTypeFromName(type);
  outliers.count = count;
  outliers.seed = seed;
  outliers.group_size = options.group_size;
  const auto edges = optimization::GenerateOutliers(graph, outliers);
  if (!edges.ok()) return edges.status();
  graph.edges.insert(graph.edges.end(), edges->begin(), edges->end());
  return graph;
}

}  // namespace experiments
}  // namespace cartographer_ext
