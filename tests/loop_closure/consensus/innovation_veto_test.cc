// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr double kBound = 21.108;  // chi^2, 3 degrees of freedom, 0.9999

uncertainty::UncertainPose Make(const Pose2& pose, double sigma_xy,
                                double sigma_theta) {
  uncertainty::UncertainPose result;
  result.pose = pose;
  result.covariance = Eigen::Vector3d(sigma_xy * sigma_xy, sigma_xy * sigma_xy,
                                      sigma_theta * sigma_theta)
                          .asDiagonal();
  return result;
}

TEST(InnovationVetoTest, AgreementIsNeverVetoed) {
  const uncertainty::UncertainPose prior = Make(Pose2(3., 2., 0.4), 0.5, 0.1);
  const uncertainty::UncertainPose loop = Make(Pose2(3., 2., 0.4), 0.03, 0.01);
  const InnovationResult result = TestInnovation(kBound, prior, loop);
  EXPECT_NEAR(result.chi_square, 0., 1e-12);
  EXPECT_FALSE(result.vetoed);
}

TEST(InnovationVetoTest, ChiSquareByHand) {
  // Variances 0.09 + 0.16 = 0.25 along x, where the loop differs by 2 m.
  const uncertainty::UncertainPose prior = Make(Pose2(0., 0., 0.), 0.3, 0.1);
  const uncertainty::UncertainPose loop = Make(Pose2(2., 0., 0.), 0.4, 0.1);
  const InnovationResult result = TestInnovation(kBound, prior, loop);
  EXPECT_NEAR(result.innovation.x, 2., 1e-12);
  EXPECT_NEAR(result.chi_square, 16., 1e-9);
  // Across, the heading of the prior adds 0.1 rad over the 2 m.
  EXPECT_NEAR(result.translation_sigma, std::sqrt(0.25 + 0.04), 1e-12);
  EXPECT_NEAR(result.rotation_sigma, std::sqrt(0.02), 1e-12);
  EXPECT_FALSE(result.vetoed);
  EXPECT_TRUE(TestInnovation(15., prior, loop).vetoed);
}

TEST(InnovationVetoTest, HeadingAloneCanVeto) {
  const uncertainty::UncertainPose prior = Make(Pose2(1., 0., 3.), 1., 0.1);
  EXPECT_FALSE(
      TestInnovation(kBound, prior, Make(Pose2(1., 0., -3.), 0.1, 0.01))
          .vetoed);
  const InnovationResult turned =
      TestInnovation(kBound, prior, Make(Pose2(1., 0., 0.), 0.1, 0.01));
  EXPECT_TRUE(turned.vetoed);
  EXPECT_NEAR(std::abs(turned.innovation.theta), 3., 1e-12);
}

TEST(InnovationVetoTest, CertainPosesAllowNothing) {
  const uncertainty::UncertainPose prior = Make(Pose2(), 0., 0.);
  const InnovationResult result =
      TestInnovation(kBound, prior, Make(Pose2(0.1, 0., 0.), 0., 0.));
  EXPECT_TRUE(std::isinf(result.chi_square));
  EXPECT_TRUE(result.vetoed);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
