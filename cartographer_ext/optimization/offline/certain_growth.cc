// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/certain_growth.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "Eigen/Cholesky"
#include "Eigen/LU"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/solvers/loop_predictor.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Rounds of growth by groups between those by certain loops: a few groups do not yet
// make others certain. And how often in turn at most.
constexpr int kRoundsOfGroups = 20;
constexpr int kMaxTurns = 20;

// Odds against any wrong loop in a round: a hundred to one while that brings
// loops in, then ten to one, then one to one.
const double kFirstLogOdds = std::log(100.);
// A round that brings in less than this share of what is in force is the last
// with these odds, and the last of all.
constexpr double kSlowProgress = 0.02;
constexpr double kNoProgress = 1e-3;
// Share of the loops in force that is worth another look at those that fit,
// before any is predicted.
constexpr double kMuch = 0.05;

// Multiplications with a block.
constexpr double kWorkOfBlock = 27.;
// Predictions that one is worth which makes a loop certain.
constexpr double kWorthOfCertain = 4.;
// Loops that are predicted before the work that is left is looked at.
constexpr size_t kAtOnce = 32;
// A step that lowers the cost by less than this fraction is the last of a round.
constexpr double kRoundTolerance = 1e-2;

struct Candidate {
  int edge = 0;
  double score = 0.;  // log likelihood ratio
  double chi2 = 0.;   // of the innovation
  // Poses along the path from its ends to those of what has come in.
  int distance = 0;
};

// For each pose how many poses along the path the nearest of the `touched` is
// away.
std::vector<int> DistancesAlongPath(const std::vector<bool>& touched) {
  const int n = touched.size();
  std::vector<int> result(n, n);
  for (int i = 0; i != n; ++i) {
    if (touched[i]) {
      result[i] = 0;
    } else if (i > 0) {
      result[i] = std::min(n, result[i - 1] + 1);
    }
  }
  for (int i = n - 1; i > 0; --i) {
    result[i - 1] = std::min(result[i - 1], result[i] + 1);
  }
  return result;
}

class CertainGrowth {
 public:
  CertainGrowth(const PoseGraph& graph, const CertainGrowthOptions& options,
                RobustSolver* const solver, std::vector<Pose2>* const poses,
                std::vector<double>* const weights)
      : options_(options),
        solver_(*solver),
        edges_(solver->edges()),
        poses_(*poses),
        weights_(*weights),
        covariances_(PredictAlongChain(graph, edges_, *poses)) {}

