// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/loop_information.h"

#include <limits>
#include <thread>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

LoopId Id(const int node) {
  LoopId id;
  id.submap_index = 3;
  id.node_index = node;
  return id;
}

TEST(LoopInformationTest, WeightsAreSquareRoots) {
  EXPECT_EQ(InformationOfWeights(2., 3.),
            Eigen::Matrix3d(Eigen::Vector3d(4., 4., 9.).asDiagonal()));
}

TEST(LoopInformationTest, GivesASquareRootOfWhatWasSet) {
  LoopInformation loops;
  Eigen::Matrix3d information;
  information << 5., 1., 0.5, 1., 4., -0.25, 0.5, -0.25, 3.;
  Eigen::Matrix3d sqrt;
  EXPECT_FALSE(loops.FindSqrt(Id(1), &sqrt));
  ASSERT_TRUE(loops.Set(Id(1), information));
  ASSERT_TRUE(loops.FindSqrt(Id(1), &sqrt));
  EXPECT_LT((sqrt.transpose() * sqrt - information).norm(), 1e-12);
  EXPECT_FALSE(loops.FindSqrt(Id(2), &sqrt));
  // The last one counts.
  ASSERT_TRUE(loops.Set(Id(1), Eigen::Matrix3d::Identity()));
  EXPECT_EQ(loops.size(), 1u);
  ASSERT_TRUE(loops.FindSqrt(Id(1), &sqrt));
  EXPECT_LT((sqrt.transpose() * sqrt - Eigen::Matrix3d::Identity()).norm(),
            1e-12);
}

TEST(LoopInformationTest, AnUnobservableDirectionIsAllowed) {
  LoopInformation loops;
  const Eigen::Vector3d observable(0.6, 0.8, 0.);
  ASSERT_TRUE(loops.Set(Id(0), 100. * observable * observable.transpose()));
  Eigen::Matrix3d sqrt;
  ASSERT_TRUE(loops.FindSqrt(Id(0), &sqrt));
  EXPECT_NEAR((sqrt * observable).norm(), 10., 1e-12);
  EXPECT_NEAR((sqrt * Eigen::Vector3d(0.8, -0.6, 0.)).norm(), 0., 1e-6);
}

TEST(LoopInformationTest, RefusesWhatIsNoInformation) {
  LoopInformation loops;
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(1, 1) = -1.;
  EXPECT_FALSE(loops.Set(Id(0), matrix));
  matrix = Eigen::Matrix3d::Identity();
  matrix(0, 1) = 0.5;
  EXPECT_FALSE(loops.Set(Id(0), matrix));
  matrix = Eigen::Matrix3d::Identity();
  matrix(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(loops.Set(Id(0), matrix));
  matrix(2, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(loops.Set(Id(0), matrix));
  EXPECT_EQ(loops.size(), 0u);
}

TEST(LoopInformationTest, DropsTheOldestBeyondItsCapacity) {
  LoopInformation loops;
  for (size_t i = 0; i <= LoopInformation::kCapacity; ++i) {
    ASSERT_TRUE(
        loops.Set(Id(static_cast<int>(i)), Eigen::Matrix3d::Identity()));
  }
  EXPECT_EQ(loops.size(), size_t{LoopInformation::kCapacity});
  Eigen::Matrix3d sqrt;
  EXPECT_FALSE(loops.FindSqrt(Id(0), &sqrt));
  EXPECT_TRUE(loops.FindSqrt(Id(1), &sqrt));
}

TEST(LoopInformationTest, MayBeUsedBySeveralThreads) {
  LoopInformation loops;
  std::vector<std::thread> threads;
  for (int t = 0; t != 4; ++t) {
    threads.emplace_back([t, &loops] {
      for (int i = 0; i != 500; ++i) {
        const LoopId id = Id(t * 1000 + i);
        Eigen::Matrix3d sqrt;
        EXPECT_FALSE(loops.FindSqrt(id, &sqrt));
        EXPECT_TRUE(loops.Set(id, Eigen::Matrix3d::Identity()));
        EXPECT_TRUE(loops.FindSqrt(id, &sqrt));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(loops.size(), 2000u);
}

TEST(ScopedSqrtInformationTest, HoldsForItsThreadAndWhileItLives) {
  const int pose = 0, other = 0;
  Eigen::Matrix3d sqrt;
  EXPECT_FALSE(ScopedSqrtInformation::Find(&pose, &sqrt));
  {
    const ScopedSqrtInformation scope(
        {{&pose, {{1., 2., 3., 4., 5., 6., 7., 8., 9.}}}});
    ASSERT_TRUE(ScopedSqrtInformation::Find(&pose, &sqrt));
    EXPECT_EQ(sqrt(2, 0), 3.);  // column-major
    EXPECT_FALSE(ScopedSqrtInformation::Find(&other, &sqrt));
    std::thread([&pose] {
      Eigen::Matrix3d found;
      EXPECT_FALSE(ScopedSqrtInformation::Find(&pose, &found));
    }).join();
    const ScopedSqrtInformation inner({});
    EXPECT_FALSE(ScopedSqrtInformation::Find(&pose, &sqrt));
  }
  EXPECT_FALSE(ScopedSqrtInformation::Find(&pose, &sqrt));
}

}  // namespace
}  // namespace cartographer_ext
