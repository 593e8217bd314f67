// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The end of an epoch: batch solution, decisions, hypotheses, new factor.
#include <algorithm>
#include <set>
#include <utility>

#include "Eigen/Cholesky"
#include "absl/memory/memory.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "cartographer_ext/optimization/solvers/incremental_smoother.h"
#include "cartographer_ext/optimization/solvers/loop_evidence.h"
#include "cartographer_ext/optimization/solvers/refused_loops.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr size_t kMaxInnovationTests = 60;
constexpr size_t kMaxSeedTests = 20;
constexpr int kMaxFinalRounds = 5;
constexpr int kFinalPolishRounds = 30;
constexpr int kMinRevisits = 3;
constexpr int kManyLoops = 20;
constexpr double kNearlyAll = 0.9;
// Share of all loops that must agree with a hypothesis: at the end of an epoch,
// where time presses, and at the end of the data.
constexpr double kEpochMajority = 0.8;
constexpr double kFinalMajority = 0.5;
// Share of all loops that a hypothesis at the end of the data may bring in.
constexpr double kFinalProspect = 0.1;
// For what is not solved to the end; angles make the first step rough.
constexpr double kWideGate = 4. * kChi2Gate;
// Of the batch solution, in the first of two steps: with the analysis of the
// factor as much as one more and the new factor in the second.
constexpr int kFirstIterations = 2;

bool Agrees(const WhitenedEdge& edge, const std::vector<Pose2>& poses,
            const double gate) {
  return Chi2(edge, poses[edge.from], poses[edge.to]) < gate;
}

// Where most loops are wrong, some of them are consistent with anything.
bool LoopsAgree(const std::vector<WhitenedEdge>& edges,
                const std::vector<Pose2>& poses, const double gate,
                const double fraction) {
  int loops = 0, agreeing = 0;
  for (const WhitenedEdge& edge : edges) {
    if (!edge.is_loop) continue;
    ++loops;
    agreeing += Agrees(edge, poses, gate);
  }
  return agreeing >= fraction * loops;
}

// Number of revisits among the loops which `poses` explain and `before` do not.
// Loops of one stretch of the path are one piece of evidence.
int NewRevisits(const std::vector<WhitenedEdge>& edges,
                const std::vector<Pose2>& before,
                const std::vector<Pose2>& poses, const double gate) {
  std::set<int> stretches;
  for (const WhitenedEdge& edge : edges) {
    if (edge.is_loop && Agrees(edge, poses, gate) &&
        !Agrees(edge, before, gate)) {
      stretches.insert(StretchOf(edge));
    }
  }
  return stretches.size();
}

}  // namespace

void IncrementalSmoother::EndEpoch() {
  TakeOverEpoch();
  SolveEpoch();
  TakeOverEpoch();
}

void IncrementalSmoother::SolveEpoch() {
  poses_in_epoch_ = 0;
  if (num_poses() < 2 || !status_.ok()) return;
  waiting_.clear();  // the batch below weighs them with all others
  if (estimate_outdated_) UpdateEstimate();
  SolverOptions solver = BatchOptions();
  batch_ =
      absl::make_unique<RobustSolver>(edges_, RobustSolver::LastPoseLast());
  batch_->TakeMemory(std::move(memory_));
  SolveWithPredicted(solver);
  iterations_left_ = solver.max_iterations;
  if (num_poses() > options_.two_step_map) {
    solver.max_iterations = std::min(kFirstIterations, iterations_left_);
  }
  SolveOn(solver, batch_.get());
}

void IncrementalSmoother::SolveOn(const SolverOptions& options,
                                  RobustSolver* const batch) {
  const SolverSummary summary = batch->Solve(options, &poses_);
  iterations_left_ =
      summary.converged ? 0 : iterations_left_ - summary.iterations;
  batch_iterations_ += summary.iterations;
}

void IncrementalSmoother::FinishBatch(RobustSolver* const batch) {
  if (iterations_left_ > 0) {
    SolverOptions solver = BatchOptions();
    solver.max_iterations = iterations_left_;
    SolveOn(solver, batch);
  }
  log_area_ = LogArea(poses_);
  if (options_.late_rejection && options_.readmission && KernelIsNarrow()) {
    PolishTruncated(options_.gate, options_.polish_rounds, batch, &poses_,
                    nullptr);
  }
  DecideLoops();
}

