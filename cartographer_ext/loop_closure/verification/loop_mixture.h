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
// That score ranks and decides; it is no frequency, since the weights of the
// components are those of all candidates alike. How often a match is right
// depends on the search as well (search_prior.h). Wrong places that match are
// clutter with a density c per square metre and radian, and a true match has the
// density g where this one lies, so that, as in the probabilistic data
// association filter (IEEE Control Systems Magazine 29(6), 2009),
//
//   P(true | s, search) = g / (g + c (N_0 / N_1)^t)
//
// c is estimated from the run: look-alike buildings have more clutter, lasers
// that see far have less. The estimate shall not depend on how far local SLAM is
// believed to drift, so for it g = 1 / V in a search of volume V. The exponent
// t < 1 tempers the ratio of the Gaussians: scores have heavier tails than these,
// and both are computed from the same scan, so far from the means a ratio taken
// literally claims a certainty that it does not have.
//
// The fit is the maximum a posteriori estimate by expectation maximisation over
// a bounded window of candidates. Normal-inverse-Wishart priors (strength in
// pseudo-observations) keep the components in place with few candidates, keep
// covariances from collapsing and determine which component is which; the means
// of the true component are never below those of the false one.
//
// The scores of scans at the right place depend on the run: walls blurred by
// local SLAM, people, a sparse laser. So the priors adapt to the run. Scores at
// certain places, where the path is short or other loops confirm the match, are
// samples of the true component; some tens of them replace its prior. Wrong
// places are affected by the same blur: the false component keeps the ratio of
// its mean scores to those of the true one.
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

// A weighted Gaussian over (S_g, u).
struct MixtureComponent {
  double weight = 0.5;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  // (S_g, u)
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
};

// Log of weight times density of `component` at `scores`, (S_g, u).
double LogWeightedDensity(const MixtureComponent& component,
                          const Eigen::Vector2d& scores);

// Priors and limits of the fit.
struct LoopMixtureOptions {
  // Component 0 is "false", 1 is "true".
  std::array<MixtureComponent, 2> prior = DefaultPrior();
  // Pseudo-observations per component, > 0. Few candidates are false, so the
  // false component is mainly determined by its prior; with a weak one it would
  // absorb poor true loops.
  double prior_strength = 500.;
  // The same for the weight of `prior` itself against scores at certain places,
  // > 0.
  double certain_prior_strength = 20.;
  // c before the run says otherwise, per square metre and radian, > 0.
  double clutter_density = 0.05;
  // What that is worth, in wrong matches, > 0.
  double clutter_prior_strength = 20.;
  double likelihood_exponent = 0.4;  // t, > 0
  int capacity = 500;                // of candidates, and of certain ones, > 0
  int max_iterations = 50;           // of EM per fit
  double tolerance = 1e-6;  // change of the mean log-posterior that stops EM

  // For scores by beams (temporal_verification.h).
  static std::array<MixtureComponent, 2> DefaultPrior();
};

// Not thread-safe: candidates are added in candidate order.
class LoopMixture {
 public:
  explicit LoopMixture(const LoopMixtureOptions& options);

  // Posterior probability of "true" for (S_g, S_t) under the current fit.
  double ProbabilityTrue(double grid_score, double temporal_score) const;
  // The same if only S_g is known.
  double ProbabilityTrue(double grid_score) const;
  // Density of wrong matches with the scores (S_g, S_t), relative to how probable
  // these are of true ones: c (N_0 / N_1)^t above, per m^2 rad.
  double WrongDensity(double grid_score, double temporal_score) const;
  // The same if only S_g is known.
  double WrongDensity(double grid_score) const;
  // Adds a candidate for `Fit`, the best match in a search of `volume` (m^2 rad,
  // > 0).
  void Add(double grid_score, double temporal_score, double volume);
  // The same for one that is certainly true. If compared scans are part of the
  // submap themselves (`has_own_scans`), scores are too high: such samples are
  // used only while there are hardly any others.
  void AddCertain(double grid_score, double temporal_score, bool has_own_scans);
  // Runs EM from the current parameters; returns the iterations used.
  int Fit();

  const std::array<MixtureComponent, 2>& components() const {
    return components_;
  }
  double clutter_density() const { return clutter_density_; }  // c
  int size() const { return static_cast<int>(scores_.size()); }
  // S_t at right places of this run relative to that of the prior, in (0, 1].
  double temporal_scale() const;

 private:
  // Updates the priors from the scores at certain places.
  void UpdatePrior();
  int FitComponents();
  // ln(pi_0 / pi_1).
  double LogWeightRatio() const;
  // (N_0 / N_1)^t.
  double TemperedRatio(const Eigen::Vector2d& scores) const;
  void FitClutterDensity();

  const LoopMixtureOptions options_;
  std::array<MixtureComponent, 2> prior_;  // of this run
  std::array<MixtureComponent, 2> components_;
  std::deque<Eigen::Vector2d> scores_;  // (S_g, u)
  std::deque<double> volumes_;          // of their searches
  double clutter_density_;
  std::deque<Eigen::Vector2d> certain_scores_;
  std::deque<Eigen::Vector2d> own_scores_;  // certain, with own scans
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_LOOP_MIXTURE_H_
