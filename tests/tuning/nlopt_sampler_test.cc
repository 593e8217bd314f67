// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/nlopt_sampler.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace tuning {
namespace {

std::vector<Parameter> Square() {
  Parameter a, b;
  a.key = "a";
  b.key = "b";
  b.low = 1.;
  b.high = 100.;
  b.log_scale = true;
  return {a, b};
}

// Smallest at a = 0.3, b = 10, that is in the middle of its scale.
double Bowl(const Point& point) {
  const double a = point[0].get<double>() - 0.3;
  const double b = std::log10(point[1].get<double>()) - 1.;
  return a * a + b * b;
}

double BestOf(NloptSampler* const sampler, const int max_trials) {
  double best = 1e9;
  for (size_t i = 0; i < static_cast<size_t>(max_trials); ++i) {
    const auto request = sampler->Ask();
    if (!request.has_value()) break;
    EXPECT_FALSE(sampler->Ask().has_value());  // one at a time
    const double objective = Bowl(request->point);
    best = std::min(best, objective);
    sampler->Tell(i, objective);
  }
  return best;
}

TEST(NloptSamplerTest, EveryAlgorithmComesNearTheMinimum) {
  for (const std::string& method : NloptMethodNames()) {
    NloptSampler sampler(Square(), method, 1, {0.8, 2.});
    const bool evolves = method == "nlopt_isres" || method == "nlopt_esch";
    EXPECT_LT(BestOf(&sampler, evolves ? 200 : 60), evolves ? 0.05 : 0.01)
        << method;
  }
}

TEST(NloptSamplerTest, LocalMethodsStartAtTheConfigurationAndEnd) {
  NloptSampler sampler(Square(), "nlopt_local", 1, {0.8, 2.});
  const auto first = sampler.Ask();
  ASSERT_TRUE(first.has_value());
  EXPECT_NEAR(first->point[0].get<double>(), 0.8, 1e-9);
  EXPECT_NEAR(first->point[1].get<double>(), 2., 1e-9);
  sampler.Tell(0, Bowl(first->point));
  size_t trials = 1;
  while (const auto request = sampler.Ask()) {
    sampler.Tell(trials++, Bowl(request->point));
    ASSERT_LT(trials, 500u);
  }
  EXPECT_TRUE(sampler.Done());
  EXPECT_GT(trials, 10u);
}

TEST(NloptSamplerTest, AFailedTrialIsAvoidedNotFatal) {
  NloptSampler sampler(Square(), "nlopt_global", 1, {});
  double best = 1e9;
  for (size_t i = 0; i < 60; ++i) {
    const auto request = sampler.Ask();
    ASSERT_TRUE(request.has_value());
    // The half with large a fails, the very first trial, too.
    const bool fails = i == 0 || request->point[0].get<double>() > 0.6;
    if (!fails) best = std::min(best, Bowl(request->point));
    sampler.Tell(
        i, fails ? absl::nullopt : absl::make_optional(Bowl(request->point)));
  }
  EXPECT_LT(best, 0.02);
}

TEST(NloptSamplerTest, UnknownMethodsAreDone) {
  EXPECT_TRUE(NloptSampler(Square(), "nlopt_nothing", 1, {}).Done());
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