void IncrementalSmoother::SolveWithPredicted(const SolverOptions& options) {
  if (predicted_.empty()) return;
  for (const int i : predicted_) edges_[i].is_loop = false;
  batch_->Solve(options, &poses_);
  for (const int i : predicted_) edges_[i].is_loop = true;
  predicted_.clear();
}

void IncrementalSmoother::TakeOverEpoch() {
  if (batch_ == nullptr) return;
  const std::unique_ptr<RobustSolver> batch = std::move(batch_);
  FinishBatch(batch.get());
  if (!Relinearize(batch.get())) return;
  if (TryHypotheses(first_edge_of_epoch_, kEpochMajority, poses_,
                    batch.get()) ||
      TryEarlierMap(batch.get())) {
    DecideLoops();
    if (!Relinearize(batch.get())) return;
  }
  KeepMap();
  first_edge_of_epoch_ = edges_.size();
  work_of_steps_ = 0.;
  work_of_last_end_ = batch->work();
  memory_ = batch->ReleaseMemory();
}

void IncrementalSmoother::DecideLoops() {
  num_rejected_ = 0;
  for (size_t i = 0; i != edges_.size(); ++i) {
    const WhitenedEdge& edge = edges_[i];
    if (!edge.is_loop) continue;
    const bool accept =
        Chi2(edge, poses_[edge.from], poses_[edge.to]) < options_.gate;
    num_rejected_ += !accept;
    if (!decided_[i]) {
      accepted_[i] = accept;
      decided_[i] = true;
    } else if (accepted_[i] && !accept && options_.late_rejection) {
      accepted_[i] = false;
      ++num_late_rejections_;
    } else if (!accepted_[i] && accept && options_.readmission) {
      accepted_[i] = true;
      ++num_readmissions_;
    }
  }
}

SolverOptions IncrementalSmoother::EpochSolverOptions() const {
  SolverOptions solver;
  solver.kernel = options_.epoch_kernel;
  solver.max_iterations = options_.max_epoch_iterations;
  solver.cost_tolerance = options_.epoch_cost_tolerance;
  solver.initial_lambda = 1e-8;
  return solver;
}

SolverOptions IncrementalSmoother::BatchOptions() const {
  SolverOptions solver = EpochSolverOptions();
  if (options_.late_rejection && options_.readmission) return solver;
  // As in the paper: what an earlier epoch decided stays.
  solver.edge_weights.assign(edges_.size(), 1.);
  for (size_t i = 0; i != edges_.size(); ++i) {
    if (decided_[i] && !accepted_[i] && !options_.readmission) {
      solver.edge_weights[i] = 0.;
    }
  }
  return solver;
}

std::vector<IncrementalSmoother::Candidate> IncrementalSmoother::FindCandidates(
    const int first_edge, const double majority) const {
  std::vector<int> rejected;
  for (int i = first_edge; i < static_cast<int>(edges_.size()); ++i) {
    if (edges_[i].is_loop && !accepted_[i]) rejected.push_back(i);
  }
  std::vector<Candidate> result;
  // Evenly thinned, so that the work stays bounded.
  const size_t tests = std::min<size_t>(rejected.size(), kMaxInnovationTests);
  for (size_t k = 0; k != tests; ++k) {
    Candidate candidate;
    candidate.edge = rejected[k * rejected.size() / tests];
    const WhitenedEdge& edge = edges_[candidate.edge];
    candidate.factor = LinearizeEdge(edge);
    const Eigen::Vector3d residual =
        Residual(edge, poses_[edge.from], poses_[edge.to]);
    const Eigen::Matrix3d covariance =
        Eigen::Matrix3d::Identity() +
        factor_.PredictedCovariance(candidate.factor);
    candidate.gain = covariance.llt().solve(residual);
    candidate.innovation = residual.dot(candidate.gain);
    if (candidate.innovation < options_.gate) result.push_back(candidate);
  }
  // Without the prospect of a majority the hypotheses need not be tried, nor,
  // where a smaller one will do, for a few loops more.
  const int loops = CountLoops(edges_);
  const int agreeing = CountLoopsInForce(edges_, accepted_);
  const double prospect = tests == 0 ? 0.
                                     : static_cast<double>(result.size()) /
                                           tests * (loops - agreeing);
  if (agreeing + prospect < majority * loops ||
      (majority < kEpochMajority &&
       agreeing + prospect < kEpochMajority * loops &&
       prospect < kFinalProspect * loops)) {
    result.clear();
  }
  return result;
}

