// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_options.h"

namespace cartographer_ext {
namespace loop_closure {

using proto::LoopClosureOptions;

VariableWindowOptions ToVariableWindowOptions(
    const LoopClosureOptions& options) {
  const auto& from = options.temporal_verification();
  VariableWindowOptions to;
  to.base = from.window_base();
  to.span = from.window_span();
  to.gamma = from.window_gamma();
  return to;
}

TemporalVerificationOptions ToTemporalVerificationOptions(
    const LoopClosureOptions& options) {
  const auto& from = options.temporal_verification();
  TemporalVerificationOptions to;
  to.comparison =
      from.comparison() == LoopClosureOptions::TemporalVerification::SECTORS
          ? ScanComparison::kSectors
          : ScanComparison::kBeams;
  to.signature.num_sectors = from.num_sectors();
  to.signature.rays_per_sector = from.rays_per_sector();
  to.signature.max_range = from.max_range();
  to.signature.max_unknown = from.max_unknown();
  to.signature.clip = from.clip();
  to.signature.minimum_overlap = from.minimum_overlap();
  to.beams.max_range = from.max_range();
  to.beams.max_unknown = from.max_unknown();
  to.beams.tolerance = from.tolerance();
  to.beams.clip = from.clip();
  to.beams.minimum_overlap = from.minimum_overlap();
  to.beams.max_beams = from.max_beams();
  to.oversampling = from.oversampling();
  to.step = from.step() == LoopClosureOptions::TemporalVerification::SYMMETRIC
                ? WarpingStep::kSymmetric
                : WarpingStep::kAsymmetric;
  to.band = from.band();
  to.minimum_length = from.minimum_length();
  return to;
}

DynamicThresholdOptions ToDynamicThresholdOptions(
    const LoopClosureOptions& options) {
  const auto& from = options.dynamic_threshold();
  DynamicThresholdOptions to;
  to.direction =
      from.direction() == LoopClosureOptions::DynamicThreshold::AS_PRINTED
          ? ThresholdDirection::kAsPrinted
          : ThresholdDirection::kStricterWhenUnstable;
  to.low = from.low();
  to.span = from.span();
  to.sensitivity = from.sensitivity();
  to.window = from.window();
  to.base_threshold = from.base_threshold();
  return to;
}

ScoreFusionOptions ToScoreFusionOptions(const LoopClosureOptions& options) {
  const auto& from = options.fusion();
  ScoreFusionOptions to;
  to.window = from.window();
  to.sigma_floor = from.sigma_floor();
  return to;
}

LoopMixtureOptions ToLoopMixtureOptions(const LoopClosureOptions& options) {
  LoopMixtureOptions to;
  to.prior_strength = options.fusion().prior_strength();
  to.capacity = options.fusion().capacity();
  return to;
}

ConfidenceWeightOptions ToConfidenceWeightOptions(
    const LoopClosureOptions& options) {
  const auto& from = options.information();
  ConfidenceWeightOptions to;
  to.alpha = from.alpha();
  to.beta = from.beta();
  to.reference_score = from.reference_score();
  to.minimum_score = from.minimum_score();
  return to;
}

uncertainty::PathNoiseOptions ToPathNoiseOptions(
    const LoopClosureOptions& options) {
  const auto& from = options.path_noise();
  uncertainty::PathNoiseOptions to;
  to.translation_per_metre = from.translation_per_metre();
  to.translation_per_radian = from.translation_per_radian();
  to.rotation_per_metre = from.rotation_per_metre();
  to.rotation_per_radian = from.rotation_per_radian();
  to.heading_drift = from.heading_drift();
  to.scale_error = from.scale_error();
  to.jump_threshold_metres = from.free_metres();
  to.jump_threshold_radians = from.free_radians();
  return to;
}

MapLocalizationOptions ToMapLocalizationOptions(
    const LoopClosureOptions& options) {
  const auto& from = options.localization();
  MapLocalizationOptions to;
  to.query_spacing = from.query_spacing();
  to.watch_spacing = from.watch_spacing();
  to.lost_distance = from.lost_distance();
  to.watches = from.watches();
  return to;
}

TypicalFitOptions ToTypicalFitOptions(const LoopClosureOptions& options) {
  TypicalFitOptions to;
  to.reference =
      options.search().enabled() ? options.search().fit_reference() : 0.;
  to.least_scale = options.search().least_fit_scale();
  return to;
}

CompatibleSubsetOptions ToCompatibleSubsetOptions(
    const LoopClosureOptions& options) {
  const auto& from = options.compatible_subset();
  CompatibleSubsetOptions to;
  to.cycle.test =
      from.test() == LoopClosureOptions::CompatibleSubset::FIXED_BOUND
          ? uncertainty::CycleTest::kFixedBound
          : uncertainty::CycleTest::kChiSquare;
  to.cycle.chi_square_bound = from.chi_square_bound();
  to.cycle.translation_bound = from.translation_bound();
  to.cycle.rotation_bound = from.rotation_bound();
  to.revisit_distance = from.revisit_distance();
  to.informative_sigma = from.informative_sigma();
  to.min_revisits = from.min_revisits();
  to.tolerance = from.tolerance();
  to.predicted_tolerance = from.predicted_tolerance();
  to.single_strong_enabled = from.single_strong();
  to.single_strong_score = from.single_strong_score();
  to.single_strong_loops = from.single_strong_loops();
  to.single_strong_sigma = from.single_strong_sigma();
  to.doubtful_sigma = from.doubtful_sigma();
  to.doubtful_revisits = from.doubtful_revisits();
  to.unpredicted_revisits = options.localization().revisits();
  to.max_clusters = from.max_clusters();
  to.clique.max_steps = from.max_clique_steps();
  return to;
}

InnovationOptions ToInnovationOptions(const LoopClosureOptions& options) {
  InnovationOptions to;
  to.chi_square_bound = options.innovation_veto().chi_square_bound();
  return to;
}

Eigen::Matrix3d LoopCovariance(const LoopClosureOptions& options) {
  const double translation = options.path_noise().loop_translation();
  const double rotation = options.path_noise().loop_rotation();
  return Eigen::Vector3d(translation * translation, translation * translation,
                         rotation * rotation)
      .asDiagonal();
}

}  // namespace loop_closure
}  // namespace cartographer_ext
