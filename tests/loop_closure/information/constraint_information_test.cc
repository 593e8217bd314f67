// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/information/constraint_information.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TEST(ConstraintInformationTest, EquationElevenDoesNotDependOnU) {
  const Eigen::Matrix3d a = PaperInformation(0.7, 1.2, 1.5, 0.);
  const Eigen::Matrix3d b = PaperInformation(0.7, 1.2, 1.5, 1.1);
  EXPECT_TRUE(a.isApprox(b, 1e-12));
  EXPECT_NEAR(a(0, 0), std::pow(0.7, 1.2), 1e-12);
  EXPECT_NEAR(a(2, 2), std::pow(0.7, 1.5), 1e-12);
}

TEST(ConstraintInformationTest, WeightsAreSquareRootsOfInformation) {
  ConfidenceWeightOptions options;
  options.reference_score = 1.;
  const ConstraintWeights stock{1.1e4, 1e5};
  const ConstraintWeights at_reference = ConfidenceWeights(options, stock, 1.);
  EXPECT_DOUBLE_EQ(at_reference.translation, 1.1e4);
  EXPECT_DOUBLE_EQ(at_reference.rotation, 1e5);
  const ConstraintWeights weights = ConfidenceWeights(options, stock, 0.5);
  // Information scales with S^1.2 and S^1.5.
  EXPECT_NEAR(std::pow(weights.translation / 1.1e4, 2.), std::pow(0.5, 1.2),
              1e-12);
  EXPECT_NEAR(std::pow(weights.rotation / 1e5, 2.), std::pow(0.5, 1.5), 1e-12);
  // A reference score of 0.5 makes that the stock weight.
  options.reference_score = 0.5;
  EXPECT_DOUBLE_EQ(ConfidenceWeights(options, stock, 0.5).translation, 1.1e4);
  EXPECT_GT(ConfidenceWeights(options, stock, -1.).translation, 0.);
}

TEST(ConstraintInformationTest, ScalarPairOfAFullMatrix) {
  const Eigen::Vector3d diagonal(4., 9., 16.);
  const ConstraintWeights plain = ScalarWeights(diagonal.asDiagonal());
  EXPECT_DOUBLE_EQ(plain.translation, 2.);
  EXPECT_DOUBLE_EQ(plain.rotation, 4.);

  Eigen::Matrix3d coupled = Eigen::Matrix3d::Identity();
  coupled(0, 2) = coupled(2, 0) = 0.5;
  // Schur complements: 1 - 0.25 in x and in theta.
  const ConstraintWeights schur = ScalarWeights(coupled);
  EXPECT_NEAR(schur.translation, std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(schur.rotation, std::sqrt(0.75), 1e-12);
}

TEST(ConstraintInformationTest, DegenerateAndInvalidMatrices) {
  const Eigen::Vector3d corridor(0., 100., 25.);
  const ConstraintWeights weak = ScalarWeights(corridor.asDiagonal());
  EXPECT_EQ(weak.translation, 0.);
  EXPECT_DOUBLE_EQ(weak.rotation, 5.);
  const Eigen::Vector3d indefinite(-1., 1., 1.);
  EXPECT_EQ(ScalarWeights(indefinite.asDiagonal()).rotation, 0.);
  EXPECT_EQ(ScalarWeights(Eigen::Matrix3d::Zero()).translation, 0.);
  Eigen::Matrix3d nan = Eigen::Matrix3d::Identity();
  nan(1, 1) = std::nan("");
  EXPECT_EQ(ScalarWeights(nan).translation, 0.);
}

TEST(ConstraintInformationTest, FullInformationPullsLessAlongWhatIsOpen) {
  const ConstraintWeights weights{100., 200.};
  const Eigen::Matrix3d certain =
      Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal();
  // As certain as the weights claim.
  EXPECT_TRUE(FullInformation(weights, certain, certain)
                  .isApprox(Eigen::Matrix3d(
                      Eigen::Vector3d(1e4, 1e4, 4e4).asDiagonal())));
  // Open along the diagonal of the plane: variance 0.04 + 0.36 there.
  Eigen::Matrix3d open = certain;
  open.topLeftCorner<2, 2>() += Eigen::Matrix2d::Constant(0.18);
  const Eigen::Matrix3d information = FullInformation(weights, certain, open);
  const Eigen::Vector3d along = Eigen::Vector3d(1., 1., 0.) / std::sqrt(2.);
  const Eigen::Vector3d across = Eigen::Vector3d(1., -1., 0.) / std::sqrt(2.);
  EXPECT_NEAR(along.dot(information * along), 1e4 * 0.04 / 0.40, 1e-6);
  EXPECT_NEAR(across.dot(information * across), 1e4, 1e-6);
  EXPECT_NEAR(information(2, 2), 4e4, 1e-6);
  // Without inverse.
  EXPECT_TRUE(
      FullInformation(weights, certain, Eigen::Matrix3d::Zero()).isZero(0.));
  EXPECT_TRUE(FullInformation(weights, certain,
                              Eigen::Matrix3d::Constant(
                                  std::numeric_limits<double>::quiet_NaN()))
                  .isZero(0.));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
