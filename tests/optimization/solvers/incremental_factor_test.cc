// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/incremental_factor.h"

#include "Eigen/Dense"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

LinearFactor RandomFactor(const int a, const int b, Random* const random) {
  LinearFactor factor;
  factor.a = a;
  factor.b = b;
  // Near -1 and 1, as those of a pose graph: products along a chain stay sane.
  for (int i = 0; i != 9; ++i) {
    factor.jacobian_a(i) = 0.2 * random->Normal() - (i % 4 == 0);
    factor.jacobian_b(i) = 0.2 * random->Normal() + (i % 4 == 0);
  }
  for (int i = 0; i != 3; ++i) factor.target(i) = random->Normal();
  return factor;
}

// The same system, dense.
class Dense {
 public:
  void Add(const LinearFactor& factor, const double weight) {
    const int needed = 3 * (std::max(factor.a, factor.b) + 1);
    if (needed > h_.rows()) {
      Eigen::MatrixXd h = Eigen::MatrixXd::Zero(needed, needed);
      h.topLeftCorner(h_.rows(), h_.cols()) = h_;
      h_ = h;
      Eigen::VectorXd b = Eigen::VectorXd::Zero(needed);
      b.head(b_.size()) = b_;
      b_ = b;
    }
    const Eigen::MatrixXd jacobian = Jacobian(factor);
    h_ += weight * jacobian.transpose() * jacobian;
    b_ += weight * jacobian.transpose() * factor.target;
  }
  Eigen::VectorXd Solve() const { return h_.ldlt().solve(b_); }
  Eigen::Matrix3d Predicted(const LinearFactor& factor) const {
    const Eigen::MatrixXd jacobian = Jacobian(factor);
    return jacobian * h_.ldlt().solve(jacobian.transpose());
  }

 private:
  Eigen::MatrixXd Jacobian(const LinearFactor& factor) const {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3, h_.cols());
    if (factor.a >= 0) result.middleCols<3>(3 * factor.a) = factor.jacobian_a;
    if (factor.b >= 0) result.middleCols<3>(3 * factor.b) = factor.jacobian_b;
    return result;
  }
  Eigen::MatrixXd h_;
  Eigen::VectorXd b_;
};

class IncrementalFactorTest : public ::testing::Test {
 protected:
  // A chain of `size` variables from the held one, then random loops.
  void Grow(const int size, const int loops) {
    for (int i = 0; i != size; ++i) {
      ASSERT_EQ(factor_.Append(), i);
      Add(RandomFactor(i - 1, i, &random_), 1.);
    }
    for (int i = 0; i != loops; ++i) {
      const int a = random_.UniformInt(-1, size - 1);
      const int b = random_.UniformInt(0, size - 1);
      if (a != b) Add(RandomFactor(a, b, &random_), 0.5);
    }
  }
  void Add(const LinearFactor& factor, const double weight) {
    ASSERT_TRUE(factor_.Update(factor, weight));
    dense_.Add(factor, weight);
  }
  void ExpectEqual(const double tolerance) {
    Eigen::VectorXd solution;
    factor_.Solve(&solution);
    const Eigen::VectorXd expected = dense_.Solve();
    EXPECT_LT((solution - expected).norm(), tolerance * (1. + expected.norm()));
    for (int i = 0; i != factor_.size(); ++i) {
      EXPECT_LT((factor_.SolveFor(i) - solution.segment<3>(3 * i)).norm(),
                1e-12 * (1. + solution.norm()));
    }
  }

  Random random_{7};
  IncrementalFactor factor_;
  Dense dense_;
};

TEST_F(IncrementalFactorTest, GrowsLikeTheDenseSystem) {
  Grow(25, 30);
  ExpectEqual(1e-8);
  EXPECT_TRUE(factor_.SolveFor(-1).isZero());
}

