// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/block_ldlt.h"

#include <algorithm>
#include <set>

#include "Eigen/Dense"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

Eigen::Matrix3d RandomBlock(Random* const random) {
  Eigen::Matrix3d block;
  for (int i = 0; i != 9; ++i) block(i) = random->Normal();
  return block;
}

TEST(BlockLdltTest, InvertsPositiveDefiniteBlocksOnly) {
  Random random(1);
  for (int i = 0; i != 50; ++i) {
    const Eigen::Matrix3d root = RandomBlock(&random);
    const Eigen::Matrix3d block =
        root * root.transpose() + 0.01 * Eigen::Matrix3d::Identity();
    Eigen::Matrix3d inverse;
    ASSERT_TRUE(InvertSpd(block, &inverse));
    EXPECT_LT((block * inverse - Eigen::Matrix3d::Identity()).norm(), 1e-7);
  }
  Eigen::Matrix3d unused;
  EXPECT_FALSE(InvertSpd(Eigen::Matrix3d::Zero(), &unused));
  EXPECT_FALSE(InvertSpd(-Eigen::Matrix3d::Identity(), &unused));
  Eigen::Matrix3d indefinite = Eigen::Matrix3d::Identity();
  indefinite(2, 2) = -1.;
  EXPECT_FALSE(InvertSpd(indefinite, &unused));
}

TEST(BlockLdltTest, SolvesLikeADenseFactorisation) {
  Random random(2);
  for (const int size : {1, 2, 7, 40}) {
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i + 1 < size; ++i) pairs.push_back({i, i + 1});
    for (int k = 0; k < size; ++k) {
      const int a = random.UniformInt(0, size - 1);
      const int b = random.UniformInt(0, size - 1);
      if (a != b) pairs.push_back({a, b});  // either order, may repeat
    }
    BlockLdlt factor;
    factor.Analyze(size, pairs, {});
    for (int round = 0; round != 3; ++round) {
      if (round == 2 && size > 2) {
        // One pair less and one more, in the same order.
        pairs.front() = {size - 1, 0};
        const std::vector<int> order = factor.order();
        factor.AnalyzeInOrder(pairs);
        EXPECT_EQ(factor.order(), order);
      }
      factor.SetZero();
      Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * size, 3 * size);
      for (size_t p = 0; p != pairs.size(); ++p) {
        const Eigen::Matrix3d a = RandomBlock(&random);
        const Eigen::Matrix3d b = RandomBlock(&random);
        const int i = pairs[p].first, j = pairs[p].second;
        dense.block<3, 3>(3 * i, 3 * i) += a * a.transpose();
        dense.block<3, 3>(3 * j, 3 * j) += b * b.transpose();
        dense.block<3, 3>(3 * i, 3 * j) += a * b.transpose();
        dense.block<3, 3>(3 * j, 3 * i) += b * a.transpose();
        factor.AddDiagonal(i, a * a.transpose());
        factor.AddDiagonal(j, b * b.transpose());
        factor.AddOffDiagonal(p, a * b.transpose());
      }
      for (int i = 0; i != size; ++i) {
        factor.AddDiagonal(i, Eigen::Matrix3d::Identity());
        dense.block<3, 3>(3 * i, 3 * i) += Eigen::Matrix3d::Identity();
      }
      const double lambda = round == 0 ? 0. : 0.3;
      Eigen::MatrixXd damped = dense;
      damped.diagonal() *= 1. + lambda;
      ASSERT_TRUE(factor.Factorize(lambda));
      Eigen::VectorXd rhs(3 * size);
      for (int i = 0; i != rhs.size(); ++i) rhs[i] = random.Normal();
      const Eigen::VectorXd expected = damped.ldlt().solve(rhs);
      Eigen::VectorXd actual = rhs;
      factor.Solve(&actual);
      EXPECT_LT((actual - expected).norm(), 1e-9 * (1. + expected.norm()));
      BlockLdlt::Columns columns(3 * size, 3);
      columns << rhs, -rhs, 2. * rhs;
      factor.Solve(&columns);
      EXPECT_LT((columns.col(0) - actual).norm(), 1e-12 * actual.norm());
      EXPECT_LT((columns.col(1) + actual).norm(), 1e-12 * actual.norm());
      EXPECT_LT((columns.col(2) - 2. * actual).norm(), 1e-12 * actual.norm());
    }
  }
}

