// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Fusion of the grid score S_g of the correlative search and the temporal score
// S_t of the sequence test (paper C, optimised Cartographer 2025, section 1.3).
//
//   C eq. 5   lambda = P(S_g | S_t)
//   C eq. 6   lambda = N(S_g; mu_g, sigma_g)
//                      / (N(S_g; mu_g, sigma_g) + N(S_t; mu_t, sigma_t))
//   C eq. 7   S_final = lambda S_g + (1 - lambda) S_t
//
// with means and deviations over the last k scores of each kind. Eq. 6 is
// printed with unnormalised Gaussians (no 1/sigma, no mixture weights): it
// rewards typical scores rather than high ones, and it is 0/0 far from both
// means. It is evaluated in the log domain, where it is a logistic function of
// the difference of the exponents, with a floor on sigma.
//
// The other mode, a calibrated probability by a mixture over both scores, is in
// loop_mixture.h.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_FUSION_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_FUSION_H_

#include "cartographer_ext/loop_closure/verification/score_window.h"

namespace cartographer_ext {
namespace loop_closure {

// Parameters of eq. 5 to 7.
struct ScoreFusionOptions {
  int window = 10;              // k, > 0
  double sigma_floor = 0.01;    // > 0, in units of the scores
  double initial_lambda = 0.5;  // until k scores exist, in [0, 1]
};

// Means and standard deviations of both kinds of scores.
struct ScoreStatistics {
  double mean = 0.;
  double sigma = 0.;
};

// C eq. 6 for given statistics; in [0, 1], finite for all finite inputs.
double FusionLambda(const ScoreFusionOptions& options, double grid_score,
                    const ScoreStatistics& grid, double temporal_score,
                    const ScoreStatistics& temporal);

// Result of eq. 6 and 7.
struct FusedScore {
  double lambda = 0.;  // eq. 6
  double score = 0.;   // S_final of eq. 7
};

// Not thread-safe: candidates are fused in candidate order.
class ScoreFusion {
 public:
  explicit ScoreFusion(const ScoreFusionOptions& options);

  // Fuses with the statistics of the candidates before this one.
  FusedScore Fuse(double grid_score, double temporal_score) const;
  void AddScores(double grid_score, double temporal_score);

 private:
  const ScoreFusionOptions options_;
  ScoreWindow grid_scores_;
  ScoreWindow temporal_scores_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_FUSION_H_
