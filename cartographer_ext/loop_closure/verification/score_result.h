// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Results of the verification of a candidate (score_verifier.h).
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_RESULT_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_RESULT_H_

#include <array>

#include "absl/types/optional.h"
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"

namespace cartographer_ext {
namespace loop_closure {

// Temporal score with the threshold it was compared with.
struct TemporalScore {
  TemporalResult result;
  int window = 0;              // N of C eq. 4, nodes
  double threshold = 0.;       // tau of C eq. 1 in force
  double score_variance = 0.;  // of C eq. 2
  // All nodes compared are newer than those of the submap.
  bool is_beyond_submap = false;

  bool is_scored() const { return result.outcome == TemporalOutcome::kScored; }
};

// A component of loop_mixture.h in plain numbers, which need no aligned memory.
struct MixtureDescription {
  double weight = 0.;
  double mean_grid = 0.;
  double mean_temporal = 0.;
  double variance_grid = 0.;
  double covariance = 0.;
  double variance_temporal = 0.;
};

// Fused score and the parameters in force.
struct ScoreFusionResult {
  double lambda = 0.;       // of C eq. 6; 0 for the likelihood ratio
  double final_score = 0.;  // S_final of C eq. 7
  // Likelihood ratio only: the calibrated probability that the candidate is true,
  // and the densities behind it per m^2 rad (search_prior.h): of wrong matches
  // with such scores, of a true match anywhere in the search, and of one as it
  // was predicted for the search.
  double probability = 0.;
  double wrong_density = 0.;
  double search_density = 0.;
  double predicted_density = 0.;
  // Of a true match here, by all predictions (TrueDensity); 0: unknown.
  double true_density = 0.;
  // False and true loops; the mixture in force, likelihood ratio only.
  absl::optional<std::array<MixtureDescription, 2>> mixture;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_RESULT_H_
