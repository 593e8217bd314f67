// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The swap `full_information`: residuals of constraints whose whole information
// matrix is known, residuals of the relaxed problem, and the optimisation that
// uses them.
#include <array>
#include <map>
#include <memory>
#include <vector>

#include "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/loop_information.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/optimization/graph/relaxation.h"
#include "cartographer_ext/swaps.h"
#include "gtest/gtest.h"

#ifdef CARTOGRAPHER_EXT_SWAP_FULL_INFORMATION
namespace cartographer_ext {
namespace overlay {
namespace {

namespace optimization = cartographer::mapping::optimization;
using cartographer::mapping::NodeId;
using cartographer::mapping::PoseGraphInterface;
using cartographer::mapping::SubmapId;
using cartographer::transform::Embed3D;
using cartographer::transform::Rigid2d;
using Constraint = PoseGraphInterface::Constraint;
using CreateCost = ceres::CostFunction* (*)(const Constraint::Pose&);

Constraint::Pose MakePose(const Rigid2d& relative, const double weight) {
  return Constraint::Pose{Embed3D(relative), weight, weight};
}

Eigen::Vector3d Residual(const CreateCost create, const Constraint::Pose& pose,
                         const Eigen::Vector3d& start,
                         const Eigen::Vector3d& end) {
  const std::unique_ptr<ceres::CostFunction> cost(create(pose));
  const double* const parameters[] = {start.data(), end.data()};
  Eigen::Vector3d residual;
  EXPECT_TRUE(cost->Evaluate(parameters, residual.data(), nullptr));
  return residual;
}

class FullInformationSwapTest : public testing::TestWithParam<CreateCost> {};

// For the scope of an optimization.
ScopedSqrtInformation::SqrtOfPose SqrtOf(const Constraint::Pose& pose,
                                         const Eigen::Matrix3d& information) {
  const Eigen::Matrix3d upper = information.llt().matrixU();
  ScopedSqrtInformation::SqrtOfPose result;
  Eigen::Map<Eigen::Matrix3d>{result[&pose].data()} = upper;
  return result;
}

// The error is (1, -2, 0.5) in the frame of the first body, which is turned by
// a quarter.
const Eigen::Vector3d kStart(1., 1., M_PI / 2.);
const Eigen::Vector3d kEnd(1. + 3., 1. + 2., M_PI / 2. - 0.5);

TEST_P(FullInformationSwapTest, UnknownConstraintsHaveTheStockResidual) {
  const Constraint::Pose pose = MakePose(Rigid2d({3., -5.}, 0.), 10.);
  const Constraint::Pose equal = pose;
  const ScopedSqrtInformation scope(SqrtOf(equal, Eigen::Matrix3d::Identity()));
  const Eigen::Vector3d residual = Residual(GetParam(), pose, kStart, kEnd);
  EXPECT_LT((residual - Eigen::Vector3d(10., -20., 5.)).norm(), 1e-12)
      << residual.transpose();
}

TEST_P(FullInformationSwapTest, KnownOnesAreWeightedWithTheMatrix) {
  const Constraint::Pose pose = MakePose(Rigid2d({3., -5.}, 0.), 10.);
  Eigen::Matrix3d information;
  information << 4., 1., 0., 1., 2., 0.5, 0., 0.5, 8.;
  const ScopedSqrtInformation scope(SqrtOf(pose, information));
  const Eigen::Vector3d residual = Residual(GetParam(), pose, kStart, kEnd);
  // e^T Omega e with e = (1, -2, 0.5): 4 + 8 + 2 + 2 (-2) + 2 (-0.5).
  EXPECT_NEAR(residual.squaredNorm(), 9., 1e-10);
}

TEST_P(FullInformationSwapTest, DerivativesAreRight) {
  const Constraint::Pose pose = MakePose(Rigid2d({0.3, -0.5}, 0.7), 10.);
  Eigen::Matrix3d information;
  information << 4., 1., 0., 1., 2., 0.5, 0., 0.5, 8.;
  const ScopedSqrtInformation scope(SqrtOf(pose, information));
  const std::unique_ptr<ceres::CostFunction> cost(GetParam()(pose));
  std::array<Eigen::Vector3d, 2> poses{
      {Eigen::Vector3d(0.1, 0.2, -0.4), Eigen::Vector3d(0.5, -0.1, 0.6)}};
  const double* const parameters[] = {poses[0].data(), poses[1].data()};
  using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  std::array<RowMajor3, 2> analytic;
  double* jacobians[] = {analytic[0].data(), analytic[1].data()};
  Eigen::Vector3d residual;
  ASSERT_TRUE(cost->Evaluate(parameters, residual.data(), jacobians));
  constexpr double kStep = 1e-6;
  for (int block = 0; block != 2; ++block) {
    for (int i = 0; i != 3; ++i) {
      Eigen::Vector3d before, after;
      poses[block][i] += kStep;
      ASSERT_TRUE(cost->Evaluate(parameters, after.data(), nullptr));
      poses[block][i] -= 2. * kStep;
      ASSERT_TRUE(cost->Evaluate(parameters, before.data(), nullptr));
      poses[block][i] += kStep;
      EXPECT_LT(
          (analytic[block].col(i) - (after - before) / (2. * kStep)).norm(),
          1e-7);
    }
    // The other block alone.
    jacobians[block] = nullptr;
    const RowMajor3 other = analytic[1 - block];
    ASSERT_TRUE(cost->Evaluate(parameters, residual.data(), jacobians));
    EXPECT_LT((analytic[1 - block] - other).norm(), 1e-12);
    jacobians[block] = analytic[block].data();
  }
}

// Half the squared norm of the residuals of a step.
double CostOf(const ceres::CostFunction& cost, const Eigen::Vector3d& start,
              const Eigen::Vector3d& end) {
  const double* const parameters[] = {start.data(), end.data()};
  std::vector<double> residuals(cost.num_residuals());
  EXPECT_TRUE(cost.Evaluate(parameters, residuals.data(), nullptr));
  double result = 0.;
  for (const double residual : residuals) result += 0.5 * residual * residual;
  return result;
}

TEST_P(FullInformationSwapTest, RelaxedStepsHaveHubersCost) {
  // The error is (1, -2, 0.5), with weights of 2 and 8 of norm 6: sqrt(2 * 2 +
  // 4 * 4 + 4 * 4).
  Constraint::Pose pose = MakePose(Rigid2d({3., -5.}, 0.), 2.);
  pose.rotation_weight = 8.;
  const auto cost = [&pose](const double pull, const double scale) {
    const cartographer_ext::optimization::ScopedRelaxation scope(
        {pull, 2., 8., scale}, nullptr, nullptr);
    return CostOf(*std::unique_ptr<ceres::CostFunction>(GetParam()(pose)),
                  kStart, kEnd);
  };
  EXPECT_NEAR(cost(1., 7.), 18., 1e-12);           // 36 / 2
  EXPECT_NEAR(cost(1., 6.), 18., 1e-12);           // where both parts meet
  EXPECT_NEAR(cost(1., 2.), 2. * 6. - 2., 1e-12);  // b |r| - b^2 / 2
  EXPECT_NEAR(cost(1., 0.5), 3. - 0.125, 1e-12);
  // All of the sum is divided by k^2.
  EXPECT_NEAR(cost(10., 7.), 0.18, 1e-12);
  EXPECT_NEAR(cost(10., 2.), 0.1, 1e-12);
}

TEST_P(FullInformationSwapTest, RelaxedStepsMayBeWeighedLess) {
  // The error of above with weights of 2 and 8, times 0.5 and 0.25: 1, -2 and 1.
  Constraint::Pose pose = MakePose(Rigid2d({3., -5.}, 0.), 2.);
  pose.rotation_weight = 8.;
  const cartographer_ext::optimization::ScopedRelaxation scope(
      {1., 2., 8., 100., 0.5, 0.25}, nullptr, nullptr);
  EXPECT_NEAR(CostOf(*std::unique_ptr<ceres::CostFunction>(GetParam()(pose)),
                     kStart, kEnd),
              3., 1e-12);
}

TEST_P(FullInformationSwapTest, RelaxedConstraintsAreDivided) {
  const Constraint::Pose pose = MakePose(Rigid2d({3., -5.}, 0.), 10.);
  const Constraint::Pose other = pose;
  Eigen::Matrix3d information = 4. * Eigen::Matrix3d::Identity();
  const ScopedSqrtInformation matrices(SqrtOf(other, information));
  // With the weights of steps, but a constraint.
  const cartographer_ext::optimization::ScopedRelaxation scope(
      {5., 10., 10., 1.}, &pose, &pose + 1);
  EXPECT_LT(
      (Residual(GetParam(), pose, kStart, kEnd) - Eigen::Vector3d(2., -4., 1.))
          .norm(),
      1e-12);
  EXPECT_LT((Residual(GetParam(), other, kStart, kEnd) -
             Eigen::Vector3d(0.4, -0.8, 0.2))
                .norm(),
            1e-12);
}

TEST_P(FullInformationSwapTest, TheGradientOfARelaxedStepIsRight) {
  const Constraint::Pose pose = MakePose(Rigid2d({0.3, -0.5}, 0.7), 10.);
  for (const double scale : {0.1, 1., 100.}) {
    const cartographer_ext::optimization::ScopedRelaxation scope(
        {3., 10., 10., scale}, nullptr, nullptr);
    const std::unique_ptr<ceres::CostFunction> cost(GetParam()(pose));
    std::array<Eigen::Vector3d, 2> poses{
        {Eigen::Vector3d(0.1, 0.2, -0.4), Eigen::Vector3d(0.5, -0.1, 0.6)}};
    const double* const parameters[] = {poses[0].data(), poses[1].data()};
    const int rows = cost->num_residuals();
    Eigen::VectorXd residual(rows);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    std::array<RowMajor, 2> jacobian{{RowMajor(rows, 3), RowMajor(rows, 3)}};
    double* jacobians[] = {jacobian[0].data(), jacobian[1].data()};
    ASSERT_TRUE(cost->Evaluate(parameters, residual.data(), jacobians));
    constexpr double kStep = 1e-6;
    for (int block = 0; block != 2; ++block) {
      const Eigen::Vector3d gradient = jacobian[block].transpose() * residual;
      for (int i = 0; i != 3; ++i) {
        poses[block][i] += kStep;
        const double after = CostOf(*cost, poses[0], poses[1]);
        poses[block][i] -= 2. * kStep;
        const double before = CostOf(*cost, poses[0], poses[1]);
        poses[block][i] += kStep;
        EXPECT_NEAR(gradient[i], (after - before) / (2. * kStep), 1e-6)
            << "scale " << scale;
      }
    }
    // The second block alone.
    jacobians[0] = nullptr;
    const RowMajor both = jacobian[1];
    ASSERT_TRUE(cost->Evaluate(parameters, residual.data(), jacobians));
    EXPECT_LT((jacobian[1] - both).norm(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(
    BothFactories, FullInformationSwapTest,
    testing::Values(&optimization::CreateAutoDiffSpaCostFunction,
                    &optimization::CreateAnalyticalSpaCostFunction));

// A loop says the node is at the origin, mapping says (1, 0) with weight 10.
Eigen::Vector2d Solve(const Constraint::Pose& loop) {
  optimization::proto::OptimizationProblemOptions options;
  options.set_huber_scale(1e3);
  options.mutable_ceres_solver_options()->set_max_num_iterations(50);
  options.mutable_ceres_solver_options()->set_num_threads(1);
  optimization::OptimizationProblem2D problem(options);
  problem.AddSubmap(0, Rigid2d::Identity());
  problem.AddTrajectoryNode(
      0, optimization::NodeSpec2D{cartographer::common::FromUniversal(1),
                                  {},
                                  Rigid2d({0.5, 0.5}, 0.),
                                  Eigen::Quaterniond::Identity()});
  const SubmapId submap(0, 0);
  const NodeId node(0, 0);
  problem.Solve({Constraint{submap, node, MakePose(Rigid2d({1., 0.}, 0.), 10.),
                            Constraint::INTRA_SUBMAP},
                 Constraint{submap, node, loop, Constraint::INTER_SUBMAP}},
                {{0, PoseGraphInterface::TrajectoryState::ACTIVE}}, {});
  return problem.node_data().at(node).global_pose_2d.translation();
}

TEST(FullInformationSolveTest, TheOptimizationFollowsTheMatrix) {
  const auto context = std::make_shared<PoseGraphContext>();
  const ScopedPoseGraphContext scope(context);
  const Constraint::Pose loop = MakePose(Rigid2d::Identity(), 20.);
  // Scalars: 100 / (100 + 400).
  EXPECT_LT((Solve(loop) - Eigen::Vector2d(0.2, 0.)).norm(), 1e-3);
  // Information 400 along the diagonal, 4 across it: (Omega + 100) t =
  // (100, 0).
  Eigen::Matrix3d information;
  information << 202., 198., 0., 198., 202., 0., 0., 0., 400.;
  ASSERT_TRUE(context->Get<LoopInformation>()->Set(LoopId(), information));
  const Eigen::Vector2d expected(100. * 302. / 52000., -100. * 198. / 52000.);
  const Eigen::Vector2d solved = Solve(loop);
  EXPECT_LT((solved - expected).norm(), 1e-3) << solved.transpose();
  // That of another pose graph.
  const ScopedPoseGraphContext other(std::make_shared<PoseGraphContext>());
  EXPECT_LT((Solve(loop) - Eigen::Vector2d(0.2, 0.)).norm(), 1e-3);
}

}  // namespace
}  // namespace overlay
}  // namespace cartographer_ext
#endif  // CARTOGRAPHER_EXT_SWAP_FULL_INFORMATION
