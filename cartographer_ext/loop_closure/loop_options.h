// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// All options of loop closure, those of the stages together. The initial values
// here and in the stages are the defaults; those of them that are keys of the
// Lua block are repeated in the option message, and a test compares the two.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_OPTIONS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_OPTIONS_H_

#include <string>

#include "Eigen/Core"
#include "cartographer_ext/loop_closure/candidate_search/search_planner.h"
#include "cartographer_ext/loop_closure/candidate_search/typical_fit.h"
#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"
#include "cartographer_ext/loop_closure/information/constraint_information.h"
#include "cartographer_ext/loop_closure/relocalization/relocalization_options.h"
#include "cartographer_ext/loop_closure/verification/dtw.h"
#include "cartographer_ext/loop_closure/verification/dynamic_threshold.h"
#include "cartographer_ext/loop_closure/verification/loop_mixture.h"
#include "cartographer_ext/loop_closure/verification/score_fusion.h"
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"
#include "cartographer_ext/loop_closure_options.pb.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// Temporal score S_t: which nodes are compared, and how.
struct TemporalStageOptions {
  bool enabled = true;
  VariableWindowOptions window;
  // Path length between compared nodes, metres, >= 0. If nodes are closer, this
  // covers a longer path with the same number of comparisons.
  double spacing = 0.5;
  // Per trajectory, about 1500 bytes each; the paths between nodes are kept as
  // long: about 5 km of driving.
  int max_history_nodes = 20000;
  // Submaps on each side that extend the reference where the path leaves the
  // submap; two overlap at any place.
  int num_neighbours = 2;
  TemporalVerificationOptions comparison;
};

// How grid score and temporal score are fused.
enum class FusionMode {
  kAsPrinted,        // C eq. 5 to 7
  kLikelihoodRatio,  // the probability that the loop is true
};

// Options of score fusion.
struct FusionStageOptions {
  bool enabled = true;
  FusionMode mode = FusionMode::kLikelihoodRatio;
  // Candidates with a lower final score are rejected.
  double min_final_score = 0.01;
  ScoreFusionOptions blend;    // kAsPrinted
  LoopMixtureOptions mixture;  // kLikelihoodRatio
};

// The options of loop closure.
struct LoopOptions {
  SearchPlannerOptions search;
  TypicalFitOptions typical_fit;  // without effect if `search` is off
  TemporalStageOptions temporal;
  DynamicThresholdOptions threshold;
  FusionStageOptions fusion;
  InnovationOptions innovation_veto;
  ConfidenceWeightOptions information;
  CompatibleSubsetOptions compatible_subset;
  RelocalizationOptions relocalization;
  uncertainty::PathNoiseOptions path_noise;
  // Standard deviation of a loop itself: a cell of 5 cm, and the corresponding
  // angle over a few metres. Metres and radians, > 0.
  double loop_translation = 0.05;
  double loop_rotation = 0.01;
  // Limit of the cached search structures of submaps, bytes; others are rebuilt
  // when they are needed.
  size_t max_cache_bytes = size_t{64} << 20;
  // Whether matches are tested against other poses along the least observable
  // direction (dropin/slide_test.h), and the smallest log-odds: about 3 to 1.
  // Not in paper modes and not without score fusion.
  bool slide_test = true;
  double min_slide_odds = 1.;
  // Records with the CPU time of each stage differ from run to run.
  bool log_times = false;
  // Folder of records that are written while the program runs; empty: none.
  std::string log_directory;
};

// Converts the options of the Lua block.
LoopOptions ToLoopOptions(const proto::LoopClosureOptions& message);

// Covariance of a loop itself; (metres, metres, radians) squared.
Eigen::Matrix3d LoopCovariance(const LoopOptions& options);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_OPTIONS_H_
