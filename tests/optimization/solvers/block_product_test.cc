// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/block_product.h"

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

// Within the rounding of compilers that contract a product and a sum.
TEST(BlockProductTest, MultipliesLikeOneByOne) {
  Random random(1);
  for (int round = 0; round != 20; ++round) {
    const Eigen::Matrix3d a = RandomBlock(&random), b = RandomBlock(&random),
                          y = RandomBlock(&random);
    const RightFactor right(b);
    Eigen::Matrix3d less = y, more = y, less_result, more_result;
    for (int c = 0; c != 3; ++c) {
      for (int r = 0; r != 3; ++r) {
        const double product =
            a(r, 0) * b(0, c) + a(r, 1) * b(1, c) + a(r, 2) * b(2, c);
        less(r, c) -= product;
        more(r, c) += product;
      }
    }
    right.SubtractedFrom(PackedBlock(y), PackedBlock(a)).CopyTo(&less_result);
    right.AddedTo(PackedBlock(y), PackedBlock(a)).CopyTo(&more_result);
    EXPECT_LT((less - less_result).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((more - more_result).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(BlockProductTest, CopiesABlock) {
  Random random(2);
  const Eigen::Matrix3d block = RandomBlock(&random);
  Eigen::Matrix3d copy;
  PackedBlock(block).CopyTo(&copy);
  EXPECT_EQ(copy, block);
}

TEST(TransposedProductsTest, SumsLikeOneByOne) {
  Random random(3);
  TransposedProducts products;
  EXPECT_EQ(products.Sum(), Eigen::Vector3d(Eigen::Vector3d::Zero()));
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();
  for (int k = 0; k != 7; ++k) {
    const Eigen::Matrix3d a = RandomBlock(&random);
    const Eigen::Vector3d x(random.Normal(), random.Normal(), random.Normal());
    products.Add(a, x);
    expected += a.transpose() * x;
  }
  EXPECT_LT((products.Sum() - expected).cwiseAbs().maxCoeff(), 1e-13);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
