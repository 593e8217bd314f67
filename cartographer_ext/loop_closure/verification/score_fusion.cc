// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/score_fusion.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Exponent of an unnormalised Gaussian.
double LogGaussian(const double x, const double mean, const double sigma) {
  const double z = (x - mean) / sigma;
  return -0.5 * z * z;
}

}  // namespace

double FusionLambda(const ScoreFusionOptions& options, const double grid_score,
                    const ScoreStatistics& grid, const double temporal_score,
                    const ScoreStatistics& temporal) {
  const double sigma_g = std::max(grid.sigma, options.sigma_floor);
  const double sigma_t = std::max(temporal.sigma, options.sigma_floor);
  const double log_g = LogGaussian(grid_score, grid.mean, sigma_g);
  const double log_t = LogGaussian(temporal_score, temporal.mean, sigma_t);
  // g / (g + t) = 1 / (1 + exp(log t - log g)); exp may overflow to infinity,
  // which gives the right limit 0.
  return 1. / (1. + std::exp(log_t - log_g));
}

ScoreFusion::ScoreFusion(const ScoreFusionOptions& options)
    : options_(options),
      grid_scores_(options.window),
      temporal_scores_(options.window) {}

FusedScore ScoreFusion::Fuse(const double grid_score,
                             const double temporal_score) const {
  FusedScore fused;
  if (grid_scores_.full()) {
    const ScoreStatistics grid{grid_scores_.Mean(),
                               std::sqrt(grid_scores_.Variance())};
    const ScoreStatistics temporal{temporal_scores_.Mean(),
                                   std::sqrt(temporal_scores_.Variance())};
    fused.lambda =
        FusionLambda(options_, grid_score, grid, temporal_score, temporal);
  } else {
    fused.lambda = options_.initial_lambda;
  }
  fused.score =
      fused.lambda * grid_score + (1. - fused.lambda) * temporal_score;
  return fused;
}

void ScoreFusion::AddScores(const double grid_score,
                            const double temporal_score) {
  grid_scores_.Add(grid_score);
  temporal_scores_.Add(temporal_score);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
