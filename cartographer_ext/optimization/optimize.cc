// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/optimize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/optimization/joined_trajectories.h"
#include "cartographer_ext/optimization/polish_near.h"
#include "cartographer_ext/optimization/robust_solver.h"
#include "cartographer_ext/optimization/switchable_constraints.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kPolishRounds = 30;
// Standard deviation (metres, radians) that holds fixed poses to each other.
constexpr double kFixedSigma = 1e-5;
// A map that has lost fewer loops than this is not folded.
constexpr int kUnfolded = 20;
// So many loops cost little whatever they fill.
constexpr size_t kFewLoops = 500;
// The fill of more is bounded by memory alone.
constexpr size_t kManyLoops = 5000;
// Relative difference of truncated costs of one and the same optimum.
constexpr double kSame = 1e-6;

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

absl::Status RunReplay(const PoseGraph& graph, const OptimizeOptions& options,
                       OptimizeResult* const result) {
  ReplayResult replay;
  const absl::Status status = Replay(graph, options.smoother, &replay);
  if (!status.ok()) return status;
  result->poses = replay.poses;
  result->step_seconds = replay.step_seconds;
  result->accepted = replay.accepted;
  result->weights.assign(replay.accepted.begin(), replay.accepted.end());
  result->converged = true;
  return absl::OkStatus();
}

struct Member {
  std::string name;
  std::vector<Pose2> poses;
  double truncated_cost = 0.;
};

bool HasFewLoops(const PoseGraph& graph) {
  size_t loops = 0;
  for (const PoseGraphEdge& edge : graph.edges) loops += edge.is_loop;
  return loops <= kFewLoops ||
         (loops <= kManyLoops && 2 * loops <= graph.poses.size());
}

bool RejectsSome(const std::vector<WhitenedEdge>& edges,
                 const std::vector<Pose2>& poses) {
  for (const WhitenedEdge& edge : edges) {
    if (edge.is_loop &&
        Chi2(edge, poses[edge.from], poses[edge.to]) >= kChi2Gate) {
      return true;
    }
  }
  return false;
}

