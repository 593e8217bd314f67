// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A calibrated probability that a loop candidate is true: a mixture of two
// Gaussians, "true loop" and "false loop", over the pair s = (S_g, u), fitted
// online, with
//
//   u = -ln(1.02 - S_t)
//
// since the cost 1 - S_t is never below zero and spreads over orders of
// magnitude: in u the scores of either kind are about normal. This replaces the
// fusion of paper C (eq. 6, 7), which rewards typical scores, by the likelihood
// ratio of a proper mixture:
//
//   P(true | s) = pi_1 N(s; m_1, Sigma_1)
//                 / (pi_1 N(s; m_1, Sigma_1) + pi_0 N(s; m_0, Sigma_0))
//
// The fit is the maximum a posteriori estimate by expectation maximisation over
// a bounded window of candidates. Normal-inverse-Wishart priors (strength in
// pseudo-observations) keep a component where it belongs when few candidates
// were seen, keep covariances from collapsing and fix which component is which;
// the true component's means are never below the false one's.
//
// What scans reach at the right place depends on the robot: walls blurred by
// its local SLAM, people, a sparse laser. So the priors follow the run. Scores
// at places that are certain, because the path to them is short or because
// other loops confirm them, are samples of the true component; they replace its prior after some tens of them. A wrong
// place is wrong for the same blurred scans: the false component keeps the
// ratio of its mean scores to those of the true one.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_LOOP_MIXTURE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_LOOP_MIXTURE_H_

#include <array>
#include <deque>

#include "Eigen/Core"

namespace cartographer_ext {
namespace loop_closure {

// u of a temporal score in [0, 1].
double TemporalCoordinate(double temporal_score);
// The inverse.
double ScoreOfCoordinate(double coordinate);

struct MixtureComponent {
  double weight = 0.5;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  // (S_g, u)
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
};

// Log of weight times density of `component` at `scores`, (S_g, u).
double LogWeightedDensity(const MixtureComponent& component,
                          const Eigen::Vector2d& scores);

struct LoopMixtureOptions {
  // Component 0 is "false", 1 is "true".
  std::array<MixtureComponent, 2> prior = DefaultPrior();
  // Pseudo-observations per component, > 0. Few candidates are false, so it is
  // the prior above all that says what they are like; a weak one lets the
  // component of the false ones take over poor true ones.
  double prior_strength = 500.;
  // The same for what `prior` itself is worth against scores of places that are
  // certain, > 0.
  double certain_prior_strength = 20.;
  int capacity = 500;       // candidates remembered, and certain ones, > 0
  int max_iterations = 50;  // of EM per fit
  double tolerance = 1e-6;  // change of the mean log-posterior that stops EM

  // Of scores by beams (temporal_verification.h).
  static std::array<MixtureComponent, 2> DefaultPrior();
};

// Not thread-safe: candidates are added in candidate order.
class LoopMixture {
 public:
  explicit LoopMixture(const LoopMixtureOptions& options);

  // Posterior probability of "true" for (S_g, S_t) under the current fit.
  double ProbabilityTrue(double grid_score, double temporal_score) const;
  // The same where only S_g is known.
  double ProbabilityTrue(double grid_score) const;
  // Remembers the candidate; `Fit` uses it.
  void Add(double grid_score, double temporal_score);
  // The same for one that is true for sure. Where scans compared are in the
  // submap themselves (`has_own_scans`), scores are too good: such samples
  // count only while there are hardly others.
  void AddCertain(double grid_score, double temporal_score, bool has_own_scans);
  // Runs EM from the current parameters; returns the iterations used.
  int Fit();

  const std::array<MixtureComponent, 2>& components() const {
    return components_;
  }
  int size() const { return static_cast<int>(scores_.size()); }
  // S_t at right places of this run over that of the prior, in (0, 1].
  double temporal_scale() const;

 private:
  // The priors of this run, from the scores that are certain.
  void UpdatePrior();

  const LoopMixtureOptions options_;
  std::array<MixtureComponent, 2> prior_;  // of this run
  std::array<MixtureComponent, 2> components_;
  std::deque<Eigen::Vector2d> scores_;  // (S_g, u)
  std::deque<Eigen::Vector2d> certain_scores_;
  std::deque<Eigen::Vector2d> own_scores_;  // certain, with own scans
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_LOOP_MIXTURE_H_