  // From odometry alone.
  int Run() {
    weights_.assign(edges_.size(), 1.);
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (edges_[i].is_loop) weights_[i] = 0.;
    }
    return Continue();
  }

  // With the loops that have weight in force.
  int Continue() {
    if (covariances_.empty()) return 0;
    given_up_.assign(edges_.size(), 0);
    touched_.assign(poses_.size(), false);
    int in_force = 0;
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (!edges_[i].is_loop || weights_[i] == 0.) continue;
      TakeIn(i);
      ++in_force;
    }
    double log_odds = kFirstLogOdds;
    bool predicted = in_force == 0;
    for (int round = 0; round != options_.max_rounds; ++round) {
      const int before = in_force;
      const bool knows_all = predicted;
      const int entered = TakeInCertain(log_odds);
      const int fitting = TakeInFitting(log_odds);
      if (entered + fitting > 0) {
        Solve();
        in_force = LetGo();
        predicted = false;
      }
      // With the poses of so many more, others may fit.
      if (fitting > kMuch * before && in_force > before) continue;
      const double little = log_odds > 0. ? kSlowProgress : kNoProgress;
      if (knows_all && in_force - before <= little * before) {
        if (log_odds <= 0.) break;
        log_odds -= 0.5 * kFirstLogOdds;
      }
      if (!predicted) PredictByFactor(log_odds);
      predicted = true;
    }
    return in_force;
  }

 private:
  Candidate Weigh(const int edge, const double log_area) const {
    const WhitenedEdge& loop = edges_[edge];
    const Eigen::Vector3d residual =
        Residual(loop, poses_[loop.from], poses_[loop.to]);
    const Eigen::LLT<Eigen::Matrix3d> root(covariances_[edge]);
    const double log_determinant =
        2. * root.matrixLLT().diagonal().array().log().sum();
    Candidate result;
    result.edge = edge;
    result.chi2 = residual.dot(root.solve(residual));
    result.score =
        LogVolume(loop, log_area) - 0.5 * (result.chi2 + log_determinant);
    return result;
  }

  std::vector<Candidate> OpenLoops() const {
    const double log_area = LogArea(poses_);
    std::vector<Candidate> result;
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (!edges_[i].is_loop || weights_[i] > 0. || given_up_[i] > 1) continue;
      result.push_back(Weigh(i, log_area));
    }
    return result;
  }

  bool IsCertain(const Candidate& candidate, const double enough) const {
    return candidate.chi2 < options_.gate && candidate.score >= enough;
  }

  int TakeInCertain(const double log_odds) {
    const std::vector<Candidate> candidates = OpenLoops();
    const double enough = std::log(candidates.size()) + log_odds;
    int entered = 0;
    for (const Candidate& candidate : candidates) {
      if (!IsCertain(candidate, enough)) continue;
      TakeIn(candidate.edge);
      ++entered;
    }
    return entered;
  }

  // Loops that fit the poses as they are, where few would do so by chance.
  int TakeInFitting(const double log_odds) {
    const double log_area = LogArea(poses_);
    std::vector<int> fitting;
    double by_chance = 0.;
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (!edges_[i].is_loop || weights_[i] > 0. || given_up_[i] > 1) continue;
      by_chance += ChanceToFit(edges_[i], log_area, options_.gate);
      if (Chi2(edges_[i], poses_[edges_[i].from], poses_[edges_[i].to]) <
          options_.gate) {
        fitting.push_back(i);
      }
    }
    if (fitting.size() < std::exp(log_odds) * by_chance) return 0;
    for (const int i : fitting) TakeIn(i);
    return fitting.size();
  }

  void TakeIn(const int edge) {
    weights_[edge] = 1.;
    touched_[edges_[edge].from] = touched_[edges_[edge].to] = true;
  }

  void Solve() {
    SolverOptions options;
    options.kernel = DefaultKernel(KernelType::kDcs);
    options.kernel.parameter = options_.gate;
    options.edge_weights = weights_;
    options.max_iterations = 10;
    options.cost_tolerance = kRoundTolerance;
    options.initial_lambda = 1e-8;
    solver_.Solve(options, &poses_);
  }

  // Returns the number of loops that stay in force.
  int LetGo() {
    int result = 0;
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (!edges_[i].is_loop || weights_[i] == 0.) continue;
      if (Chi2(edges_[i], poses_[edges_[i].from], poses_[edges_[i].to]) >=
          options_.gate) {
        weights_[i] = 0.;
        ++given_up_[i];
      } else {
        ++result;
      }
    }
    return result;
  }

  // Covariances of open loops that do not contradict their last ones, first of
  // those near what has come in since, which it makes sharper: as far as that
  // takes no more work than allowed, and on as long as they become certain.
  void PredictByFactor(const double log_odds) {
    const std::vector<int> distances = DistancesAlongPath(touched_);
    touched_.assign(touched_.size(), false);
    std::vector<Candidate> candidates = OpenLoops();
    const double enough = std::log(candidates.size()) + log_odds;
    candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                    [this](const Candidate& candidate) {
                                      return candidate.chi2 >=
                                             options_.max_gates * options_.gate;
                                    }),
                     candidates.end());
    for (Candidate& candidate : candidates) {
      const WhitenedEdge& edge = edges_[candidate.edge];
      candidate.distance = std::max(distances[edge.from], distances[edge.to]);
    }
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) {
                return std::tie(a.distance, a.chi2, a.edge) <
                       std::tie(b.distance, b.chi2, b.edge);
              });
    Eigen::VectorXd rhs;
    const BlockLdlt* const factorised = solver_.Factor(poses_, weights_, &rhs);
    if (factorised == nullptr) return;
    double left = std::max(options_.min_prediction_work,
                           options_.prediction_work * factorised->work());
    LoopPredictor predictor(edges_, poses_, *factorised);
    const double log_area = LogArea(poses_);
    for (size_t begin = 0; begin < candidates.size(); begin += kAtOnce) {
      const size_t end = std::min(candidates.size(), begin + kAtOnce);
      std::vector<int> loops;
      for (size_t k = begin; k != end; ++k) {
        loops.push_back(candidates[k].edge);
      }
      const std::vector<LoopPrediction> predictions = predictor.Predict(loops);
      for (size_t k = 0; k != loops.size(); ++k) {
        if (left <= 0.) return;
        covariances_[loops[k]] =
            Eigen::Matrix3d::Identity() + predictions[k].covariance;
        const double work = kWorkOfBlock * predictions[k].blocks;
        left += IsCertain(Weigh(loops[k], log_area), enough)
                    ? kWorthOfCertain * work
                    : -work;
      }
    }
  }

  const CertainGrowthOptions& options_;
  RobustSolver& solver_;
  const std::vector<WhitenedEdge>& edges_;
  std::vector<Pose2>& poses_;
  std::vector<double>& weights_;
  std::vector<Eigen::Matrix3d> covariances_;  // S per edge
  std::vector<int> given_up_;                 // how often, per edge
  // Poses whose loops have come in since the last predictions by the factor.
  std::vector<bool> touched_;
};

}  // namespace

