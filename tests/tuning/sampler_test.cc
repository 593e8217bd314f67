// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/sampler.h"

#include <set>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::ElementsAre;

std::vector<Parameter> TwoParameters() {
  Parameter a, b;
  a.key = "a";
  a.steps = 3;
  b.key = "b";
  b.kind = Parameter::Kind::kChoice;
  b.choices = {true, false};
  return {a, b};
}

TEST(GridSamplerTest, GivesAllCombinationsOnce) {
  GridSampler sampler(TwoParameters());
  EXPECT_EQ(sampler.size(), 6);
  std::vector<Point> points;
  while (const auto request = sampler.Ask()) {
    EXPECT_EQ(request->fidelity, 1.);
    points.push_back(request->point);
  }
  EXPECT_TRUE(sampler.Done());
  EXPECT_THAT(points, ElementsAre(Point({0., true}), Point({0., false}),
                                  Point({0.5, true}), Point({0.5, false}),
                                  Point({1., true}), Point({1., false})));
}

TEST(RandomSamplerTest, FollowsTheSeed) {
  RandomSampler one(TwoParameters(), 7), same(TwoParameters(), 7),
      other(TwoParameters(), 8);
  int different = 0;
  for (int i = 0; i < 20; ++i) {
    const Point point = one.Ask()->point;
    EXPECT_EQ(point, same.Ask()->point);
    different += point != other.Ask()->point;
  }
  EXPECT_GT(different, 15);
  EXPECT_FALSE(one.Done());
}

// Objective: the first parameter.
TEST(HalvingSamplerTest, PromotesTheBestThirdInOrder) {
  HalvingSampler sampler(TwoParameters(), 1, 0.3);
  std::vector<double> values;
  for (int i = 0; i < 9; ++i) {
    const auto request = sampler.Ask();
    ASSERT_TRUE(request.has_value());
    EXPECT_NEAR(request->fidelity, 1. / 3., 1e-12);
    values.push_back(request->point[0].get<double>());
  }
  EXPECT_FALSE(sampler.Ask().has_value());  // results are needed
  // Told in any order, one of them failed although its value is the best.
  const size_t failed = static_cast<size_t>(
      std::min_element(values.begin(), values.end()) - values.begin());
  for (size_t i = values.size(); i-- > 0;) {
    EXPECT_FALSE(sampler.Ask().has_value());
    sampler.Tell(i,
                 i == failed ? absl::nullopt : absl::make_optional(values[i]));
  }
  values.erase(values.begin() + static_cast<ptrdiff_t>(failed));
  std::sort(values.begin(), values.end());
  for (int i = 0; i < 3; ++i) {
    const auto request = sampler.Ask();
    ASSERT_TRUE(request.has_value());
    EXPECT_EQ(request->fidelity, 1.);
    EXPECT_EQ(request->point[0].get<double>(), values[static_cast<size_t>(i)]);
  }
  EXPECT_FALSE(sampler.Ask().has_value());
  for (size_t i = 9; i < 12; ++i) sampler.Tell(i, 0.);
  // The next bracket.
  EXPECT_NEAR(sampler.Ask()->fidelity, 1. / 3., 1e-12);
}

TEST(HalvingSamplerTest, StartsAnewWhenAllFail) {
  HalvingSampler sampler(TwoParameters(), 1, 0.3);
  std::set<std::string> points;
  for (size_t i = 0; i < 9; ++i) points.insert(sampler.Ask()->point[0].dump());
  for (size_t i = 0; i < 9; ++i) sampler.Tell(i, absl::nullopt);
  const auto request = sampler.Ask();
  ASSERT_TRUE(request.has_value());
  EXPECT_NEAR(request->fidelity, 1. / 3., 1e-12);
  EXPECT_EQ(points.count(request->point[0].dump()), 0u);
}

TEST(HalvingSamplerTest, RungsFollowTheSmallestPart) {
  HalvingSampler all(TwoParameters(), 1, 1.), three(TwoParameters(), 1, 0.1);
  EXPECT_EQ(all.Ask()->fidelity, 1.);
  EXPECT_NEAR(three.Ask()->fidelity, 1. / 9., 1e-12);
}

TEST(CreateSamplerTest, KnowsItsMethods) {
  for (const std::string& method : MethodNames()) {
    SamplerOptions options;
    options.method = method;
    const auto sampler = CreateSampler(TwoParameters(), options);
    ASSERT_TRUE(sampler.ok()) << method;
    const auto request = (*sampler)->Ask();
    ASSERT_TRUE(request.has_value()) << method;
    EXPECT_EQ(request->point.size(), 2u);
  }
  SamplerOptions options;
  options.method = "guess";
  const auto sampler = CreateSampler(TwoParameters(), options);
  EXPECT_THAT(std::string(sampler.status().message()),
              testing::HasSubstr("unknown method 'guess'"));
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
