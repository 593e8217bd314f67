// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/optimize.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/optimization/offline/auto_search.h"
#include "cartographer_ext/optimization/offline/noise/noise_metric.h"
#include "cartographer_ext/optimization/offline/parts/part_replay.h"
#include "cartographer_ext/optimization/offline/portfolio.h"
#include "cartographer_ext/optimization/offline/readmission.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"
#include "cartographer_ext/optimization/offline/switchable_constraints.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Standard deviation (metres, radians) that holds fixed poses to each other.
constexpr double kFixedSigma = 1e-5;

void AddSummary(const SolverSummary& summary, OptimizeResult* const result) {
  result->iterations += summary.iterations;
  result->converged = summary.converged;
}

KernelOptions MakeKernel(const KernelType type,
                         const OptimizeOptions& options) {
  KernelOptions kernel = DefaultKernel(type);
  if (options.parameter > 0.) kernel.parameter = options.parameter;
  kernel.norm = options.norm;
  return kernel;
}

void RunKernel(const std::vector<WhitenedEdge>& edges, const KernelType type,
               const OptimizeOptions& options, OptimizeResult* const result) {
  SolverOptions solver;
  solver.kernel = MakeKernel(type, options);
  solver.max_iterations = options.max_iterations;
  solver.prune = options.prune;
  RobustSolver robust(edges);
  AddSummary(robust.Solve(solver, &result->poses), result);
  result->weights = robust.weights();
}

void RunSwitchable(const std::vector<WhitenedEdge>& edges,
                   const OptimizeOptions& options,
                   OptimizeResult* const result) {
  SwitchableOptions switchable;
  if (options.parameter > 0.) switchable.penalty = options.parameter;
  switchable.max_iterations = options.max_iterations;
  switchable.max_seconds = options.max_seconds;
  AddSummary(
      SolveSwitchable(edges, switchable, &result->poses, &result->weights),
      result);
  for (double& weight : result->weights) weight *= weight;
}

void RunGnc(const std::vector<WhitenedEdge>& edges,
            const OptimizeOptions& options, OptimizeResult* const result) {
  GncOptions gnc;
  if (options.parameter > 0.) gnc.truncation = options.parameter;
  gnc.max_seconds = options.max_seconds;
  AddSummary(SolveGnc(edges, gnc, &result->poses, &result->weights), result);
}

// Puts right loops in force that lie just beyond the gate, as `auto` does.
void AcceptNearLoops(RobustSolver* const solver, ReplayResult* const replay,
                     OptimizeResult* const result) {
  AutoResult wide;
  wide.poses = replay->poses;
  wide.weights.assign(replay->accepted.begin(), replay->accepted.end());
  if (!AcceptNearLoops({{"r_isam", replay->poses, 0.}}, solver, &wide)) return;
  replay->poses = std::move(wide.poses);
  for (size_t i = 0; i != wide.weights.size(); ++i) {
    replay->accepted[i] = wide.weights[i] > 0.5;
  }
  result->applied_gate = wide.gate;
}

// Repeats a replay with the noise that its map shows, where that is larger than the
// matrices claim and loops were lost to it.
void RepeatWithLargerNoise(const PoseGraph& graph,
                           const SmootherOptions& options,
                           ReplayResult* const replay,
                           OptimizeResult* const result) {
  if (graph.edges.size() >= kMaxEdgesForNoise) return;
  Portfolio portfolio(graph, PortfolioOptions());
  portfolio.Add("r_isam", replay->poses);
  NoiseHypothesis noise;
  if (!FindLargerNoise(NoiseMetric(), MeasureNoise(&portfolio), &portfolio,
                       &noise)) {
    return;
  }
  const PoseGraph scaled =
      WithNoiseScale(graph, noise.metric.odometry, noise.metric.loops);
  std::vector<WhitenedEdge> edges = Whiten(scaled.edges);
  RobustSolver solver(edges);
  ReplayResult again;
  if (!Replay(scaled, options, &again).ok()) return;
  ReadmitGroups(scaled, &edges, &solver, &again);
  if (CountLoopsInForce(graph.edges, again.accepted) <=
      CountLoopsInForce(graph.edges, replay->accepted)) {
    return;
  }
  AcceptNearLoops(&solver, &again, result);
  *replay = std::move(again);
  result->applied_odometry_scale = noise.metric.odometry;
  result->applied_loop_scale = noise.metric.loops;
}

absl::Status RunReplay(const PoseGraph& graph, const OptimizeOptions& options,
                       OptimizeResult* const result) {
  ReplayResult replay;
  const absl::Status status = Replay(graph, options.smoother, &replay);
  if (!status.ok()) return status;
  std::vector<WhitenedEdge> edges = Whiten(graph.edges);
  RobustSolver solver(edges);
  ReplayLostParts(graph, options.smoother, &solver, &replay);
  ReadmitGroups(graph, &edges, &solver, &replay);
  if (options.estimate_noise) {
    RepeatWithLargerNoise(graph, options.smoother, &replay, result);
  }
  result->poses = replay.poses;
  result->step_seconds = replay.step_seconds;
  result->accepted = replay.accepted;
  result->weights.assign(replay.accepted.begin(), replay.accepted.end());
  result->converged = true;
  return absl::OkStatus();
}