std::vector<Eigen::Matrix3d> PredictAlongChain(
    const PoseGraph& graph, const std::vector<WhitenedEdge>& edges,
    const std::vector<Pose2>& poses) {
  std::vector<Eigen::Matrix3d> sums(poses.size(), Eigen::Matrix3d::Zero());
  std::vector<bool> reached(poses.size(), false);
  for (const PoseGraphEdge& edge : graph.edges) {
    if (edge.is_loop || std::abs(edge.to - edge.from) != 1) continue;
    // The noise is in the frame of the measured end.
    const Eigen::Matrix3d adjoint = uncertainty::Adjoint(poses[edge.to]);
    const int later = std::max(edge.from, edge.to);
    if (reached[later]) continue;
    reached[later] = true;
    sums[later] = adjoint * edge.information.inverse() * adjoint.transpose();
  }
  for (size_t k = 1; k < poses.size(); ++k) {
    if (!reached[k]) return {};
    sums[k] += sums[k - 1];
  }
  std::vector<Eigen::Matrix3d> result(edges.size(),
                                      Eigen::Matrix3d::Identity());
  for (size_t i = 0; i != edges.size(); ++i) {
    const WhitenedEdge& edge = edges[i];
    if (!edge.is_loop) continue;
    Eigen::Matrix3d of_from, of_to;
    Linearize(edge, poses[edge.from], poses[edge.to], &of_from, &of_to);
    const int early = std::min(edge.from, edge.to);
    const int late = std::max(edge.from, edge.to);
    // d(pose) / d(twist of the map).
    Eigen::Matrix3d motion = Eigen::Matrix3d::Identity();
    motion(0, 2) = -poses[late].y;
    motion(1, 2) = poses[late].x;
    const Eigen::Matrix3d jacobian =
        (late == edge.to ? of_to : of_from) * motion;
    result[i] += jacobian * (sums[late] - sums[early]) * jacobian.transpose();
  }
  return result;
}

int GrowCertainLoops(const PoseGraph& graph,
                     const CertainGrowthOptions& options,
                     RobustSolver* const solver,
                     std::vector<Pose2>* const poses,
                     std::vector<double>* const weights) {
  return CertainGrowth(graph, options, solver, poses, weights).Run();
}

int GrowMoreCertainLoops(const PoseGraph& graph,
                         const CertainGrowthOptions& options,
                         RobustSolver* const solver,
                         std::vector<Pose2>* const poses,
                         std::vector<double>* const weights) {
  return CertainGrowth(graph, options, solver, poses, weights).Continue();
}

bool GrowCertainLoopsAndGroups(const PoseGraph& graph,
                               const LoopSupport& support,
                               RobustSolver* const solver,
                               std::vector<Pose2>* const poses,
                               std::vector<double>* const weights) {
  const CertainGrowthOptions certain;
  GrowthOptions groups;
  groups.max_rounds = kRoundsOfGroups;
  const std::vector<bool> none_banned(solver->edges().size(), false);
  int before = 0;
  int in_force = GrowCertainLoops(graph, certain, solver, poses, weights);
  if (in_force == 0) return false;
  for (int turn = 0; turn != kMaxTurns && in_force > before; ++turn) {
    before = in_force;
    if (!ContinueGrowth(support, groups, none_banned, solver, poses, weights)) {
      return false;
    }
    in_force = GrowMoreCertainLoops(graph, certain, solver, poses, weights);
  }
  return true;
}

}  // namespace optimization
}  // namespace cartographer_ext
