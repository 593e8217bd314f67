// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/information/loop_information.h"

#include "cartographer_ext/loop_closure/loop_options.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// A match in a corridor along the x axis of the submap.
LoopCandidate InCorridor(const double heading) {
  LoopCandidate candidate;
  candidate.match.score = 0.9;
  candidate.match.refined = Pose2(1., 2., heading);
  candidate.match.information = Eigen::Vector3d(0., 1e8, 1e8).asDiagonal();
  return candidate;
}

TEST(LoopInformationTest, TheCorridorIsUncertainAlongItInTheFrameOfTheNode) {
  const LoopOptions options = LoopOptions();
  const Eigen::Matrix3d constant = LoopCovariance(options);
  const Eigen::Matrix3d along = MatchCovariance(options, InCorridor(0.));
  EXPECT_NEAR(along(0, 0), constant(0, 0) + 0.09, 1e-6);
  EXPECT_NEAR(along(1, 1), constant(1, 1), 1e-6);
  const Eigen::Matrix3d across =
      MatchCovariance(options, InCorridor(0.5 * kPi));
  EXPECT_NEAR(across(0, 0), constant(0, 0), 1e-6);
  EXPECT_NEAR(across(1, 1), constant(1, 1) + 0.09, 1e-6);
}

TEST(LoopInformationTest, WithoutInformationTheConstantPartIsLeft) {
  const LoopOptions options = LoopOptions();
  EXPECT_EQ(MatchCovariance(options, LoopCandidate()), LoopCovariance(options));
}

TEST(LoopInformationTest, WeightsFollowTheFinalScore) {
  LoopOptions options;
  options.information.full_matrix = true;
  const ConstraintWeights stock{100., 200.};
  LoopCandidate candidate = InCorridor(0.);
  WeighConstraint(options, stock, &candidate);
  EXPECT_GT(candidate.weights->translation, 100.);
  EXPECT_GT(candidate.weights->rotation, 200.);
  EXPECT_LT(candidate.full_information(0, 0),
            0.1 * candidate.full_information(1, 1));
  options.information.enabled = false;
  options.information.full_matrix = false;
  candidate = InCorridor(0.);
  WeighConstraint(options, stock, &candidate);
  EXPECT_EQ(candidate.weights->translation, 100.);
  EXPECT_TRUE(candidate.full_information.isZero(0.));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