std::vector<int> IncrementalSmoother::ChooseSeeds(
    std::vector<Candidate> candidates) const {
  // The surest first; the step that each alone would cause tells which others
  // go with it.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) {
                     return a.innovation < b.innovation;
                   });
  if (candidates.size() > kMaxSeedTests) candidates.resize(kMaxSeedTests);
  std::vector<std::vector<int>> supported(candidates.size());
  for (size_t k = 0; k != candidates.size(); ++k) {
    const LinearFactor& factor = candidates[k].factor;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(3 * factor_.size());
    if (factor.a >= 0) {
      step.segment<3>(3 * factor.a) -=
          factor.jacobian_a.transpose() * candidates[k].gain;
    }
    if (factor.b >= 0) {
      step.segment<3>(3 * factor.b) -=
          factor.jacobian_b.transpose() * candidates[k].gain;
    }
    factor_.SolveSystem(&step);
    const auto moved = [&](const int pose) {
      if (pose == 0) return poses_[0];
      return Pose2(poses_[pose].x + step[3 * pose - 3],
                   poses_[pose].y + step[3 * pose - 2],
                   NormalizeAngle(poses_[pose].theta + step[3 * pose - 1]));
    };
    for (const Candidate& other : candidates) {
      const WhitenedEdge& edge = edges_[other.edge];
      const double chi2 = Chi2(edge, moved(edge.from), moved(edge.to));
      if (chi2 < kWideGate &&
          2. * chi2 < Chi2(edge, poses_[edge.from], poses_[edge.to])) {
        supported[k].push_back(other.edge);
      }
    }
  }
  std::vector<int> seeds;
  std::vector<bool> used(candidates.size(), false);
  while (static_cast<int>(seeds.size()) < options_.max_hypotheses) {
    int best = -1;
    for (size_t k = 0; k != candidates.size(); ++k) {
      if (!used[k] &&
          (best < 0 || supported[k].size() > supported[best].size())) {
        best = k;
      }
    }
    if (best < 0) break;
    seeds.push_back(candidates[best].edge);
    used[best] = true;
    // What it explains need not be tried on its own.
    for (size_t k = 0; k != candidates.size(); ++k) {
      used[k] =
          used[k] || std::find(supported[best].begin(), supported[best].end(),
                               candidates[k].edge) != supported[best].end();
    }
  }
  return seeds;
}

bool IncrementalSmoother::IsSupported(const std::vector<Pose2>& poses,
                                      const std::vector<Pose2>& present,
                                      const double majority) const {
  if (!LoopsAgree(edges_, poses, options_.gate, majority)) return false;
  const int revisits = NewRevisits(edges_, present, poses, options_.gate);
  if (revisits >= kMinRevisits) return true;
  // A small map has few stretches; there nearly all of its loops must agree.
  return revisits >= 2 && CountLoops(edges_) >= kManyLoops &&
         LoopsAgree(edges_, poses, options_.gate, kNearlyAll);
}

bool IncrementalSmoother::TryHypotheses(const int first_edge,
                                        const double majority,
                                        const std::vector<Pose2>& present,
                                        RobustSolver* const batch) {
  if (options_.max_hypotheses <= 0) return false;
  const std::vector<Candidate> candidates =
      FindCandidates(first_edge, majority);
  if (candidates.empty()) return false;
  double lowest = TruncatedCost(edges_, present) - options_.gate;
  bool improved = false;
  std::vector<Pose2> best;
  SolverOptions solver = EpochSolverOptions();
  solver.kernel.parameter = std::max(solver.kernel.parameter, options_.gate);
  const std::vector<int> seeds = ChooseSeeds(candidates);
  std::set<int> explained;
  for (const int seed : seeds) {
    if (explained.count(seed) > 0) continue;
    ++num_hypotheses_;
    std::vector<Pose2> poses = poses_;
    edges_[seed].is_loop = false;  // in force whatever its error
    batch->Solve(solver, &poses);
    edges_[seed].is_loop = true;
    // Another one that fits this map would lead to it.
    for (const int other : seeds) {
      if (Agrees(edges_[other], poses, options_.gate)) explained.insert(other);
    }
    // Most hypotheses stand alone; that shows before the polish.
    if (!LoopsAgree(edges_, poses, kWideGate, majority)) continue;
    batch->Solve(solver, &poses);
    PolishTruncated(options_.gate, options_.polish_rounds, batch, &poses,
                    nullptr);
    const double cost = TruncatedCost(edges_, poses);
    if (cost < lowest && IsSupported(poses, present, majority)) {
      lowest = cost;
      best = poses;
      improved = true;
    }
  }
  if (improved) poses_ = best;
  return improved;
}

