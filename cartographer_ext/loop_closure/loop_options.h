// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// From the option message of the loop closure to the options of its parts.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_OPTIONS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_OPTIONS_H_

#include "cartographer_ext/loop_closure/candidate_search/typical_fit.h"
#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"
#include "cartographer_ext/loop_closure/information/constraint_information.h"
#include "cartographer_ext/loop_closure/relocalization/map_localization.h"
#include "cartographer_ext/loop_closure/verification/dtw.h"
#include "cartographer_ext/loop_closure/verification/dynamic_threshold.h"
#include "cartographer_ext/loop_closure/verification/loop_mixture.h"
#include "cartographer_ext/loop_closure/verification/score_fusion.h"
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"
#include "cartographer_ext/loop_closure_options.pb.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

VariableWindowOptions ToVariableWindowOptions(
    const proto::LoopClosureOptions& options);
TemporalVerificationOptions ToTemporalVerificationOptions(
    const proto::LoopClosureOptions& options);
DynamicThresholdOptions ToDynamicThresholdOptions(
    const proto::LoopClosureOptions& options);
// The likelihood ratio is not a blend; for it the mode is the paper's and not
// used.
ScoreFusionOptions ToScoreFusionOptions(
    const proto::LoopClosureOptions& options);
LoopMixtureOptions ToLoopMixtureOptions(
    const proto::LoopClosureOptions& options);
ConfidenceWeightOptions ToConfidenceWeightOptions(
    const proto::LoopClosureOptions& options);
uncertainty::PathNoiseOptions ToPathNoiseOptions(
    const proto::LoopClosureOptions& options);
MapLocalizationOptions ToMapLocalizationOptions(
    const proto::LoopClosureOptions& options);
CompatibleSubsetOptions ToCompatibleSubsetOptions(
    const proto::LoopClosureOptions& options);
InnovationOptions ToInnovationOptions(const proto::LoopClosureOptions& options);
TypicalFitOptions ToTypicalFitOptions(const proto::LoopClosureOptions& options);

// Of a loop itself; (metres, metres, radians) squared.
Eigen::Matrix3d LoopCovariance(const proto::LoopClosureOptions& options);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_OPTIONS_H_
