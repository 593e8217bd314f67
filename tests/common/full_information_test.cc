// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/full_information.h"

#include <cmath>
#include <limits>
#include <set>
#include <thread>
#include <vector>

#include "Eigen/Geometry"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

// The members that BitsOf reads of Cartographer's constraint.
struct RelativePose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  const Eigen::Vector3d& translation() const { return position; }
  const Eigen::Quaterniond& rotation() const { return orientation; }
};
struct ConstraintPose {
  RelativePose zbar_ij;
  double translation_weight = 1.;
  double rotation_weight = 2.;
};

ConstraintBits BitsOfX(const double x) {
  ConstraintPose pose;
  pose.zbar_ij.position.x() = x;
  return BitsOf(pose);
}

class FullInformationTest : public testing::Test {
 protected:
  void SetUp() override { ForgetFullInformation(); }
  void TearDown() override { ForgetFullInformation(); }
};

TEST_F(FullInformationTest, EveryNumberIsPartOfTheKey) {
  const ConstraintPose pose;
  std::set<ConstraintBits> all{BitsOf(pose)};
  for (int i = 0; i != 3; ++i) {
    ConstraintPose changed = pose;
    changed.zbar_ij.position[i] = std::nextafter(0., 1.);
    all.insert(BitsOf(changed));
  }
  for (int i = 0; i != 4; ++i) {
    ConstraintPose changed = pose;
    changed.zbar_ij.orientation.coeffs()[i] += 1e-15;
    all.insert(BitsOf(changed));
  }
  ConstraintPose changed = pose;
  changed.translation_weight = std::nextafter(1., 2.);
  all.insert(BitsOf(changed));
  changed = pose;
  changed.rotation_weight = std::nextafter(2., 3.);
  all.insert(BitsOf(changed));
  EXPECT_EQ(all.size(), 10u);
}

TEST_F(FullInformationTest, GivesASquareRootOfWhatWasRemembered) {
  Eigen::Matrix3d information;
  information << 5., 1., 0.5, 1., 4., -0.25, 0.5, -0.25, 3.;
  Eigen::Matrix3d sqrt;
  EXPECT_FALSE(FindSqrtInformation(BitsOfX(1.), &sqrt));
  ASSERT_TRUE(RememberFullInformation(BitsOfX(1.), information));
  ASSERT_TRUE(FindSqrtInformation(BitsOfX(1.), &sqrt));
  EXPECT_LT((sqrt.transpose() * sqrt - information).norm(), 1e-12);
  EXPECT_FALSE(FindSqrtInformation(BitsOfX(std::nextafter(1., 2.)), &sqrt));
  // The last one counts.
  ASSERT_TRUE(
      RememberFullInformation(BitsOfX(1.), Eigen::Matrix3d::Identity()));
  EXPECT_EQ(CountFullInformation(), 1u);
  ASSERT_TRUE(FindSqrtInformation(BitsOfX(1.), &sqrt));
  EXPECT_LT((sqrt.transpose() * sqrt - Eigen::Matrix3d::Identity()).norm(),
            1e-12);
}

TEST_F(FullInformationTest, ARelativeOneScalesTheWeights) {
  ConstraintPose pose;
  pose.zbar_ij.position.x() = 1.;
  pose.translation_weight = 10.;
  pose.rotation_weight = 4.;
  Eigen::Matrix3d relative = Eigen::Matrix3d::Identity();
  relative(0, 0) = 0.25;
  relative(0, 2) = relative(2, 0) = 0.1;
  ASSERT_TRUE(RememberRelativeInformation(PoseBitsOf(pose.zbar_ij), relative));
  EXPECT_EQ(CountFullInformation(), 1u);
  Eigen::Matrix3d sqrt;
  ASSERT_TRUE(FindSqrtInformation(BitsOf(pose), &sqrt));
  Eigen::Matrix3d expected;
  expected << 25., 0., 4., 0., 100., 0., 4., 0., 16.;
  EXPECT_LT((sqrt.transpose() * sqrt - expected).norm(), 1e-12);
  EXPECT_FALSE(FindSqrtInformation(BitsOfX(2.), &sqrt));
  // A whole matrix comes first.
  ASSERT_TRUE(
      RememberFullInformation(BitsOf(pose), Eigen::Matrix3d::Identity()));
  ASSERT_TRUE(FindSqrtInformation(BitsOf(pose), &sqrt));
  EXPECT_LT((sqrt.transpose() * sqrt - Eigen::Matrix3d::Identity()).norm(),
            1e-12);
  EXPECT_FALSE(RememberRelativeInformation(PoseBitsOf(pose.zbar_ij),
                                           -Eigen::Matrix3d::Identity()));
}

TEST_F(FullInformationTest, AnUnknownDirectionIsAllowed) {
  const Eigen::Vector3d known(0.6, 0.8, 0.);
  const Eigen::Matrix3d information = 100. * known * known.transpose();
  ASSERT_TRUE(RememberFullInformation(BitsOfX(0.), information));
  Eigen::Matrix3d sqrt;
  ASSERT_TRUE(FindSqrtInformation(BitsOfX(0.), &sqrt));
  EXPECT_NEAR((sqrt * known).norm(), 10., 1e-12);
  EXPECT_NEAR((sqrt * Eigen::Vector3d(0.8, -0.6, 0.)).norm(), 0., 1e-6);
}

TEST_F(FullInformationTest, RefusesWhatIsNoInformation) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(1, 1) = -1.;
  EXPECT_FALSE(RememberFullInformation(BitsOfX(0.), matrix));
  matrix = Eigen::Matrix3d::Identity();
  matrix(0, 1) = 0.5;
  EXPECT_FALSE(RememberFullInformation(BitsOfX(0.), matrix));
  matrix = Eigen::Matrix3d::Identity();
  matrix(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(RememberFullInformation(BitsOfX(0.), matrix));
  matrix(2, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(RememberFullInformation(BitsOfX(0.), matrix));
  EXPECT_EQ(CountFullInformation(), 0u);
}

TEST_F(FullInformationTest, ForgetsTheOldest) {
  Eigen::Matrix3d sqrt;
  for (size_t i = 0; i <= kMaxFullInformation; ++i) {
    ASSERT_TRUE(RememberFullInformation(BitsOfX(static_cast<double>(i)),
                                        Eigen::Matrix3d::Identity()));
  }
  EXPECT_EQ(CountFullInformation(), kMaxFullInformation);
  EXPECT_FALSE(FindSqrtInformation(BitsOfX(0.), &sqrt));
  EXPECT_TRUE(FindSqrtInformation(BitsOfX(1.), &sqrt));
}

TEST_F(FullInformationTest, MayBeUsedBySeveralThreads) {
  std::vector<std::thread> threads;
  for (int t = 0; t != 4; ++t) {
    threads.emplace_back([t] {
      for (int i = 0; i != 500; ++i) {
        const ConstraintBits bits = BitsOfX(t * 1000 + i);
        Eigen::Matrix3d sqrt;
        EXPECT_FALSE(FindSqrtInformation(bits, &sqrt));
        EXPECT_TRUE(RememberFullInformation(bits, Eigen::Matrix3d::Identity()));
        EXPECT_TRUE(FindSqrtInformation(bits, &sqrt));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(CountFullInformation(), 2000u);
}

}  // namespace
}  // namespace cartographer_ext
