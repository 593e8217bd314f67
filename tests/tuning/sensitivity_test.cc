// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/sensitivity.h"

#include "cartographer_ext/common/random.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::ElementsAre;

std::vector<Parameter> Parameters() {
  Parameter matters, not_at_all, choice;
  matters.key = "matters";
  not_at_all.key = "not_at_all";
  choice.key = "choice";
  choice.kind = Parameter::Kind::kChoice;
  choice.choices = {"good", "bad"};
  return {matters, not_at_all, choice};
}

TEST(SensitivityTest, RanksShareTies) {
  EXPECT_THAT(Ranks({3., 1., 2.}), ElementsAre(3., 1., 2.));
  EXPECT_THAT(Ranks({5., 1., 5., 5.}), ElementsAre(3., 1., 3., 3.));
  EXPECT_TRUE(Ranks({}).empty());
}

TEST(SensitivityTest, TellsKeysThatMatter) {
  Random random(3);
  std::vector<Point> points;
  std::vector<double> objectives;
  for (int i = 0; i < 200; ++i) {
    const double a = random.Uniform(), b = random.Uniform();
    const bool bad = random.Uniform() < 0.5;
    points.push_back({a, b, bad ? "bad" : "good"});
    // Folds now and then, which ranks make harmless.
    objectives.push_back(2. * a + (bad ? 0.5 : 0.) + 0.1 * random.Uniform() +
                         (i % 50 == 0 ? 1000. : 0.));
  }
  const auto result = ComputeSensitivity(Parameters(), points, objectives);
  ASSERT_EQ(result.size(), 3u);
  EXPECT_EQ(result[0].key, "matters");
  EXPECT_EQ(result[0].trials, 200);
  EXPECT_GT(result[0].effect, 0.6);
  EXPECT_GT(result[0].trend, 0.7);
  EXPECT_LT(result[1].effect, 0.05);
  EXPECT_NEAR(result[1].trend, 0., 0.2);
  EXPECT_GT(result[2].effect, 0.05);
  EXPECT_LT(result[2].effect, result[0].effect);
  EXPECT_EQ(result[2].trend, 0.);
}

TEST(SensitivityTest, SmallerIsBetterGivesANegativeTrend) {
  std::vector<Point> points;
  std::vector<double> objectives;
  for (int i = 0; i < 20; ++i) {
    points.push_back({0.05 * i, 0.5, "good"});
    objectives.push_back(-i);
  }
  const auto result = ComputeSensitivity(Parameters(), points, objectives);
  EXPECT_NEAR(result[0].trend, -1., 1e-12);
  EXPECT_GT(result[0].effect, 0.8);
  EXPECT_EQ(result[1].effect, 0.);  // never varied
}

TEST(SensitivityTest, FewTrialsTellNothing) {
  const auto result =
      ComputeSensitivity(Parameters(), {{0.1, 0.2, "bad"}}, {1.});
  EXPECT_EQ(result[0].effect, 0.);
  EXPECT_EQ(ComputeSensitivity(Parameters(), {}, {}).size(), 3u);
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
