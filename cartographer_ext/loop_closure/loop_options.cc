// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_options.h"

#include <limits>

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopClosureOptions;

void ReadSearch(const LoopClosureOptions::Search& from,
                SearchPlannerOptions* const to) {
  to->enabled = from.enabled();
  to->max_searches_per_node = from.max_searches_per_node();
  to->global_search = from.global_search();
}

void ReadVerification(const LoopClosureOptions& from, LoopOptions* const to) {
  to->temporal.enabled = from.temporal_verification().enabled();
  to->temporal.window.base = from.temporal_verification().window_base();
  to->temporal.window.gamma = from.temporal_verification().window_gamma();
  to->threshold.enabled = from.dynamic_threshold().enabled();
  to->threshold.low = from.dynamic_threshold().low();
  to->threshold.span = from.dynamic_threshold().span();
  to->fusion.enabled = from.fusion().enabled();
  to->fusion.min_final_score = from.fusion().min_final_score();
}

void ReadInformation(const LoopClosureOptions::Information& from,
                     ConfidenceWeightOptions* const to) {
  to->enabled = from.enabled();
  to->alpha = from.alpha();
  to->beta = from.beta();
  to->reference_score = from.reference_score();
  to->full_matrix = from.full_matrix();
}

void ReadCompatibleSubset(const LoopClosureOptions::CompatibleSubset& from,
                          CompatibleSubsetOptions* const to) {
  to->enabled = from.enabled();
  to->min_revisits = from.min_revisits();
  to->single_strong_enabled = from.single_strong();
  to->weak_prior_sigma = from.weak_prior_sigma();
  to->weak_prior_revisits = from.weak_prior_revisits();
}

// The values of the papers that are no keys of their own; third_party_notes
// lists them.
void ReadPaperMode(const LoopClosureOptions::PaperMode& from,
                   LoopOptions* const to) {
  if (from.temporal_verification()) {
    to->temporal.spacing = 0.;
    to->temporal.comparison.minimum_length = 2;
    to->temporal.comparison.step = WarpingStep::kSymmetric;
    to->temporal.comparison.comparison = ScanComparison::kSectors;
  }
  if (from.dynamic_threshold()) {
    to->threshold.direction = ThresholdDirection::kAsPrinted;
  }
  if (from.fusion()) to->fusion.mode = FusionMode::kAsPrinted;
  if (from.compatible_subset()) {
    CompatibleSubsetOptions* const subset = &to->compatible_subset;
    subset->cycle.test = uncertainty::CycleTest::kFixedBound;
    subset->informative_sigma = std::numeric_limits<double>::infinity();
    subset->tolerance = 0.;
    subset->predicted_tolerance = 0.;
    subset->accepted_weight = 1.;
    subset->single_strong_enabled = false;
    subset->weak_prior_revisits = subset->min_revisits;
    subset->unpredicted_revisits = subset->min_revisits;
  }
}

}  // namespace

LoopOptions ToLoopOptions(const LoopClosureOptions& message) {
  LoopOptions options;
  ReadSearch(message.search(), &options.search);
  options.max_cache_bytes = static_cast<size_t>(message.search().max_cache_mb())
                            << 20;
  ReadVerification(message, &options);
  options.slide_test =
      message.fusion().enabled() && !message.paper_mode().fusion();
  options.innovation_veto.enabled = message.innovation_veto().enabled();
  ReadInformation(message.information(), &options.information);
  ReadCompatibleSubset(message.compatible_subset(), &options.compatible_subset);
  options.relocalization.enabled = message.localization().enabled();
  options.log_times = message.log().times();
  options.log_directory = message.log().directory();
  ReadPaperMode(message.paper_mode(), &options);
  return options;
}

Eigen::Matrix3d LoopCovariance(const LoopOptions& options) {
  const double translation = options.loop_translation;
  const double rotation = options.loop_rotation;
  return Eigen::Vector3d(translation * translation, translation * translation,
                         rotation * rotation)
      .asDiagonal();
}

}  // namespace loop_closure
}  // namespace cartographer_ext
