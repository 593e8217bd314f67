// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/loop_growth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "Eigen/Cholesky"
#include "cartographer_ext/common/thinned.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"
#include "cartographer_ext/optimization/solvers/loop_predictor.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// A loop whose prediction is hardly less certain than its measurement changes
// nothing and needs no round of its own: log det of 4 I.
const double kSharplyPredicted = 3. * std::log(4.);
// Gates beyond which a loop stays outside the gate as the map grows: loops in force
// only make a prediction more certain, but for what linearisation changes.
constexpr double kFarOff = 4.;
// What a solution may cost per loop before another start is tried.
constexpr double kPoorCost = 3. * 3.;

SolverSummary SolveInForce(const std::vector<double>& weights,
                           RobustSolver* const solver,
                           std::vector<Pose2>* const poses) {
  SolverOptions options;
  options.edge_weights = weights;
  options.max_iterations = 30;
  options.cost_tolerance = 1e-5;
  options.initial_lambda = 1e-8;
  return solver->Solve(options, poses);
}

class Growth {
 public:
  Growth(const LoopSupport& support, const GrowthOptions& options,
         RobustSolver* const solver, std::vector<Pose2>* const poses,
         std::vector<double>* const weights)
      : support_(support),
        options_(options),
        solver_(*solver),
        edges_(solver->edges()),
        poses_(*poses),
        weights_(*weights) {}

  // Loops that are banned stay out.
  bool Run(std::vector<bool> banned) {
    banned_ = std::move(banned);
    covariances_.assign(edges_.size(), Eigen::Matrix3d::Zero());
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (edges_[i].is_loop) open_.push_back(i);
    }
    cost_ = SolveInForce(weights_, &solver_, &poses_).final_cost;
    for (int round = 0; round != options_.max_rounds; ++round) {
      const std::vector<int> chosen = Choose();
      if (chosen.empty()) break;
      Accept(chosen);
    }
    return std::isfinite(cost_);
  }

 private:
  std::vector<int> Candidates() const {
    std::vector<int> result;
    for (const int i : open_) {
      if (weights_[i] == 0. && !banned_[i]) result.push_back(i);
    }
    result = Thinned(result, options_.max_candidates);
    result.erase(std::remove_if(result.begin(), result.end(),
                                [this](const int i) { return IsFarOff(i); }),
                 result.end());
    return result;
  }

  // Whether a loop is far beyond the gate with an earlier prediction, which was
  // less certain.
  bool IsFarOff(const int i) const {
    const Eigen::Matrix3d& covariance = covariances_[i];
    if (covariance(0, 0) == 0.) return false;
    const WhitenedEdge& edge = edges_[i];
    const Eigen::Vector3d residual =
        Residual(edge, poses_[edge.from], poses_[edge.to]);
    return residual.dot(covariance.llt().solve(residual)) >=
           kFarOff * options_.gate;
  }

  // The loops to bring in next. Those that are far off need no prediction.
  std::vector<int> Choose() {
    const std::vector<int> candidates = Candidates();
    const std::vector<Innovation> innovations =
        PredictLoops(candidates, weights_, poses_, &solver_);
    if (innovations.empty()) return {};
    const double log_area = LogArea(poses_);
    std::vector<double> scores(edges_.size(),
                               -std::numeric_limits<double>::infinity());
    for (size_t k = 0; k != candidates.size(); ++k) {
      covariances_[candidates[k]] = innovations[k].covariance;
      if (innovations[k].chi2 >= options_.gate) continue;
      scores[candidates[k]] =
          LogEvidence(edges_[candidates[k]], innovations[k], log_area);
    }
    int best = -1;
    double highest = -std::numeric_limits<double>::infinity();
    std::vector<int> chosen;
    for (size_t k = 0; k != candidates.size(); ++k) {
      const int i = candidates[k];
      if (!std::isfinite(scores[i])) continue;
      if (innovations[k].log_determinant < kSharplyPredicted) {
        chosen.push_back(i);
      }
      int support = 0;
      for (const int j : support_.agreeing[i]) {
        support += weights_[j] == 0. && std::isfinite(scores[j]);
      }
      // Given this loop the others of its group are sharply predicted.
      const double score =
          scores[i] + std::min(support, options_.max_support) *
                          std::max(0., LogVolume(edges_[i], log_area) -
                                           0.5 * options_.gate);
      if (score > highest) {
        highest = score;
        best = i;
      }
    }
    if (best < 0 || !chosen.empty()) return chosen;
    chosen.push_back(best);
    return chosen;
  }

  void Accept(const std::vector<int>& chosen) {
    const std::vector<Pose2> before = poses_;
    for (const int i : chosen) weights_[i] = 1.;
    double cost = SolveInForce(weights_, &solver_, &poses_).final_cost;
    if (cost - cost_ > kPoorCost * chosen.size()) {
      std::vector<Pose2> other = before;
      if (ChordalPoses(edges_, weights_, &other)) {
        const double other_cost =
            SolveInForce(weights_, &solver_, &other).final_cost;
        if (other_cost < cost) {
          cost = other_cost;
          poses_ = std::move(other);
        }
      }
    }
    if (cost - cost_ > options_.gate * chosen.size()) {
      // The linearised prediction was wrong.
      for (const int i : chosen) {
        weights_[i] = 0.;
        banned_[i] = true;
      }
      poses_ = before;
      return;
    }
    cost_ = cost;
  }

  const LoopSupport& support_;
  const GrowthOptions& options_;
  RobustSolver& solver_;
  const std::vector<WhitenedEdge>& edges_;
  std::vector<Pose2>& poses_;
  std::vector<double>& weights_;
  std::vector<int> open_;
  std::vector<bool> banned_;
  // Of the last prediction of each loop, zero where there is none.
  std::vector<Eigen::Matrix3d> covariances_;
  double cost_ = 0.;
};

}  // namespace