void RunAuto(const PoseGraph& graph, const OptimizeOptions& options,
             OptimizeResult* const result) {
  AutoOptions auto_options;
  auto_options.portfolio.max_iterations = options.max_iterations;
  auto_options.portfolio.smoother = options.smoother;
  auto_options.estimate_noise = options.estimate_noise;
  auto_options.adaptive_gate = options.adaptive_gate;
  auto_options.lowest_cost = options.lowest_cost;
  AutoResult found = SearchAutomatically(graph, auto_options);
  result->poses = std::move(found.poses);
  result->weights = std::move(found.weights);
  result->accepted = std::move(found.accepted);
  result->iterations = found.iterations;
  result->converged = found.converged;
  result->member = found.member;
  result->member_truncated_chi2 = found.member_cost;
  result->noise = found.noise;
  result->rivals = std::move(found.rivals);
  result->applied_odometry_scale = found.applied_odometry_scale;
  result->applied_loop_scale = found.applied_loop_scale;
  result->applied_gate = found.gate;
}

void Summarize(const std::vector<WhitenedEdge>& edges,
               OptimizeResult* const result) {
  result->chi2 = Chi2OfEdges(edges, result->poses);
  if (result->accepted.empty()) {
    result->accepted.assign(edges.size(), true);
    for (size_t i = 0; i != edges.size(); ++i) {
      result->accepted[i] = !edges[i].is_loop || result->chi2[i] < kChi2Gate;
    }
  }
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!edges[i].is_loop) {
      result->odometry_chi2 += result->chi2[i];
    } else if (result->accepted[i]) {
      result->accepted_loops_chi2 += result->chi2[i];
    }
  }
  result->truncated_chi2 =
      TruncatedCost(edges, result->poses, result->applied_gate);
}

// The noise that `auto` uses.
void TakeEstimatedNoise(const PoseGraph& graph, const OptimizeOptions& options,
                        OptimizeResult* const result) {
  OptimizeResult automatic;
  RunAuto(graph, options, &automatic);
  result->noise = automatic.noise;
  result->applied_odometry_scale = automatic.applied_odometry_scale;
  result->applied_loop_scale = automatic.applied_loop_scale;
  result->applied_gate = automatic.applied_gate;
}

// Moves the whole so that the fixed poses are where they were.
void MoveBack(const PoseGraph& graph, std::vector<Pose2>* const poses) {
  if (graph.fixed.empty()) return;
  const int first = graph.fixed.front();
  const Pose2 motion = graph.poses[first] * (*poses)[first].Inverse();
  for (Pose2& pose : *poses) pose = motion * pose;
  for (const int pose : graph.fixed) (*poses)[pose] = graph.poses[pose];
}

}  // namespace

std::vector<PoseGraphEdge> FixedPoseEdges(const PoseGraph& graph) {
  std::vector<PoseGraphEdge> result;
  for (size_t k = 1; k < graph.fixed.size(); ++k) {
    PoseGraphEdge edge;
    edge.from = std::min(graph.fixed[0], graph.fixed[k]);
    edge.to = std::max(graph.fixed[0], graph.fixed[k]);
    if (edge.from == edge.to) continue;
    edge.measurement = Between(graph.poses[edge.from], graph.poses[edge.to]);
    edge.information =
        Eigen::Matrix3d::Identity() / (kFixedSigma * kFixedSigma);
    result.push_back(edge);
  }
  return result;
}

const std::vector<std::string>& MethodNames() {
  static const auto* const kNames = new std::vector<std::string>{
      "none", "huber",     "sc",      "gm",   "dcs",
      "acs",  "acs_paper", "gnc_tls", "auto", "r_isam"};
  return *kNames;
}

absl::StatusOr<OptimizeResult> Optimize(const PoseGraph& graph,
                                        const OptimizeOptions& options) {
  const absl::Status valid = ValidatePoseGraph(graph);
  if (!valid.ok()) return valid;
  const std::vector<std::string>& names = MethodNames();
  if (std::find(names.begin(), names.end(), options.method) == names.end()) {
    return absl::InvalidArgumentError(
        absl::StrCat("unknown kernel '", options.method, "', expected one of ",
                     absl::StrJoin(names, " ")));
  }
  if (!options.start.empty() && options.start.size() != graph.poses.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat(options.start.size(), " poses to start from for ",
                     graph.poses.size(), " poses"));
  }
  const double start = ThreadCpuSeconds();
  const std::vector<PoseGraphEdge> fixed = FixedPoseEdges(graph);
  PoseGraph with_fixed_poses;
  if (!fixed.empty()) {
    with_fixed_poses = graph;
    with_fixed_poses.edges.insert(with_fixed_poses.edges.end(), fixed.begin(),
                                  fixed.end());
  }
  const PoseGraph& held = fixed.empty() ? graph : with_fixed_poses;
  std::vector<WhitenedEdge> edges = Whiten(held.edges);
  OptimizeResult result;
  result.poses = options.start.empty() ? graph.poses : options.start;
  if (options.method == "auto") {
    RunAuto(held, options, &result);
  } else if (options.method == "r_isam") {
    const absl::Status status = RunReplay(held, options, &result);
    if (!status.ok()) return status;
  } else if (options.method == "sc") {
    RunSwitchable(edges, options, &result);
  } else if (options.method == "gnc_tls") {
    RunGnc(edges, options, &result);
  } else {
    RunKernel(edges, *KernelTypeFromName(options.method), options, &result);
  }
  MoveBack(graph, &result.poses);
  edges.resize(graph.edges.size());
  result.truncated_chi2_as_given = TruncatedCost(edges, result.poses);
  if (!result.weights.empty()) result.weights.resize(edges.size());
  if (!result.accepted.empty()) result.accepted.resize(edges.size());
  result.cpu_seconds = ThreadCpuSeconds() - start;
  if (options.measure_with_estimated_noise && options.method != "auto") {
    TakeEstimatedNoise(held, options, &result);
  }
  Summarize(WithNoiseScale(std::move(edges), result.applied_odometry_scale,
                           result.applied_loop_scale),
            &result);
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
