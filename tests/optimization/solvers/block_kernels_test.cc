// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/block_kernels.h"

#include <algorithm>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using Blocks = std::vector<Eigen::Matrix3d>;

Blocks RandomBlocks(const int count, Random* const random) {
  Blocks result(count);
  for (Eigen::Matrix3d& block : result) {
    for (int i = 0; i != 9; ++i) block(i) = random->Normal();
  }
  return result;
}

// Within the rounding of compilers that contract a product and a sum.
void ExpectEqual(const Blocks& a, const Blocks& b, const char* const name) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t k = 0; k != a.size(); ++k) {
    EXPECT_LT((a[k] - b[k]).cwiseAbs().maxCoeff(), 1e-13) << name << " " << k;
  }
}

const std::vector<int> kRows = {4, 0, 2, 7};
const std::vector<int> kPlaces = {3, -1, 6, -1, 0, -1, -1, 5};

TEST(BlockKernelsTest, SubtractProducts) {
  Random random(1);
  const Blocks factor = RandomBlocks(1, &random);
  const Blocks sources = RandomBlocks(kRows.size(), &random);
  const Blocks before = RandomBlocks(8, &random);
  for (const BlockKernels* const kernels : AllBlockKernels()) {
    for (const bool mapped : {false, true}) {
      for (size_t count = 0; count <= kRows.size(); ++count) {
        Blocks expected = before, targets = before;
        for (size_t k = 0; k != count; ++k) {
          expected[mapped ? kPlaces[kRows[k]] : kRows[k]] -=
              sources[k] * factor[0];
        }
        kernels->subtract_products(factor[0], sources.data(), kRows.data(),
                                   count, mapped ? kPlaces.data() : nullptr,
                                   targets.data());
        ExpectEqual(targets, expected, kernels->name);
      }
    }
  }
}

TEST(BlockKernelsTest, SubtractPanel) {
  constexpr int kBlocks = 11, kColumns = 4;
  Random random(4);
  Eigen::MatrixXd sources(3 * kBlocks, 3 * kColumns);
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> factor(3 * kColumns,
                                                                   3);
  for (int i = 0; i != sources.size(); ++i) sources(i) = random.Normal();
  for (int i = 0; i != factor.size(); ++i) factor(i) = random.Normal();
  std::vector<double> padded(sources.size() + kPanelPadding, 0.);
  std::copy_n(sources.data(), sources.size(), padded.data());
  const std::vector<int> places = {3, 0, 7, 12, 1, 2, 9, 8, 4, 11, 10};
  const Blocks before = RandomBlocks(13, &random);
  for (const BlockKernels* const kernels : AllBlockKernels()) {
    for (int first = 0; first != kBlocks; ++first) {
      for (int count = 0; first + count <= kBlocks; ++count) {
        Blocks expected = before, targets = before;
        for (int k = 0; k != count; ++k) {
          expected[places[k]] -=
              sources.middleRows(3 * (first + k), 3) * factor;
        }
        kernels->subtract_panel(padded.data() + 3 * first, 3 * kBlocks,
                                3 * kColumns, factor.data(), places.data(),
                                count, targets.data());
        ExpectEqual(targets, expected, kernels->name);
      }
    }
  }
}

TEST(BlockKernelsTest, SubtractFromPivotAndScale) {
  Random random(5);
  const Blocks blocks = RandomBlocks(5, &random);
  const Eigen::Matrix3d pivot = blocks[0] + blocks[0].transpose();
  for (const BlockKernels* const kernels : AllBlockKernels()) {
    Blocks factor(1), target = {blocks[2]};
    kernels->subtract_from_pivot(pivot, blocks[1], &factor[0], &target[0]);
    const Eigen::Matrix3d expected = pivot * blocks[1].transpose();
    ExpectEqual(factor, {expected}, kernels->name);
    ExpectEqual(target, {blocks[2] - blocks[1] * expected}, kernels->name);
    Blocks scaled = blocks;
    kernels->scale(blocks[4], 3, scaled.data());
    for (int k = 0; k != 3; ++k) {
      ExpectEqual({scaled[k]}, {blocks[k] * blocks[4]}, kernels->name);
    }
    EXPECT_EQ(scaled[3], blocks[3]) << kernels->name;
  }
}