void RunAuto(const PoseGraph& graph, const std::vector<WhitenedEdge>& edges,
             const OptimizeOptions& options, OptimizeResult* const result) {
  std::vector<Member> members;
  RobustSolver solver(edges);
  const auto add = [&](const std::string& name, std::vector<Pose2> poses) {
    Member member;
    member.name = name;
    member.poses = std::move(poses);
    AddSummary(PolishTruncated(kChi2Gate, kPolishRounds, &solver, &member.poses,
                               nullptr),
               result);
    member.truncated_cost = TruncatedCost(edges, member.poses);
    members.push_back(std::move(member));
  };
  double lowest_of_kernels = std::numeric_limits<double>::infinity();
  const auto add_kernel = [&](const std::string& name, const KernelType type,
                              const std::vector<Pose2>& start) {
    SolverOptions solver_options;
    solver_options.kernel = DefaultKernel(type);
    solver_options.max_iterations = options.max_iterations;
    std::vector<Pose2> poses = start;
    AddSummary(solver.Solve(solver_options, &poses), result);
    lowest_of_kernels =
        std::min(lowest_of_kernels, TruncatedCost(edges, poses));
    add(name, std::move(poses));
  };
  ReplayResult replay;
  const bool replayed = Replay(graph, options.smoother, &replay).ok();
  if (replayed) add("r_isam", replay.poses);
  if (!replayed && JoinTrajectories(graph, options.smoother, &replay.poses)) {
    add("joined", replay.poses);
  }
  add_kernel("dcs", KernelType::kDcs, graph.poses);
  add_kernel("gm", KernelType::kGemanMcClure, graph.poses);
  add_kernel("acs", KernelType::kAcs, graph.poses);
  // One started from nothing and the other from the file. Where they meet, more
  // starts would end there, too.
  const bool settled = replayed && std::abs(members[0].truncated_cost -
                                            members[1].truncated_cost) <=
                                       kSame * members[0].truncated_cost;
  if (!settled) {
    if (replayed) add_kernel("r_isam, dcs", KernelType::kDcs, replay.poses);
    // The failures of a softer and of a harder epoch kernel differ.
    SmootherOptions softer = options.smoother;
    softer.epoch_kernel.parameter *= 4.;
    if (Replay(graph, softer, &replay).ok()) add("r_isam, soft", replay.poses);
  }
  const auto lower = [](const Member& a, const Member& b) {
    return a.truncated_cost < b.truncated_cost;
  };
  // Long drifts between few loops are the ground of graduated non-convexity;
  // with many loops its first, nearly convex rounds fill the factor.
  if (!settled && HasFewLoops(graph) &&
      RejectsSome(
          edges,
          std::min_element(members.begin(), members.end(), lower)->poses)) {
    std::vector<Pose2> poses = graph.poses;
    AddSummary(SolveGnc(GncOptions(), &solver, &poses, nullptr), result);
    add("gnc_tls", std::move(poses));
  }
  const auto best = std::min_element(members.begin(), members.end(), lower);
  result->member_truncated_chi2 = best->truncated_cost;
  // Where the adapted gate is narrower it also judges better between those that
  // are not folded.
  const double gate =
      options.adaptive_gate ? AdaptiveGate(edges, best->poses) : kChi2Gate;
  const double limit = best->truncated_cost + kUnfolded * kChi2Gate;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Member& member : members) {
    if (member.truncated_cost > limit) continue;
    std::vector<Pose2> poses = member.poses;
    std::vector<double> weights;
    AddSummary(PolishTruncated(gate, kPolishRounds, &solver, &poses, &weights),
               result);
    const double cost = TruncatedCost(edges, poses, gate);
    if (cost >= lowest) continue;
    lowest = cost;
    result->poses = std::move(poses);
    result->weights = std::move(weights);
    result->member = member.name;
  }
  if (options.adaptive_gate) {
    AddSummary(
        PolishAdapted(kPolishRounds, &solver, &result->poses, &result->weights),
        result);
    // Half way to what a kernel alone reaches, to stay below others, too.
    const double enough =
        best->truncated_cost +
        0.5 * std::max(0., lowest_of_kernels - best->truncated_cost);
    if (options.lowest_cost && TruncatedCost(edges, result->poses) > enough) {
      const std::vector<Pose2> adapted = result->poses;
      result->poses = best->poses;
      result->member = best->name;
      for (size_t i = 0; i != edges.size(); ++i) {
        result->weights[i] =
            !edges[i].is_loop || Chi2(edges[i], best->poses[edges[i].from],
                                      best->poses[edges[i].to]) < kChi2Gate;
      }
      AddSummary(
          PolishNear(edges, adapted, enough, &result->poses, &result->weights),
          result);
    }
  }
  result->accepted.assign(edges.size(), true);
  for (size_t i = 0; i != edges.size(); ++i) {
    result->accepted[i] = result->weights[i] > 0.5;
  }
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
  result->truncated_chi2 = TruncatedCost(edges, result->poses);
}

// The graph with edges that hold its fixed poses in place.
PoseGraph Held(const PoseGraph& graph) {
  PoseGraph result = graph;
  for (size_t k = 1; k < graph.fixed.size(); ++k) {
    PoseGraphEdge edge;
    edge.from = std::min(graph.fixed[0], graph.fixed[k]);
    edge.to = std::max(graph.fixed[0], graph.fixed[k]);
    if (edge.from == edge.to) continue;
    edge.measurement = Between(graph.poses[edge.from], graph.poses[edge.to]);
    edge.information =
        Eigen::Matrix3d::Identity() / (kFixedSigma * kFixedSigma);
    result.edges.push_back(edge);
  }
  return result;
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
  const double start = ThreadCpuSeconds();
  PoseGraph with_fixed_poses;
  if (graph.fixed.size() > 1) with_fixed_poses = Held(graph);
  const PoseGraph& held = graph.fixed.size() > 1 ? with_fixed_poses : graph;
  std::vector<WhitenedEdge> edges = Whiten(held.edges);
  OptimizeResult result;
  result.poses = graph.poses;
  if (options.method == "auto") {
    RunAuto(held, edges, options, &result);
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
  if (!result.weights.empty()) result.weights.resize(edges.size());
  if (!result.accepted.empty()) result.accepted.resize(edges.size());
  result.cpu_seconds = ThreadCpuSeconds() - start;
  Summarize(edges, &result);
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
