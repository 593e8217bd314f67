// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_options.h"

#include <string>

#include "cartographer_ext/loop_decision.pb.h"
#include "cartographer_ext/options/option_description.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

proto::LoopClosureOptions Defaults() {
  proto::LoopClosureOptions options;
  options::SetDefaults(&options);
  return options;
}

TEST(LoopOptionsTest, EveryDefaultIsAllowedAndDocumented) {
  for (const auto& option : options::Describe(Defaults())) {
    EXPECT_FALSE(option.documentation.empty()) << option.key;
    EXPECT_EQ(option.value, option.default_value) << option.key;
  }
  const auto check = [](const google::protobuf::Message& message) {
    const auto& descriptor = *message.GetDescriptor();
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const auto& field = *descriptor.field(i);
      const auto& reflection = *message.GetReflection();
      if (field.cpp_type() ==
          google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) {
        EXPECT_EQ(
            options::CheckNumber(field, reflection.GetDouble(message, &field)),
            "")
            << field.full_name();
      }
      if (field.cpp_type() ==
          google::protobuf::FieldDescriptor::CPPTYPE_INT32) {
        EXPECT_EQ(
            options::CheckNumber(field, reflection.GetInt32(message, &field)),
            "")
            << field.full_name();
      }
    }
  };
  const proto::LoopClosureOptions defaults = Defaults();
  check(defaults.search());
  check(defaults.temporal_verification());
  check(defaults.dynamic_threshold());
  check(defaults.fusion());
  check(defaults.information());
  check(defaults.path_noise());
  check(defaults.compatible_subset());
  check(defaults.innovation_veto());
}

TEST(LoopOptionsTest, EveryStageCanBeSwitchedOff) {
  const auto& descriptor = *proto::LoopClosureOptions::descriptor();
  for (const std::string stage :
       {"search", "temporal_verification", "dynamic_threshold", "fusion",
        "information", "compatible_subset", "innovation_veto"}) {
    const auto* const field = descriptor.FindFieldByName(stage);
    ASSERT_NE(field, nullptr) << stage;
    EXPECT_NE(field->message_type()->FindFieldByName("enabled"), nullptr)
        << stage;
  }
}

// What is written beside the fields is what the parts have.
TEST(LoopOptionsTest, DefaultsAgreeWithTheParts) {
  const proto::LoopClosureOptions defaults = Defaults();

  const auto temporal = ToTemporalVerificationOptions(defaults);
  const TemporalVerificationOptions temporal_default;
  EXPECT_EQ(temporal.signature.num_sectors,
            temporal_default.signature.num_sectors);
  EXPECT_EQ(temporal.signature.rays_per_sector,
            temporal_default.signature.rays_per_sector);
  EXPECT_EQ(temporal.comparison, temporal_default.comparison);
  EXPECT_EQ(temporal.beams.max_range, temporal_default.beams.max_range);
  EXPECT_EQ(temporal.beams.max_unknown, temporal_default.beams.max_unknown);
  EXPECT_EQ(temporal.beams.tolerance, temporal_default.beams.tolerance);
  EXPECT_EQ(temporal.beams.clip, temporal_default.beams.clip);
  EXPECT_EQ(temporal.beams.minimum_overlap,
            temporal_default.beams.minimum_overlap);
  EXPECT_EQ(temporal.beams.max_beams, temporal_default.beams.max_beams);
  EXPECT_EQ(temporal.oversampling, temporal_default.oversampling);
  EXPECT_EQ(temporal.step, temporal_default.step);
  EXPECT_EQ(temporal.band, temporal_default.band);

  const auto threshold = ToDynamicThresholdOptions(defaults);
  const DynamicThresholdOptions threshold_default;
  EXPECT_EQ(threshold.direction, threshold_default.direction);
  EXPECT_EQ(threshold.low, threshold_default.low);
  EXPECT_EQ(threshold.span, threshold_default.span);
  EXPECT_EQ(threshold.sensitivity, threshold_default.sensitivity);
  EXPECT_EQ(threshold.window, threshold_default.window);
  EXPECT_EQ(threshold.base_threshold, threshold_default.base_threshold);

  const auto fusion = ToScoreFusionOptions(defaults);
  const ScoreFusionOptions fusion_default;
  EXPECT_EQ(fusion.window, fusion_default.window);
  EXPECT_EQ(fusion.sigma_floor, fusion_default.sigma_floor);
  EXPECT_EQ(ToLoopMixtureOptions(defaults).prior_strength,
            LoopMixtureOptions().prior_strength);
  EXPECT_EQ(ToLoopMixtureOptions(defaults).capacity,
            LoopMixtureOptions().capacity);

  const auto weights = ToConfidenceWeightOptions(defaults);
  const ConfidenceWeightOptions weights_default;
  EXPECT_EQ(weights.alpha, weights_default.alpha);
  EXPECT_EQ(weights.beta, weights_default.beta);
  EXPECT_EQ(weights.reference_score, weights_default.reference_score);
  EXPECT_EQ(weights.minimum_score, weights_default.minimum_score);

  const auto noise = ToPathNoiseOptions(defaults);
  const uncertainty::PathNoiseOptions noise_default;
  EXPECT_EQ(noise.translation_per_metre, noise_default.translation_per_metre);
  EXPECT_EQ(noise.translation_per_radian, noise_default.translation_per_radian);
  EXPECT_EQ(noise.rotation_per_metre, noise_default.rotation_per_metre);
  EXPECT_EQ(noise.rotation_per_radian, noise_default.rotation_per_radian);

  const auto subset = ToCompatibleSubsetOptions(defaults);
  const CompatibleSubsetOptions subset_default;
  EXPECT_EQ(subset.cycle.test, subset_default.cycle.test);
  EXPECT_EQ(subset.cycle.chi_square_bound,
            subset_default.cycle.chi_square_bound);
  EXPECT_EQ(subset.cycle.translation_bound,
            subset_default.cycle.translation_bound);
  EXPECT_EQ(subset.cycle.rotation_bound, subset_default.cycle.rotation_bound);
  EXPECT_EQ(subset.revisit_distance, subset_default.revisit_distance);
  EXPECT_EQ(subset.informative_sigma, subset_default.informative_sigma);
  EXPECT_EQ(subset.min_revisits, subset_default.min_revisits);
  EXPECT_EQ(subset.tolerance, subset_default.tolerance);
  EXPECT_EQ(subset.predicted_tolerance, subset_default.predicted_tolerance);
  EXPECT_EQ(subset.single_strong_enabled, subset_default.single_strong_enabled);
  EXPECT_EQ(subset.single_strong_score, subset_default.single_strong_score);
  EXPECT_EQ(subset.single_strong_loops, subset_default.single_strong_loops);
  EXPECT_EQ(subset.max_clusters, subset_default.max_clusters);
  EXPECT_EQ(ToInnovationOptions(defaults).chi_square_bound,
            InnovationOptions().chi_square_bound);
}

