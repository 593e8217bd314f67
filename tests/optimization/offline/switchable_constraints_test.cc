// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/switchable_constraints.h"

#include <cmath>

#include "cartographer_ext/experiments/outliers/outlier_generator.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "gtest/gtest.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

class SwitchableConstraintsTest : public ::testing::Test {
 protected:
  SwitchableConstraintsTest() : world_(test::MakeGridWorld(150, 6, 9)) {
    test::AddOutliers(test::Outliers(30), &world_.graph);
    edges_ = Whiten(world_.graph.edges);
  }
  test::GridWorld world_;
  std::vector<WhitenedEdge> edges_;
};

TEST_F(SwitchableConstraintsTest, CeresAndOwnSolverAgree) {
  for (const KernelType type :
       {KernelType::kNone, KernelType::kHuber, KernelType::kGemanMcClure,
        KernelType::kDcs, KernelType::kAcs}) {
    SolverOptions options;
    options.kernel = DefaultKernel(type);
    options.cost_tolerance = 1e-14;
    options.step_tolerance = 1e-12;
    options.max_iterations = 1000;
    // Pruning drops the pull of dead edges, which this test would notice.
    options.prune = false;
    std::vector<Pose2> ours = world_.graph.poses;
    const SolverSummary summary = SolveRobust(edges_, options, &ours);
    std::vector<Pose2> theirs = ours;
    // From the same basin, so that local minima do not matter.
    for (size_t i = 1; i != theirs.size(); ++i) {
      theirs[i].x += 1e-3 * std::sin(1. * i);
      theirs[i].theta += 1e-4 * std::cos(1. * i);
    }
    const SolverSummary ceres =
        SolveWithCeres(edges_, options.kernel, 1000, 1e-15, &theirs);
    EXPECT_NEAR(summary.final_cost, ceres.final_cost, 1e-6 * summary.final_cost)
        << KernelName(type);
  }
}

TEST_F(SwitchableConstraintsTest, JointSwitchesEqualGemanMcClure) {
  // With s = w / (w + chi2) put in, the joint objective is the kernel's.
  std::vector<Pose2> poses = world_.graph.poses;
  SolverOptions options;
  options.kernel = DefaultKernel(KernelType::kGemanMcClure);
  options.cost_tolerance = 1e-14;
  options.max_iterations = 1000;
  options.prune = false;
  const SolverSummary ours = SolveRobust(edges_, options, &poses);
  std::vector<Pose2> joint = poses;
  // Start at the same optimum, with the switches it implies.
  std::vector<double> switches;
  for (const double chi2 : Chi2OfEdges(edges_, joint)) {
    switches.push_back(1. / (1. + chi2));
  }
  SwitchableOptions switchable;
  switchable.function_tolerance = 1e-15;
  switchable.max_iterations = 1000;
  const SolverSummary summary =
      SolveSwitchable(edges_, switchable, &joint, &switches);
  EXPECT_NEAR(summary.final_cost, ours.final_cost, 1e-5 * ours.final_cost);
  for (size_t i = 0; i != edges_.size(); ++i) {
    EXPECT_GE(switches[i], 0.);
    EXPECT_LE(switches[i], 1.);
    if (!edges_[i].is_loop) {
      EXPECT_DOUBLE_EQ(switches[i], 1.);
      continue;
    }
    const double chi2 =
        Chi2(edges_[i], joint[edges_[i].from], joint[edges_[i].to]);
    EXPECT_NEAR(switches[i], 1. / (1. + chi2), 1e-2);  // ACS eq. (8)
  }
}

TEST_F(SwitchableConstraintsTest, EndsInTime) {
  SwitchableOptions options;
  options.max_seconds = 0.;
  std::vector<Pose2> poses = world_.graph.poses;
  std::vector<double> switches;
  const SolverSummary summary =
      SolveSwitchable(edges_, options, &poses, &switches);
  EXPECT_FALSE(summary.converged);
  EXPECT_LE(summary.iterations, 1);
}

TEST_F(SwitchableConstraintsTest, NothingToDo) {
  std::vector<Pose2> poses = {Pose2()};
  std::vector<double> switches;
  SolveSwitchable({}, SwitchableOptions(), &poses, &switches);
  EXPECT_TRUE(switches.empty());
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