// Two grids that a separator joins: its columns have the same rows and are many
// panels.
TEST(BlockLdltTest, FactorisesWideSeparators) {
  constexpr int kWidth = 12, kSize = kWidth * kWidth;
  Random random(4);
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i != kSize; ++i) {
    if ((i + 1) % kWidth != 0) pairs.push_back({i, i + 1});
    if (i + kWidth < kSize) pairs.push_back({i, i + kWidth});
    if (i % 3 == 0) pairs.push_back({(7 * i + 40) % kSize, i});
  }
  BlockLdlt factor;
  factor.Analyze(kSize, pairs, {});
  EXPECT_GT(factor.num_blocks(), 8u * pairs.size() / 2);
  factor.SetZero();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * kSize, 3 * kSize);
  for (size_t p = 0; p != pairs.size(); ++p) {
    const Eigen::Matrix3d block = RandomBlock(&random);
    const int i = pairs[p].first, j = pairs[p].second;
    dense.block<3, 3>(3 * i, 3 * j) += block;
    dense.block<3, 3>(3 * j, 3 * i) += block.transpose();
    factor.AddOffDiagonal(p, block);
  }
  for (int i = 0; i != kSize; ++i) {
    factor.AddDiagonal(i, 30. * Eigen::Matrix3d::Identity());
  }
  dense += 30. * Eigen::MatrixXd::Identity(3 * kSize, 3 * kSize);
  // Again: what a factorisation leaves behind does not matter.
  for (int round = 0; round != 2; ++round) {
    ASSERT_TRUE(factor.Factorize(0.));
    Eigen::VectorXd solution = Eigen::VectorXd::LinSpaced(3 * kSize, -1., 1.);
    const Eigen::VectorXd expected = dense.ldlt().solve(solution);
    factor.Solve(&solution);
    EXPECT_LT((solution - expected).norm(), 1e-12 * expected.norm());
  }
  // L D L' is the matrix.
  Eigen::MatrixXd l = Eigen::MatrixXd::Identity(3 * kSize, 3 * kSize);
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(3 * kSize, 3 * kSize);
  Eigen::MatrixXd permuted = d;
  for (int j = 0; j != kSize; ++j) {
    d.block<3, 3>(3 * j, 3 * j) = factor.pivot(j);
    for (int p = factor.start(j); p != factor.start(j + 1); ++p) {
      l.block<3, 3>(3 * factor.row(p), 3 * j) = factor.block(p);
    }
    for (int i = 0; i != kSize; ++i) {
      permuted.block<3, 3>(3 * i, 3 * j) =
          dense.block<3, 3>(3 * factor.order()[i], 3 * factor.order()[j]);
    }
  }
  EXPECT_LT((l * d * l.transpose() - permuted).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(BlockLdltTest, RefusesAnIndefiniteMatrix) {
  BlockLdlt factor;
  factor.Analyze(2, {{0, 1}}, {});
  factor.SetZero();
  factor.AddDiagonal(0, Eigen::Matrix3d::Identity());
  factor.AddDiagonal(1, Eigen::Matrix3d::Identity());
  factor.AddOffDiagonal(0, 2. * Eigen::Matrix3d::Identity());
  EXPECT_FALSE(factor.Factorize(0.));
}

TEST(BlockLdltTest, ExtendsWhereTheFillHasRoom) {
  // Eliminating the middle of a star joins all its ends.
  BlockLdlt factor;
  factor.Analyze(4, {{0, 3}, {1, 3}, {2, 3}}, {1, 1, 1, 0});
  const size_t fill = factor.num_blocks();
  EXPECT_EQ(fill, 6u);
  ASSERT_TRUE(factor.Extend({{0, 1}, {2, 1}, {0, 1}}));
  EXPECT_EQ(factor.num_blocks(), fill);
  Random random(3);
  const std::vector<std::pair<int, int>> pairs = {{0, 3}, {1, 3}, {2, 3},
                                                  {0, 1}, {2, 1}, {0, 1}};
  factor.SetZero();
  Eigen::MatrixXd dense = 50. * Eigen::MatrixXd::Identity(12, 12);
  for (int i = 0; i != 4; ++i) {
    factor.AddDiagonal(i, 50. * Eigen::Matrix3d::Identity());
  }
  for (size_t p = 0; p != pairs.size(); ++p) {
    const Eigen::Matrix3d block = RandomBlock(&random);
    const int i = pairs[p].first, j = pairs[p].second;
    dense.block<3, 3>(3 * i, 3 * j) += block;
    dense.block<3, 3>(3 * j, 3 * i) += block.transpose();
    factor.AddOffDiagonal(p, block);
  }
  ASSERT_TRUE(factor.Factorize(0.));
  Eigen::VectorXd solution = Eigen::VectorXd::LinSpaced(12, -1., 1.);
  const Eigen::VectorXd expected = dense.ldlt().solve(solution);
  factor.Solve(&solution);
  EXPECT_LT((solution - expected).norm(), 1e-12);

  BlockLdlt chain;
  chain.Analyze(3, {{0, 1}, {1, 2}}, {0, 1, 2});
  EXPECT_FALSE(chain.Extend({{0, 1}, {0, 2}}));
  EXPECT_EQ(chain.num_blocks(), 2u);
}

TEST(BlockLdltTest, OrderIsAPermutationAndKeepsGroups) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i + 1 < 30; ++i) pairs.push_back({i, i + 1});
  pairs.push_back({0, 29});
  std::vector<int> groups(30, 0);
  groups[5] = 1;
  groups[17] = 1;
  const std::vector<int> order = FillReducingOrder(30, pairs, groups);
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), 30u);
  const std::set<int> last = {order[28], order[29]};
  EXPECT_EQ(last, (std::set<int>{5, 17}));
}

TEST(BlockLdltTest, AChainHasNoFill) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i + 1 < 100; ++i) pairs.push_back({i, i + 1});
  BlockLdlt factor;
  factor.Analyze(100, pairs, {});
  EXPECT_EQ(factor.num_blocks(), 99u);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
