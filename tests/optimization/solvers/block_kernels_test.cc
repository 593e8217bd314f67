// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/block_kernels.h"

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
