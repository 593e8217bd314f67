// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/information/typical_step.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TEST(TypicalStepTest, DenseNodesChangeNothing) {
  TypicalStep step(0.25);
  EXPECT_EQ(step.WeightFactor(0), 1.);
  for (int i = 0; i <= 50; ++i) step.Add(0, i, Pose2(0.25 * i, 0., 0.));
  EXPECT_EQ(step.WeightFactor(0), 1.);
}

TEST(TypicalStepTest, SquareOfHowMuchFartherApartNodesAre) {
  TypicalStep step(0.25);
  // A metre and, one time in five, a turn on the spot.
  double y = 0.;
  for (int i = 0; i <= 9; ++i) {
    step.Add(3, i, Pose2(1., y += i % 5 == 0 ? 0. : 1., 0.1 * i));
  }
  // Nine steps are too few.
  EXPECT_EQ(step.WeightFactor(3), 1.);
  for (int i = 10; i <= 50; ++i) {
    step.Add(3, i, Pose2(1., y += i % 5 == 0 ? 0. : 1., 0.1 * i));
  }
  EXPECT_NEAR(step.WeightFactor(3), 16., 1e-9);
  EXPECT_EQ(step.WeightFactor(0), 1.);
  step.DeleteTrajectory(3);
  EXPECT_EQ(step.WeightFactor(3), 1.);
}

TEST(TypicalStepTest, NodesThatAreMissingAreNoLongSteps) {
  TypicalStep step(0.25);
  for (int i = 0; i <= 50; ++i) {
    step.Add(0, 5 * i, Pose2(1.25 * i, 0., 0.));
    step.Add(0, 5 * i - 1, Pose2(100., 0., 0.));  // older: ignored
  }
  EXPECT_NEAR(step.WeightFactor(0), 1., 1e-9);
}

TEST(TypicalStepTest, FollowsTheNewestSteps) {
  TypicalStep step(0.25);
  double x = 0.;
  for (int i = 0; i <= 2000; ++i) {
    step.Add(0, i, Pose2(x += i <= 1000 ? 0.2 : 0.5, 0., 0.));
  }
  EXPECT_NEAR(step.WeightFactor(0), 4., 1e-9);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