std::vector<Innovation> PredictLoops(const std::vector<int>& loops,
                                     const std::vector<double>& weights,
                                     const std::vector<Pose2>& poses,
                                     RobustSolver* const solver) {
  std::vector<Innovation> result;
  Eigen::VectorXd rhs;
  const BlockLdlt* const factorised = solver->Factor(poses, weights, &rhs);
  if (factorised == nullptr) return result;
  for (const LoopPrediction& prediction :
       LoopPredictor(solver->edges(), poses, *factorised).Predict(loops)) {
    const Eigen::Vector3d& residual = prediction.residual;
    const Eigen::Matrix3d covariance =
        Eigen::Matrix3d::Identity() + prediction.covariance;
    const Eigen::LLT<Eigen::Matrix3d> root(covariance);
    Innovation innovation;
    innovation.covariance = covariance;
    innovation.chi2 = residual.dot(root.solve(residual));
    innovation.log_determinant =
        2. * root.matrixLLT().diagonal().array().log().sum();
    result.push_back(innovation);
  }
  return result;
}

bool MorePossibleThanByChance(const std::vector<Innovation>& innovations) {
  // Wrong loops that lie within the uncertainty of a right map.
  constexpr int kMaxByChance = 2;
  const int possible = std::count_if(
      innovations.begin(), innovations.end(),
      [](const Innovation& innovation) { return innovation.chi2 < kChi2Gate; });
  return possible > kMaxByChance;
}

bool GrowLoops(const LoopSupport& support, const GrowthOptions& options,
               RobustSolver* const solver, std::vector<Pose2>* const poses,
               std::vector<double>* const weights) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  weights->assign(edges.size(), 1.);
  for (size_t i = 0; i != edges.size(); ++i) {
    if (edges[i].is_loop) (*weights)[i] = 0.;
  }
  return ContinueGrowth(support, options,
                        std::vector<bool>(edges.size(), false), solver, poses,
                        weights);
}

bool ContinueGrowth(const LoopSupport& support, const GrowthOptions& options,
                    const std::vector<bool>& banned, RobustSolver* const solver,
                    std::vector<Pose2>* const poses,
                    std::vector<double>* const weights) {
  return Growth(support, options, solver, poses, weights).Run(banned);
}

}  // namespace optimization
}  // namespace cartographer_ext