TEST_F(IncrementalFactorTest, PredictedCovariance) {
  Grow(20, 15);
  for (int i = 0; i != 10; ++i) {
    const LinearFactor probe = RandomFactor(
        random_.UniformInt(-1, 9), random_.UniformInt(10, 19), &random_);
    const Eigen::Matrix3d expected = dense_.Predicted(probe);
    EXPECT_LT((factor_.PredictedCovariance(probe) - expected).norm(),
              1e-8 * expected.norm());
    EXPECT_LE(factor_.last_prediction_blocks(), factor_.num_blocks() + 20);
  }
  // The last pose is the root.
  factor_.PredictedCovariance(RandomFactor(-1, 19, &random_));
  EXPECT_EQ(factor_.last_prediction_blocks(), 1);
  // The work space is clean again.
  ExpectEqual(1e-8);
}

TEST_F(IncrementalFactorTest, TheLastVariableHasItsCovariance) {
  Grow(30, 20);
  LinearFactor last;
  last.b = 29;
  last.jacobian_b.setIdentity();
  EXPECT_LT((factor_.LastCovariance() - dense_.Predicted(last)).norm(), 1e-9);
}

// What a new variable gets from the first measurement moves no other one.
TEST_F(IncrementalFactorTest, AttachingAVariableMovesNoOther) {
  Grow(30, 20);
  const Eigen::Vector3d before = factor_.SolveFor(3);
  LinearFactor factor = RandomFactor(12, 30, &random_);
  factor.target += factor.jacobian_a * factor_.SolveFor(12);
  factor_.Append();
  ASSERT_TRUE(factor_.Attach(factor));
  dense_.Add(factor, 1.);
  EXPECT_EQ(factor_.SolveFor(3), before);
  ExpectEqual(1e-8);
  // The jump of a later measurement is noticed.
  Add(RandomFactor(2, 30, &random_), 1.);
  EXPECT_NE(factor_.SolveFor(3), before);
  EXPECT_LT((factor_.SolveFor(30) - dense_.Solve().segment<3>(90)).norm(),
            1e-8);
}

TEST_F(IncrementalFactorTest, DowndateUndoesUpdate) {
  Grow(20, 20);
  Eigen::VectorXd before, after;
  factor_.Solve(&before);
  const LinearFactor extra = RandomFactor(2, 15, &random_);
  ASSERT_TRUE(factor_.Update(extra, 0.7));
  ASSERT_TRUE(factor_.Update(extra, -0.7));
  factor_.Solve(&after);
  EXPECT_LT((before - after).norm(), 1e-9 * (1. + before.norm()));
  ExpectEqual(1e-8);
}

TEST_F(IncrementalFactorTest, TakingAwayTooMuchIsRefused) {
  Grow(3, 0);
  EXPECT_FALSE(factor_.Update(RandomFactor(0, 2, &random_), -1e6));
}

TEST_F(IncrementalFactorTest, ContinuesABatchFactor) {
  std::vector<LinearFactor> factors;
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i != 15; ++i) {
    factors.push_back(RandomFactor(i - 1, i, &random_));
    if (i >= 8) factors.push_back(RandomFactor(i - 8, i, &random_));
  }
  for (const LinearFactor& factor : factors) {
    if (factor.a >= 0) pairs.push_back({factor.a, factor.b});
    dense_.Add(factor, 1.);
  }
  BlockLdlt batch;
  batch.Analyze(15, pairs, {});
  batch.SetZero();
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(45);
  int pair = 0;
  for (const LinearFactor& factor : factors) {
    const Eigen::Matrix3d& a = factor.jacobian_a;
    const Eigen::Matrix3d& b = factor.jacobian_b;
    batch.AddDiagonal(factor.b, b.transpose() * b);
    rhs.segment<3>(3 * factor.b) += b.transpose() * factor.target;
    if (factor.a < 0) continue;
    batch.AddDiagonal(factor.a, a.transpose() * a);
    rhs.segment<3>(3 * factor.a) += a.transpose() * factor.target;
    batch.AddOffDiagonal(pair++, a.transpose() * b);
  }
  ASSERT_TRUE(batch.Factorize(0.));
  factor_.Reset(batch, rhs);
  ExpectEqual(1e-8);
  // New variables attach to it.
  for (int i = 15; i != 20; ++i) {
    ASSERT_EQ(factor_.Append(), i);
    Add(RandomFactor(i - 1, i, &random_), 1.);
    Add(RandomFactor(i - 12, i, &random_), 0.2);
  }
  ExpectEqual(1e-8);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
