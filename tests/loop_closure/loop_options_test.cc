// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_options.h"

#include <map>
#include <string>

#include "cartographer_ext/loop_decision.pb.h"
#include "gtest/gtest.h"
#include "tests/options/every_key.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// What the keys set, in the order of the message.
std::map<std::string, double> Values(const LoopOptions& options) {
  return {
      {"search.enabled", static_cast<double>(options.search.enabled)},
      {"search.max_searches_per_node",
       static_cast<double>(options.search.max_searches_per_node)},
      {"search.global_search",
       static_cast<double>(options.search.global_search)},
      {"search.max_cache_mb", static_cast<double>(options.max_cache_bytes)},
      {"temporal_verification.enabled",
       static_cast<double>(options.temporal.enabled)},
      {"temporal_verification.window_base",
       static_cast<double>(options.temporal.window.base)},
      {"temporal_verification.window_gamma",
       static_cast<double>(options.temporal.window.gamma)},
      {"dynamic_threshold.enabled",
       static_cast<double>(options.threshold.enabled)},
      {"dynamic_threshold.low", static_cast<double>(options.threshold.low)},
      {"dynamic_threshold.span", static_cast<double>(options.threshold.span)},
      {"fusion.enabled", static_cast<double>(options.fusion.enabled)},
      {"fusion.min_final_score",
       static_cast<double>(options.fusion.min_final_score)},
      {"information.enabled", static_cast<double>(options.information.enabled)},
      {"information.alpha", static_cast<double>(options.information.alpha)},
      {"information.beta", static_cast<double>(options.information.beta)},
      {"information.reference_score",
       static_cast<double>(options.information.reference_score)},
      {"information.full_matrix",
       static_cast<double>(options.information.full_matrix)},
      {"compatible_subset.enabled",
       static_cast<double>(options.compatible_subset.enabled)},
      {"compatible_subset.min_revisits",
       static_cast<double>(options.compatible_subset.min_revisits)},
      {"compatible_subset.single_strong",
       static_cast<double>(options.compatible_subset.single_strong_enabled)},
      {"compatible_subset.weak_prior_sigma",
       static_cast<double>(options.compatible_subset.weak_prior_sigma)},
      {"compatible_subset.weak_prior_revisits",
       static_cast<double>(options.compatible_subset.weak_prior_revisits)},
      {"innovation_veto.enabled",
       static_cast<double>(options.innovation_veto.enabled)},
      {"localization.enabled",
       static_cast<double>(options.relocalization.enabled)},
      {"log.times", static_cast<double>(options.log_times)},
      {"log.directory", static_cast<double>(options.log_directory.size())},
      {"paper_mode.temporal_verification",
       static_cast<double>(options.temporal.comparison.comparison)},
      {"paper_mode.dynamic_threshold",
       static_cast<double>(options.threshold.direction)},
      {"paper_mode.fusion", static_cast<double>(options.fusion.mode)},
      {"paper_mode.compatible_subset",
       static_cast<double>(options.compatible_subset.cycle.test)},
  };
}

options::test::KeyValues ValuesOfMessage(
    const proto::LoopClosureOptions& message) {
  return Values(ToLoopOptions(message));
}

// The defaults that are written beside the keys are those of the stages.
TEST(LoopOptionsTest, DefaultsAreThoseOfTheStages) {
  options::test::ExpectSameDefaults<proto::LoopClosureOptions>(
      ValuesOfMessage, Values(LoopOptions()));
}

TEST(LoopOptionsTest, EveryKeyHasAnEffect) {
  options::test::ExpectEveryKeyHasAnEffect<proto::LoopClosureOptions>(
      ValuesOfMessage);
}

TEST(LoopOptionsTest, CovarianceOfALoop) {
  LoopOptions options;
  options.loop_translation = 0.2;
  options.loop_rotation = 0.1;
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