TEST(LoopOptionsTest, ChoicesArePassedOn) {
  proto::LoopClosureOptions options = Defaults();
  options.mutable_temporal_verification()->set_step(
      proto::LoopClosureOptions::TemporalVerification::SYMMETRIC);
  options.mutable_dynamic_threshold()->set_direction(
      proto::LoopClosureOptions::DynamicThreshold::AS_PRINTED);
  options.mutable_compatible_subset()->set_test(
      proto::LoopClosureOptions::CompatibleSubset::FIXED_BOUND);
  EXPECT_EQ(ToTemporalVerificationOptions(options).step,
            WarpingStep::kSymmetric);
  EXPECT_EQ(ToDynamicThresholdOptions(options).direction,
            ThresholdDirection::kAsPrinted);
  EXPECT_EQ(ToCompatibleSubsetOptions(options).cycle.test,
            uncertainty::CycleTest::kFixedBound);
}

TEST(LoopOptionsTest, WindowOfThePaperAndCovarianceOfALoop) {
  proto::LoopClosureOptions options = Defaults();
  options.mutable_temporal_verification()->set_window_base(4.);
  EXPECT_EQ(VariableWindow(ToVariableWindowOptions(options), 0.), 4);
  EXPECT_EQ(VariableWindow(ToVariableWindowOptions(options), 100.), 6);
  options.mutable_path_noise()->set_loop_translation(0.2);
  options.mutable_path_noise()->set_loop_rotation(0.1);
  const Eigen::Matrix3d covariance = LoopCovariance(options);
  EXPECT_NEAR(covariance(0, 0), 0.04, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 0.04, 1e-12);
  EXPECT_NEAR(covariance(2, 2), 0.01, 1e-12);
  EXPECT_EQ(covariance(0, 1), 0.);
}

TEST(LoopOptionsTest, DecisionsSurviveTheirEncoding) {
  proto::LoopDecision decision;
  decision.set_candidate(7);
  decision.set_verdict(proto::LoopDecision::REJECTED);
  decision.set_reason(proto::LoopDecision::LOW_TEMPORAL_SCORE);
  decision.mutable_temporal()->set_score(0.25);
  proto::LoopDecision decoded;
  ASSERT_TRUE(decoded.ParseFromString(decision.SerializeAsString()));
  EXPECT_EQ(decoded.candidate(), 7);
  EXPECT_EQ(decoded.reason(), proto::LoopDecision::LOW_TEMPORAL_SCORE);
  EXPECT_EQ(decoded.temporal().score(), 0.25);
  EXPECT_FALSE(decoded.has_fusion());
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
