// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/graph/relaxation.h"

#include <thread>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr Relaxation kRelaxation = {4., 1e5, 2e5, 300.};

TEST(ScopedRelaxationTest, StepsHaveTheWeightsOfLocalSlam) {
  const double pose = 0.;
  const ScopedRelaxation scope(kRelaxation, nullptr, nullptr);
  EXPECT_EQ(scope.factor(), 0.25);
  EXPECT_EQ(scope.StepScale(&pose, 1e5, 2e5), 75.);
  EXPECT_EQ(scope.StepScale(&pose, 1e5, 1e5), 0.);
  EXPECT_EQ(scope.StepScale(&pose, 500., 2e5), 0.);
}

TEST(ScopedRelaxationTest, ConstraintsAreNoStepsWhateverTheirWeights) {
  const std::vector<double> constraints(3);
  const double* const begin = constraints.data();
  const double* const end = begin + constraints.size();
  const double elsewhere = 0.;
  const ScopedRelaxation scope(kRelaxation, begin, end);
  for (const double& constraint : constraints) {
    EXPECT_EQ(scope.StepScale(&constraint, 1e5, 2e5), 0.);
  }
  EXPECT_EQ(scope.StepScale(end, 1e5, 2e5), 75.);
  EXPECT_EQ(scope.StepScale(&elsewhere, 1e5, 2e5), 75.);
}

TEST(ScopedRelaxationTest, HoldsForItsThreadAndWhileItLives) {
  EXPECT_EQ(ScopedRelaxation::Current(), nullptr);
  {
    const ScopedRelaxation scope(kRelaxation, nullptr, nullptr);
    EXPECT_EQ(ScopedRelaxation::Current(), &scope);
    std::thread([] { EXPECT_EQ(ScopedRelaxation::Current(), nullptr); }).join();
    {
      const ScopedRelaxation inner({1., 1., 1., 1.}, nullptr, nullptr);
      EXPECT_EQ(ScopedRelaxation::Current(), &inner);
    }
    EXPECT_EQ(ScopedRelaxation::Current(), &scope);
  }
  EXPECT_EQ(ScopedRelaxation::Current(), nullptr);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