TEST(BlockKernelsTest, Substitute) {
  Random random(6);
  const Blocks blocks = RandomBlocks(kRows.size(), &random);
  const Blocks values = RandomBlocks(9, &random);
  std::vector<Eigen::Vector3d> before;
  for (int k = 0; k != 8; ++k) before.push_back(values[k].col(0));
  const Eigen::Vector3d value = values[8].col(0);
  for (const BlockKernels* const kernels : AllBlockKernels()) {
    std::vector<Eigen::Vector3d> x = before;
    kernels->substitute(value, blocks.data(), kRows.data(), kRows.size(),
                        x.data());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (size_t k = 0; k != kRows.size(); ++k) {
      const Eigen::Vector3d expected = before[kRows[k]] - blocks[k] * value;
      EXPECT_LT((x[kRows[k]] - expected).norm(), 1e-13) << kernels->name;
      sum += blocks[k].transpose() * before[kRows[k]];
    }
    EXPECT_EQ(x[1], before[1]) << kernels->name;
    EXPECT_LT((kernels->substitute_back(blocks.data(), kRows.data(),
                                        kRows.size(), before.data()) -
               sum)
                  .norm(),
              1e-13)
        << kernels->name;
  }
}

TEST(BlockKernelsTest, PredictRows) {
  using Rows = Eigen::Matrix<double, 3, kPathWidth, Eigen::RowMajor>;
  Random random(7);
  const Blocks blocks = RandomBlocks(kRows.size(), &random);
  const auto random_rows = [&] {
    Rows rows;
    for (int i = 0; i != rows.size(); ++i) rows(i) = random.Normal();
    return rows;
  };
  const Rows head = random_rows();
  std::vector<Rows> before;
  for (int k = 0; k != 8; ++k) before.push_back(random_rows());
  for (const BlockKernels* const kernels : AllBlockKernels()) {
    std::vector<double> values;
    for (const Rows& rows : before) {
      values.insert(values.end(), rows.data(), rows.data() + rows.size());
    }
    kernels->predict_rows(head.data(), blocks.data(), kRows.data(),
                          kRows.size(), values.data());
    std::vector<Rows> expected = before;
    for (size_t k = 0; k != kRows.size(); ++k) {
      expected[kRows[k]] -= blocks[k] * head;
    }
    for (size_t k = 0; k != before.size(); ++k) {
      const Rows actual =
          Eigen::Map<const Rows>(values.data() + 3 * kPathWidth * k);
      EXPECT_LT((actual - expected[k]).norm(), 1e-13) << kernels->name;
    }
  }
}

TEST(BlockKernelsTest, UpdateColumn) {
  Random random(2);
  const Blocks factors = RandomBlocks(2, &random);
  const Blocks blocks_before = RandomBlocks(kRows.size(), &random);
  const Blocks work_before = RandomBlocks(8, &random);
  for (const BlockKernels* const kernels : AllBlockKernels()) {
    Blocks expected_blocks = blocks_before, expected_work = work_before;
    for (size_t k = 0; k != kRows.size(); ++k) {
      expected_work[kRows[k]] -= blocks_before[k] * factors[0];
      expected_blocks[k] += expected_work[kRows[k]] * factors[1];
    }
    Blocks blocks = blocks_before, work = work_before;
    kernels->update_column(factors[0], factors[1], kRows.data(), kRows.size(),
                           blocks.data(), work.data());
    ExpectEqual(blocks, expected_blocks, kernels->name);
    ExpectEqual(work, expected_work, kernels->name);
  }
}

TEST(BlockKernelsTest, PredictColumn) {
  Random random(3);
  const Blocks factors = RandomBlocks(3, &random);
  const Eigen::Matrix3d middle = factors[1] + factors[1].transpose();
  const Blocks blocks = RandomBlocks(kRows.size(), &random);
  const Blocks work_before = RandomBlocks(8, &random);
  for (const BlockKernels* const kernels : AllBlockKernels()) {
    for (size_t count = 0; count <= kRows.size(); ++count) {
      Blocks expected = work_before, work = work_before, sum = {factors[2]};
      for (size_t k = 0; k != count; ++k) {
        expected[kRows[k]] -= blocks[k] * factors[0];
      }
      kernels->predict_column(factors[0], middle, kRows.data(), count,
                              blocks.data(), &sum[0], work.data());
      ExpectEqual(work, expected, kernels->name);
      ExpectEqual(sum,
                  {factors[2] + factors[0].transpose() * middle * factors[0]},
                  kernels->name);
    }
  }
}

TEST(BlockKernelsTest, TheBestIsOneOfAll) {
  ASSERT_FALSE(AllBlockKernels().empty());
  EXPECT_EQ(&BestBlockKernels(), AllBlockKernels().back());
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
