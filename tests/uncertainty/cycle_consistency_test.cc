// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/cycle_consistency.h"

#include <cmath>
#include <limits>

#include "Eigen/Cholesky"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

UncertainPose Make(const Pose2& pose, const double sigma_xy,
                   const double sigma_theta) {
  UncertainPose result;
  result.pose = pose;
  result.covariance = Eigen::Vector3d(sigma_xy * sigma_xy, sigma_xy * sigma_xy,
                                      sigma_theta * sigma_theta)
                          .asDiagonal();
  return result;
}

// The propagated covariance is that of sampled errors.
TEST(CycleConsistencyTest, ChiSquareOfSampledCyclesAveragesThree) {
  Random random(5);
  const Pose2 anchor_v(3., 1., 0.4);   // (a_u <- a_v)
  const Pose2 node_u(0.5, 0.2, -0.3);  // (a_u <- b_u)
  const Pose2 node_v(4., 0.7, 0.9);    // (a_u <- b_v)
  CycleConsistencyOptions options;
  const auto noisy = [&random](const Pose2& truth, const double sigma_xy,
                               const double sigma_theta) {
    const Pose2 error(random.Normal(0., sigma_xy), random.Normal(0., sigma_xy),
                      random.Normal(0., sigma_theta));
    return Make(truth * error.Inverse(), sigma_xy, sigma_theta);
  };
  double sum = 0.;
  int outside = 0;
  const int trials = 4000;
  for (int i = 0; i < trials; ++i) {
    const CycleResult result =
        TestCycle(options, noisy(node_u, 0.02, 0.01),
                  noisy(Between(node_u, node_v), 0.05, 0.02),
                  noisy(Between(anchor_v, node_v), 0.02, 0.01),
                  noisy(anchor_v.Inverse(), 0.04, 0.02));
    sum += result.chi_square;
    outside += !result.compatible;
  }
  EXPECT_NEAR(sum / trials, 3., 0.15);
  EXPECT_NEAR(outside / static_cast<double>(trials), 0.01, 0.006);
}

TEST(CycleConsistencyTest, WrongLoopIsIncompatible) {
  CycleConsistencyOptions options;
  const UncertainPose loop_u = Make(Pose2(), 0.05, 0.01);
  const UncertainPose path = Make(Pose2(5., 0., 0.), 0.1, 0.02);
  const UncertainPose back = Make(Pose2(-5., 0., 0.), 0.1, 0.02);
  EXPECT_TRUE(TestCycle(options, loop_u, path, loop_u, back).compatible);
  const UncertainPose wrong = Make(Pose2(3., 0., 0.), 0.05, 0.01);
  const CycleResult result = TestCycle(options, loop_u, path, wrong, back);
  EXPECT_FALSE(result.compatible);
  EXPECT_NEAR(result.error.x, -3., 1e-12);
  // x variance: 0.05^2 + 0.1^2 + 0.05^2 + 0.1^2 = 0.025.
  EXPECT_NEAR(result.chi_square, 9. / 0.025, 1e-6);
}

TEST(CycleConsistencyTest, FixedBoundAsPrinted) {
  CycleConsistencyOptions options;
  options.test = CycleTest::kFixedBound;
  options.translation_bound = 0.5;
  options.rotation_bound = 0.1;
  const UncertainPose exact = Make(Pose2(), 0., 0.);
  EXPECT_TRUE(TestCycle(options, Make(Pose2(0.4, 0., 0.05), 0., 0.), exact,
                        exact, exact)
                  .compatible);
  EXPECT_FALSE(
      TestCycle(options, Make(Pose2(0.6, 0., 0.), 0., 0.), exact, exact, exact)
          .compatible);
  EXPECT_FALSE(
      TestCycle(options, Make(Pose2(0., 0., 0.2), 0., 0.), exact, exact, exact)
          .compatible);
}

TEST(CycleConsistencyTest, SingularCovariance) {
  CycleConsistencyOptions options;
  const UncertainPose exact = Make(Pose2(), 0., 0.);
  EXPECT_TRUE(TestCycle(options, exact, exact, exact, exact).compatible);
  const CycleResult off = TestCycle(options, Make(Pose2(1e-3, 0., 0.), 0., 0.),
                                    exact, exact, exact);
  EXPECT_FALSE(off.compatible);
  EXPECT_TRUE(std::isinf(off.chi_square));
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
