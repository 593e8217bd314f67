// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/loop_predictor.h"

#include <vector>

#include "cartographer_ext/optimization/solvers/incremental_factor.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gtest/gtest.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

class LoopPredictorTest : public ::testing::Test {
 protected:
  LoopPredictorTest()
      : world_(test::MakeGridWorld(250, 8, 5)),
        edges_(Whiten(world_.graph.edges)),
        solver_(edges_) {
    // To the fixed pose, too.
    WhitenedEdge edge = edges_.back();
    edge.is_loop = true;
    edge.from = 0;
    edge.to = 120;
    edges_.push_back(edge);
    for (size_t i = 0; i != edges_.size(); ++i) {
      weights_.push_back(!edges_[i].is_loop || i % 2 == 0);
      if (edges_[i].is_loop) loops_.push_back(i);
    }
    factor_ = solver_.Factor(poses(), weights_, &rhs_);
  }
  const std::vector<Pose2>& poses() const { return world_.graph.poses; }

  test::GridWorld world_;
  std::vector<WhitenedEdge> edges_;
  std::vector<double> weights_;
  std::vector<int> loops_;
  RobustSolver solver_;
  Eigen::VectorXd rhs_;
  const BlockLdlt* factor_ = nullptr;
};

TEST_F(LoopPredictorTest, PredictsAsTheWholeSystemDoes) {
  ASSERT_NE(factor_, nullptr);
  ASSERT_GT(loops_.size(), 9u);
  const std::vector<LoopPrediction> predictions =
      LoopPredictor(edges_, poses(), *factor_).Predict(loops_);
  ASSERT_EQ(predictions.size(), loops_.size());
  for (size_t k = 0; k != loops_.size(); ++k) {
    const WhitenedEdge& edge = edges_[loops_[k]];
    Eigen::Matrix3d of_from, of_to;
    const Eigen::Vector3d residual =
        Linearize(edge, poses()[edge.from], poses()[edge.to], &of_from, &of_to);
    EXPECT_EQ(predictions[k].residual, residual);
    BlockLdlt::Columns jacobian = BlockLdlt::Columns::Zero(rhs_.size(), 3);
    if (edge.from > 0) {
      jacobian.middleRows<3>(3 * edge.from - 3) = of_from.transpose();
    }
    jacobian.middleRows<3>(3 * edge.to - 3) = of_to.transpose();
    BlockLdlt::Columns columns = jacobian;
    factor_->Solve(&columns);
    const Eigen::Matrix3d expected = jacobian.transpose() * columns;
    EXPECT_LT((predictions[k].covariance - expected).norm(),
              1e-9 * (1. + expected.norm()));
  }
}

TEST_F(LoopPredictorTest, CompanyChangesNothing) {
  ASSERT_NE(factor_, nullptr);
  LoopPredictor predictor(edges_, poses(), *factor_);
  const std::vector<LoopPrediction> together = predictor.Predict(loops_);
  IncrementalFactor incremental;
  incremental.Reset(*factor_, rhs_);
  for (size_t k = 0; k != loops_.size(); ++k) {
    const LoopPrediction alone = predictor.Predict({loops_[k]}).front();
    EXPECT_EQ(alone.covariance, together[k].covariance);
    EXPECT_EQ(alone.blocks, together[k].blocks);
    // A factor that grows says the same.
    const WhitenedEdge& edge = edges_[loops_[k]];
    LinearFactor linear;
    linear.a = edge.from - 1;
    linear.b = edge.to - 1;
    Linearize(edge, poses()[edge.from], poses()[edge.to], &linear.jacobian_a,
              &linear.jacobian_b);
    EXPECT_LT(
        (incremental.PredictedCovariance(linear) - alone.covariance).norm(),
        1e-12 * (1. + alone.covariance.norm()));
    EXPECT_EQ(incremental.last_prediction_blocks(),
              static_cast<size_t>(alone.blocks));
  }
  EXPECT_TRUE(predictor.Predict({}).empty());
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
