// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/robust_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cartographer_ext/experiments/outliers/outlier_generator.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "gtest/gtest.h"
#include "tests/optimization/test_graphs.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace optimization {
namespace {

SolverOptions WithKernel(const KernelType type) {
  SolverOptions options;
  options.kernel = DefaultKernel(type);
  return options;
}

// The grid world, its optimum, and the same world with random outliers.
class RobustSolverTest : public ::testing::Test {
 protected:
  RobustSolverTest() : world_(test::MakeGridWorld(250, 8, 5)) {
    clean_ = Whiten(world_.graph.edges);
    optimum_ = world_.graph.poses;
    summary_ = SolveRobust(clean_, SolverOptions(), &optimum_);
    std::vector<PoseGraphEdge> edges = world_.graph.edges;
    test::AppendOutliers(world_.graph, test::Outliers(80), &edges);
    dirty_ = Whiten(edges);
  }
  test::GridWorld world_;
  std::vector<WhitenedEdge> clean_;
  std::vector<WhitenedEdge> dirty_;
  std::vector<Pose2> optimum_;
  SolverSummary summary_;
};

TEST_F(RobustSolverTest, CleanGraphConvergesToTheTruth) {
  EXPECT_TRUE(summary_.converged);
  EXPECT_LT(summary_.final_cost, summary_.initial_cost);
  EXPECT_LT(AbsoluteTrajectoryError(optimum_, world_.truth), 0.1);
  // chi2 of a right fit: about 3 per edge minus 3 per pose.
  const double dof = 3. * clean_.size() - 3. * (optimum_.size() - 1);
  EXPECT_NEAR(summary_.final_cost, dof, 6. * std::sqrt(2. * dof));
  // The first pose is held.
  EXPECT_DOUBLE_EQ(optimum_[0].x, world_.graph.poses[0].x);
  EXPECT_DOUBLE_EQ(optimum_[0].theta, world_.graph.poses[0].theta);
}

TEST_F(RobustSolverTest, GradientVanishesAtTheOptimum) {
  // Independent of the solver: differences of the cost.
  for (const int pose : {1, 100, 249}) {
    for (const double step : {1e-3, -1e-3}) {
      std::vector<Pose2> moved = optimum_;
      moved[pose].x += step;
      double cost = 0.;
      for (const double chi2 : Chi2OfEdges(clean_, moved)) cost += chi2;
      EXPECT_GT(cost, summary_.final_cost);
    }
  }
}

TEST_F(RobustSolverTest, LeastSquaresFailsWithOutliersAndKernelsDoNot) {
  std::vector<Pose2> poses = world_.graph.poses;
  SolveRobust(dirty_, SolverOptions(), &poses);
  EXPECT_GT(AbsoluteTrajectoryError(poses, optimum_), 0.5);
  // A kernel sees what its width reaches from the start; far starts are the
  // business of `auto`.
  std::vector<Pose2> start = optimum_;
  for (size_t i = 1; i != start.size(); ++i) {
    start[i].x += 0.03 * std::sin(0.1 * i);
    start[i].y += 0.03 * std::cos(0.1 * i);
  }
  for (const KernelType type :
       {KernelType::kDcs, KernelType::kGemanMcClure, KernelType::kAcs}) {
    poses = start;
    SolveRobust(dirty_, WithKernel(type), &poses);
    EXPECT_LT(AbsoluteTrajectoryError(poses, optimum_), 0.05)
        << KernelName(type);
    const LoopScore score = ScoreLoops(dirty_, clean_.size(), poses, optimum_);
    EXPECT_GT(score.precision, 0.95);
  }
}

TEST_F(RobustSolverTest, PruningKeepsTheOptimum) {
  for (const KernelType type :
       {KernelType::kDcs, KernelType::kGemanMcClure, KernelType::kAcs}) {
    SolverOptions options = WithKernel(type);
    options.cost_tolerance = 1e-12;
    options.max_iterations = 300;
    std::vector<Pose2> pruned = world_.graph.poses, full = pruned;
    const SolverSummary with = SolveRobust(dirty_, options, &pruned);
    options.prune = false;
    const SolverSummary without = SolveRobust(dirty_, options, &full);
    EXPECT_NEAR(with.final_cost, without.final_cost, 1e-4 * without.final_cost)
        << KernelName(type);
    EXPECT_LT(with.factor_blocks, without.factor_blocks);
    EXPECT_EQ(without.analyses, 1);
  }
}

TEST_F(RobustSolverTest, PrunedEdgesComeBack) {
  // A true loop that starts far off: all loops are dead at first, and the pull
  // of those that are not brings the others in.
  std::vector<Pose2> poses = world_.graph.poses;
  SolveRobust(dirty_, WithKernel(KernelType::kDcs), &poses);
  int alive_before = 0, alive_after = 0;
  for (size_t i = 0; i != clean_.size(); ++i) {
    if (!clean_[i].is_loop) continue;
    const WhitenedEdge& edge = clean_[i];
    alive_before += Chi2(edge, world_.graph.poses[edge.from],
                         world_.graph.poses[edge.to]) < kChi2Gate;
    alive_after += Chi2(edge, poses[edge.from], poses[edge.to]) < kChi2Gate;
  }
  EXPECT_GT(alive_after, alive_before);
}

TEST_F(RobustSolverTest, EndsWhereMoreStepsWouldGainNothing) {
  for (const KernelType type :
       {KernelType::kGemanMcClure, KernelType::kDcs, KernelType::kAcs}) {
    SolverOptions options = WithKernel(type);
    RobustSolver solver(dirty_);
    std::vector<Pose2> poses = world_.graph.poses;
    const SolverSummary summary = solver.Solve(options, &poses);
    EXPECT_TRUE(summary.converged);
    for (size_t i = 0; i != dirty_.size(); ++i) {
      const WhitenedEdge& edge = dirty_[i];
      const double expected =
          edge.is_loop
              ? EvaluateKernel(options.kernel,
                               Chi2(edge, poses[edge.from], poses[edge.to]),
                               AcsShape(options.kernel))
                    .weight
              : 1.;
      EXPECT_NEAR(solver.weights()[i], expected, 1e-9);
    }
    options.cost_tolerance = 0.;
    options.step_tolerance = 1e-9;
    const SolverSummary further = solver.Solve(options, &poses);
    EXPECT_NEAR(summary.final_cost, further.final_cost,
                1e-5 * further.final_cost)
        << KernelName(type);
    EXPECT_LE(further.final_cost, summary.final_cost);
  }
}

// Two steps of 1 m along x with a variance of 0.01 m^2 each and a loop of the
// same stiffness which says 2 m + `excess`. With d the part of the excess that
// the odometry takes, d / 0.02 = omega((excess - d)^2 / 0.02) (excess - d) /
// 0.02.
PoseGraph StretchedChain(const double excess) {
  PoseGraph graph;
  for (int i = 0; i != 3; ++i) {
    graph.ids.push_back(i);
    graph.poses.push_back(Pose2(i, 0., 0.));
  }
  const std::vector<std::pair<int, int>> pairs = {{0, 1}, {1, 2}, {0, 2}};
  for (const std::pair<int, int>& ends : pairs) {
    PoseGraphEdge edge;
    edge.from = ends.first;
    edge.to = ends.second;
    edge.is_loop = ends.second == ends.first + 2;
    edge.measurement =
        Pose2(ends.second - ends.first + (edge.is_loop ? excess : 0.), 0., 0.);
    edge.information =
        (edge.is_loop ? 50. : 100.) * Eigen::Matrix3d::Identity();
    graph.edges.push_back(edge);
  }
  return graph;
}

TEST(UndecidedLoopsTest, ALoopNearTheGateIsSettledAtOnce) {
  for (const double excess : {0.5, 0.55, 0.57, 0.6, 0.65}) {
    const PoseGraph graph = StretchedChain(excess);
    SolverOptions options;
    options.kernel = DefaultKernel(KernelType::kAcs);
    std::vector<Pose2> poses = graph.poses;
    const std::vector<WhitenedEdge> edges = Whiten(graph.edges);
    const SolverSummary summary = SolveRobust(edges, options, &poses);
    EXPECT_TRUE(summary.converged);
    // Reweighting until nothing moves any more.
    double d = 0.;
    for (int i = 0; i != 10000; ++i) {
      const double rest = excess - d;
      const double weight = EvaluateKernel(options.kernel, 50. * rest * rest,
                                           AcsShape(options.kernel))
                                .weight;
      d = excess * weight / (1. + weight);
    }
    EXPECT_NEAR(poses[2].x - 2., d, 2e-3) << excess;
    EXPECT_LE(summary.iterations, 6) << excess;
  }
}

TEST_F(RobustSolverTest, EdgeWeightsScaleAndSwitchOff) {
  SolverOptions options;
  options.edge_weights.assign(dirty_.size(), 1.);
  for (size_t i = clean_.size(); i != dirty_.size(); ++i) {
    options.edge_weights[i] = 0.;
  }
  std::vector<Pose2> poses = world_.graph.poses;
  const SolverSummary summary = SolveRobust(dirty_, options, &poses);
  EXPECT_NEAR(summary.final_cost, summary_.final_cost,
              1e-6 * summary_.final_cost);
  EXPECT_LT(AbsoluteTrajectoryError(poses, optimum_), 1e-4);
}

TEST_F(RobustSolverTest, PolishLowersTheTruncatedCost) {
  std::vector<Pose2> poses = world_.graph.poses;
  SolveRobust(dirty_, WithKernel(KernelType::kGemanMcClure), &poses);
  const double before = TruncatedCost(dirty_, poses);
  std::vector<double> weights;
  const SolverSummary summary =
      PolishTruncated(dirty_, kChi2Gate, 30, &poses, &weights);
  EXPECT_TRUE(summary.converged);
  EXPECT_LE(TruncatedCost(dirty_, poses), before + 1e-9);
  for (size_t i = 0; i != dirty_.size(); ++i) {
    const WhitenedEdge& edge = dirty_[i];
    EXPECT_EQ(weights[i] > 0.5,
              !edge.is_loop ||
                  Chi2(edge, poses[edge.from], poses[edge.to]) < kChi2Gate);
  }
}

// There and back along a street, whose loops close from the turn on, as each
// brings the next within the gate.
TEST(PolishTest, LoopsThatCloseLikeAZipComeInTogether) {
  constexpr int kLength = 300;
  const auto edge = [](const int from, const int to, const Pose2& measurement,
                       const bool is_loop) {
    PoseGraphEdge result;
    result.from = from;
    result.to = to;
    result.measurement = measurement;
    result.is_loop = is_loop;
    result.information.diagonal() << 2500., 2500., 10000.;
    return result;
  };
  PoseGraph graph;
  graph.poses.push_back(Pose2());
  for (int i = 1; i <= 2 * kLength; ++i) {
    const double turn = i == kLength ? kPi : 0.;
    graph.edges.push_back(
        edge(i - 1, i, Pose2(1., 0., NormalizeAngle(turn + 2e-3)), false));
    graph.poses.push_back(graph.poses.back() * graph.edges.back().measurement);
  }
  for (int i = 0; i < kLength - 1; i += 2) {
    graph.edges.push_back(edge(i, 2 * kLength - i, Pose2(0., 0., kPi), true));
  }
  std::vector<double> weights;
  const SolverSummary summary = PolishTruncated(Whiten(graph.edges), kChi2Gate,
                                                30, &graph.poses, &weights);
  EXPECT_TRUE(summary.converged);
  EXPECT_EQ(std::count(weights.begin(), weights.end(), 0.), 0);
  EXPECT_LE(summary.iterations, 80);
}

TEST_F(RobustSolverTest, AdaptiveGateFollowsTheScaleOfTheLoops) {
  // Honest information: the gate stays.
  EXPECT_DOUBLE_EQ(AdaptiveGate(clean_, optimum_), kChi2Gate);
  // Information a hundred times too small: the gate shrinks about as much,
  // times the safety factor of four.
  std::vector<PoseGraphEdge> shy = world_.graph.edges;
  for (PoseGraphEdge& edge : shy) edge.information *= 0.01;
  const double gate = AdaptiveGate(Whiten(shy), optimum_);
  EXPECT_GT(gate, 0.01 * kChi2Gate);
  EXPECT_LT(gate, 0.1 * kChi2Gate);
}

TEST_F(RobustSolverTest, KeepsItsPatternBetweenSolutions) {
  RobustSolver solver(dirty_);
  for (const KernelType type : {KernelType::kDcs, KernelType::kAcs,
                                KernelType::kGemanMcClure, KernelType::kDcs}) {
    SolverOptions options = WithKernel(type);
    options.cost_tolerance = 1e-10;
    std::vector<Pose2> fresh = world_.graph.poses, again = fresh;
    const SolverSummary expected = SolveRobust(dirty_, options, &fresh);
    const SolverSummary summary = solver.Solve(options, &again);
    EXPECT_NEAR(summary.final_cost, expected.final_cost,
                1e-6 * expected.final_cost);
    EXPECT_LT(AbsoluteTrajectoryError(again, fresh), 1e-4);
    EXPECT_LE(summary.analyses, expected.analyses);
  }
  SolverOptions options = WithKernel(KernelType::kDcs);
  std::vector<Pose2> poses = world_.graph.poses;
  solver.Solve(options, &poses);
  EXPECT_EQ(solver.Solve(options, &poses).analyses, 0);
}

TEST_F(RobustSolverTest, FactorIsThatOfTheWeightedEdges) {
  std::vector<double> weights(dirty_.size(), 0.);
  for (size_t i = 0; i != clean_.size(); ++i) weights[i] = 1.;
  RobustSolver solver(dirty_, RobustSolver::LastPoseLast());
  const std::vector<Pose2>& start = world_.graph.poses;
  Eigen::VectorXd step;
  const BlockLdlt* const factor = solver.Factor(start, weights, &step);
  ASSERT_NE(factor, nullptr);
  EXPECT_EQ(factor->order().back(), static_cast<int>(start.size()) - 2);
  factor->Solve(&step);
  // One undamped step of least squares without the outliers.
  SolverOptions options;
  options.max_iterations = 1;
  options.initial_lambda = 0.;
  std::vector<Pose2> expected = start;
  SolveRobust(clean_, options, &expected);
  for (size_t i = 1; i != expected.size(); ++i) {
    EXPECT_NEAR(start[i].x + step[3 * i - 3], expected[i].x, 1e-6);
    EXPECT_NEAR(start[i].y + step[3 * i - 2], expected[i].y, 1e-6);
  }
}

TEST_F(RobustSolverTest, PolishAdaptedNeverRaisesTheCostAtItsGate) {
  // Loops a hundred times more exact than they say, a few of them wrong by
  // little.
  std::vector<PoseGraphEdge> shy = world_.graph.edges;
  for (PoseGraphEdge& edge : shy) edge.information *= 0.01;
  int shifted = 0;
  std::vector<size_t> wrong;
  for (size_t i = 0; i != shy.size() && shifted != 3; i += 7) {
    if (!shy[i].is_loop) continue;
    const double sigma = 1. / std::sqrt(shy[i].information(0, 0));
    shy[i].measurement = shy[i].measurement * Pose2(3. * sigma, 0., 0.);
    wrong.push_back(i);
    ++shifted;
  }
  const std::vector<WhitenedEdge> edges = Whiten(shy);
  std::vector<Pose2> poses = optimum_;
  std::vector<double> weights;
  PolishTruncated(edges, kChi2Gate, 30, &poses, &weights);
  const std::vector<Pose2> before = poses;
  PolishAdapted(edges, 30, &poses, &weights);
  const double gate = AdaptiveGate(edges, poses);
  EXPECT_LT(gate, 0.2 * kChi2Gate);
  EXPECT_LE(TruncatedCost(edges, poses, gate),
            TruncatedCost(edges, before, gate));
  for (const size_t i : wrong) EXPECT_EQ(weights[i], 0.);
}

TEST_F(RobustSolverTest, GncFindsTheInliers) {
  std::vector<Pose2> poses = world_.graph.poses;
  std::vector<double> weights;
  SolveGnc(dirty_, GncOptions(), &poses, &weights);
  ASSERT_EQ(weights.size(), dirty_.size());
  EXPECT_LT(AbsoluteTrajectoryError(poses, optimum_), 0.05);
}

// Half as many grouped wrong loops as poses fold the first solution; rounds
// that start from it stay folded.
TEST_F(RobustSolverTest, GncStartsEachRoundFromTheGivenPoses) {
  std::vector<PoseGraphEdge> edges = world_.graph.edges;
  test::AppendOutliers(
      world_.graph, test::Outliers(120, OutlierType::kRandomGrouped), &edges);
  const std::vector<WhitenedEdge> dirty = Whiten(edges);
  GncOptions options;
  std::vector<Pose2> poses = world_.graph.poses;
  SolveGnc(dirty, options, &poses, nullptr);
  EXPECT_LT(AbsoluteTrajectoryError(poses, optimum_), 0.01);
  options.restart = false;
  poses = world_.graph.poses;
  SolveGnc(dirty, options, &poses, nullptr);
  EXPECT_GT(AbsoluteTrajectoryError(poses, optimum_), 0.1);
}

// From a map that is right, loops far beyond the gate take no part: the same
// inliers, and a factor that they do not fill.
TEST_F(RobustSolverTest, GncWithinReach) {
  std::vector<Pose2> all = optimum_, near = optimum_;
  std::vector<double> weights_all, weights_near;
  GncOptions options;
  options.max_outer_iterations = 1;
  const size_t filled = SolveGnc(dirty_, options, &all, nullptr).factor_blocks;
  const auto reaching = [&](const int rounds, std::vector<Pose2>* const poses,
                            std::vector<double>* const weights) {
    options.max_outer_iterations = rounds;
    options.reach = 10. * kChi2Gate;
    *poses = optimum_;
    return SolveGnc(dirty_, options, poses, weights).factor_blocks;
  };
  EXPECT_LT(reaching(1, &near, nullptr), filled);
  reaching(100, &near, &weights_near);
  all = optimum_;
  SolveGnc(dirty_, GncOptions(), &all, &weights_all);
  EXPECT_EQ(weights_near, weights_all);
  EXPECT_LT(AbsoluteTrajectoryError(near, all), 1e-5);
}

TEST_F(RobustSolverTest, GncEndsInTime) {
  GncOptions options;
  options.max_seconds = 0.;
  std::vector<Pose2> poses = world_.graph.poses;
  std::vector<double> weights;
  const SolverSummary summary = SolveGnc(dirty_, options, &poses, &weights);
  EXPECT_FALSE(summary.converged);
  // The first solution only: all loops in force.
  EXPECT_LE(summary.iterations, options.inner_iterations);
  EXPECT_EQ(weights, std::vector<double>(dirty_.size(), 1.));
  options.max_seconds = 1e9;
  EXPECT_TRUE(SolveGnc(dirty_, options, &poses, &weights).converged);
}

TEST(RobustSolverEdgeCasesTest, TrivialGraphs) {
  std::vector<Pose2> poses = {Pose2(1., 2., 3.)};
  const SolverSummary summary = SolveRobust({}, SolverOptions(), &poses);
  EXPECT_TRUE(summary.converged);
  EXPECT_DOUBLE_EQ(poses[0].x, 1.);
  PoseGraphEdge edge;
  edge.to = 1;
  edge.measurement = Pose2(1., 0., 0.5);
  poses.push_back(Pose2());
  SolveRobust(Whiten(std::vector<PoseGraphEdge>{edge}), SolverOptions(),
              &poses);
  const Pose2 expected = poses[0] * edge.measurement;
  EXPECT_NEAR(poses[1].x, expected.x, 1e-6);
  EXPECT_NEAR(poses[1].y, expected.y, 1e-6);
  EXPECT_NEAR(NormalizeAngle(poses[1].theta - expected.theta), 0., 1e-6);
}

TEST(RobustSolverDataTest, KnownOptima) {
  // Half of chi2 at the optimum without outliers.
  const struct {
    const char* name;
    double half_chi2;
  } kCases[] = {{"g2o/intel.g2o.xz", 273.2},
                {"g2o/manhattan_g2o.g2o.xz", 73.04},
                {"g2o/city10000.g2o.xz", 255.99}};
  for (const auto& c : kCases) {
    CARTOGRAPHER_EXT_SKIP_WITHOUT(cartographer_ext::test::SharedData(c.name));
    const PoseGraph graph =
        test::ReadGraph(cartographer_ext::test::SharedData(c.name));
    ASSERT_TRUE(ValidatePoseGraph(graph).ok());
    std::vector<Pose2> poses = graph.poses;
    const SolverSummary summary =
        SolveRobust(Whiten(graph.edges), SolverOptions(), &poses);
    EXPECT_NEAR(0.5 * summary.final_cost, c.half_chi2, 0.05) << c.name;
  }
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