void IncrementalSmoother::Finish() {
  EndEpoch();
  if (num_poses() < 2 || !status_.ok() ||
      !(options_.late_rejection && options_.readmission)) {
    return;
  }
  RobustSolver batch(edges_, RobustSolver::LastPoseLast());
  batch.TakeMemory(std::move(memory_));
  for (int round = 0; round != kMaxFinalRounds &&
                      TryHypotheses(0, kFinalMajority, poses_, &batch);
       ++round) {
    DecideLoops();
    if (!Relinearize(&batch)) return;
  }
  if (!options_.polish_at_end) return;
  TryWiderKernels(&batch);
  std::vector<double> weights;
  PolishTruncated(options_.gate, kFinalPolishRounds, &batch, &poses_, &weights);
  if (options_.adaptive_gate) {
    PolishAdapted(kFinalPolishRounds, &batch, &poses_, &weights);
  }
  for (size_t i = 0; i != edges_.size(); ++i) accepted_[i] = weights[i] > 0.5;
  RebuildFactor(&batch);
  estimate_outdated_ = false;
}

bool IncrementalSmoother::KernelIsNarrow() const {
  // Too few to say: less than half of the loops, and no more than there may be
  // by chance.
  constexpr double kFewOverChance = 100.;
  const double log_area = LogArea(poses_);
  double weights = 0., by_chance = 0.;
  int loops = 0, agreeing = 0;
  for (const WhitenedEdge& edge : edges_) {
    if (!edge.is_loop) continue;
    ++loops;
    by_chance += ChanceToFit(edge, log_area, options_.gate);
    const double chi2 = Chi2(edge, poses_[edge.from], poses_[edge.to]);
    if (chi2 >= options_.gate) continue;
    ++agreeing;
    weights += EvaluateKernel(options_.epoch_kernel, chi2,
                              AcsShape(options_.epoch_kernel))
                   .weight;
  }
  return agreeing >= std::min(0.5 * loops, kFewOverChance * by_chance) &&
         weights < 0.5 * agreeing;
}

void IncrementalSmoother::TryWiderKernels(RobustSolver* const batch) {
  // Loops far beyond reach would only fill the factor.
  constexpr double kReach = 25.;
  SolverOptions solver;
  solver.kernel = options_.epoch_kernel;
  solver.cost_tolerance = 1e-5;
  solver.edge_weights = Chi2OfEdges(edges_, poses_);
  bool some_in_reach = false;
  for (size_t i = 0; i != edges_.size(); ++i) {
    const double chi2 = solver.edge_weights[i];
    const bool in_reach = chi2 < kReach * options_.gate;
    solver.edge_weights[i] = !edges_[i].is_loop || in_reach ? 1. : 0.;
    some_in_reach |= edges_[i].is_loop && in_reach && chi2 >= options_.gate;
  }
  if (!some_in_reach) return;
  const std::vector<double> widths =
      KernelIsNarrow()
          ? std::vector<double>{options_.gate, 4. * options_.gate}
          : std::vector<double>{4. * options_.epoch_kernel.parameter};
  double lowest = TruncatedCost(edges_, poses_);
  const std::vector<Pose2> start = poses_;
  for (const double width : widths) {
    std::vector<Pose2> poses = start;
    solver.kernel.parameter = width;
    batch->Solve(solver, &poses);
    PolishTruncated(options_.gate, kFinalPolishRounds, batch, &poses, nullptr);
    const double cost = TruncatedCost(edges_, poses);
    if (cost < lowest) {
      lowest = cost;
      poses_ = poses;
    }
  }
}

void IncrementalSmoother::RebuildFactor(RobustSolver* const batch) {
  linearization_poses_ = poses_;
  const std::vector<double> weights(accepted_.begin(), accepted_.end());
  Eigen::VectorXd rhs;
  const BlockLdlt* const factor = batch->Factor(poses_, weights, &rhs);
  if (factor == nullptr) {
    status_ = absl::InternalError(
        absl::StrCat("the system of ", num_poses(),
                     " poses cannot be factorised: information matrices are "
                     "too uneven"));
    return;
  }
  factor_.Reset(*factor, rhs);
}

bool IncrementalSmoother::Relinearize(RobustSolver* const batch) {
  RebuildFactor(batch);
  if (status_.ok()) UpdateEstimate();
  return status_.ok();
}

}  // namespace optimization
}  // namespace cartographer_ext
