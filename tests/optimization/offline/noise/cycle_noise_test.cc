// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise/cycle_noise.h"

#include <cmath>

#include "cartographer_ext/optimization/offline/noise_scale.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "gtest/gtest.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Steps of the search are factors of the root of two.
constexpr double kStep = 1.5;
// A wrong group repeats one measurement, so that its loops seem to have no noise.
constexpr double kOfGroups = 2.1;

// As many wrong loops as right ones, with matrices that claim so many times the
// noise of odometry and of loops.
CycleNoise NoiseOfGraph(const OutlierType type, const double odometry,
                        const double loops) {
  PoseGraph graph =
      WithNoiseScale(test::MakeGridWorld(300, 8, 3).graph, odometry, loops);
  test::AddOutliers(test::Outliers(CountLoops(graph.edges), type), &graph);
  return FindCycleNoise(FindLoopCycles(graph, LoopSupportOptions()));
}

TEST(CycleNoiseTest, WrongLoopsDoNotHideTheNoise) {
  for (const OutlierType type :
       {OutlierType::kRandom, OutlierType::kLocal, OutlierType::kRandomGrouped,
        OutlierType::kLocalGrouped}) {
    const CycleNoise noise = NoiseOfGraph(type, 4., 8.);
    EXPECT_LT(std::abs(std::log(noise.odometry * 4.)), std::log(kStep));
    const bool random =
        type == OutlierType::kRandom || type == OutlierType::kLocal;
    EXPECT_LT(std::abs(std::log(noise.loops * 8.)),
              std::log(random ? kStep : kOfGroups));
    EXPECT_GT(noise.log_likelihood, noise.of_given + 100.);
  }
}

TEST(CycleNoiseTest, AnHonestNoiseIsFound) {
  for (const OutlierType type :
       {OutlierType::kRandom, OutlierType::kRandomGrouped}) {
    const CycleNoise noise = NoiseOfGraph(type, 1., 1.);
    EXPECT_LT(std::abs(std::log(noise.odometry)), std::log(kStep));
    EXPECT_LT(std::abs(std::log(noise.loops)), std::log(kStep));
  }
}

TEST(CycleNoiseTest, NothingIsSaidWithoutCycles) {
  const CycleNoise noise = FindCycleNoise({});
  EXPECT_EQ(noise.odometry, 1.);
  EXPECT_EQ(noise.loops, 1.);
  EXPECT_EQ(noise.log_likelihood, noise.of_given);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
