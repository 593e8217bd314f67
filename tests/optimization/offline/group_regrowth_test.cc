// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "gmock/gmock.h"
#include "tests/optimization/weak_ring.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Metre by metre along a line and, from the middle on, back; loops are added.
// `poses` are chained odometry, of which `truth` may differ in how far the robot
// turns in the middle (radians).
class ThereAndBack {
 public:
  ThereAndBack(const int num_poses, const double turn,
               const double heading_sigma, const double position_sigma) {
    poses.push_back(Pose2());
    truth.push_back(Pose2());
    for (int i = 0; i + 1 != num_poses; ++i) {
      PoseGraphEdge edge = Edge(i, i + 1, position_sigma, heading_sigma);
      const bool in_middle = i == num_poses / 2 - 1;
      edge.measurement = in_middle ? Pose2(0., 0., kPi) : Pose2(1., 0., 0.);
      poses.push_back(poses.back() * edge.measurement);
      truth.push_back(truth.back() *
                      (in_middle ? Pose2(0., 0., turn) : edge.measurement));
      graph.edges.push_back(edge);
    }
    graph.poses = poses;
  }

  // One group of loops to the way back where it lies, or `aside` (metres).
  void AddGroup(const int first, const int size, const double position_sigma,
                const double heading_sigma, const double aside) {
    support.agreeing.resize(graph.edges.size());
    support.group.resize(graph.edges.size(), -1);
    std::vector<int> group;
    for (int from = first; from != first + size; ++from) {
      PoseGraphEdge edge =
          Edge(from, poses.size() - 1 - from, position_sigma, heading_sigma);
      edge.is_loop = true;
      edge.measurement =
          Between(truth[from], Pose2(0., aside, 0.) * truth[edge.to]);
      group.push_back(graph.edges.size());
      graph.edges.push_back(edge);
    }
    for (const int i : group) {
      std::vector<int> others;
      for (const int j : group) {
        if (j != i) others.push_back(j);
      }
      support.agreeing.push_back(std::move(others));
      support.group.push_back(support.groups.size());
    }
    support.groups.push_back(std::move(group));
  }

  PoseGraph graph;
  std::vector<Pose2> poses, truth;
  LoopSupport support;

 private:
  static PoseGraphEdge Edge(const int from, const int to,
                            const double position_sigma,
                            const double heading_sigma) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.information =
        Eigen::Vector3d(position_sigma, position_sigma, heading_sigma)
            .cwiseAbs2()
            .cwiseInverse()
            .asDiagonal();
    return edge;
  }
};

TEST(GroupRegrowthTest, LoopsComeInTogetherThatAloneCostMoreThanTheGate) {
  ThereAndBack world(80, kPi + 0.12, 0.01, 0.01);
  for (const int from : {4, 10, 16, 22, 28, 34}) {
    world.AddGroup(from, 1, 0.01, 0.01, 0.);
  }
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  const std::vector<double> in_force =
      DecideLoops(edges, world.poses, kChi2Gate);
  std::vector<int> rejected;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (edges[i].is_loop) rejected.push_back(i);
  }
  for (const Innovation& innovation :
       PredictLoops(rejected, in_force, world.poses, &solver)) {
    ASSERT_GT(innovation.chi2, 1.2 * kChi2Gate);
  }
  std::vector<Pose2> poses = world.poses;
  EXPECT_EQ(FlipLoops(FlipOptions(), &solver, &poses), 0);
  EXPECT_EQ(
      RegrowGroups(world.support, RegrowOptions(), &solver, &poses, nullptr),
      1);
  EXPECT_LT(TruncatedCost(edges, poses), 3. * kChi2Gate);
  EXPECT_LT(AbsoluteTrajectoryError(poses, world.truth), 0.05);
}

// The map without the loops among the edges [first, last), polished.
std::vector<Pose2> SolvedWithoutLoops(const size_t first, const size_t last,
                                      std::vector<Pose2> poses,
                                      RobustSolver* const solver) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  SolverOptions options;
  options.edge_weights.assign(edges.size(), 1.);
  for (size_t i = first; i != last; ++i) {
    if (edges[i].is_loop) options.edge_weights[i] = 0.;
  }
  solver->Solve(options, &poses);
  PolishTruncated(kChi2Gate, 30, solver, &poses, nullptr);
  return poses;
}

// Groups of one to five loops are released before it, and each alone leads
// nowhere.
TEST(GroupRegrowthTest, AWrongGroupIsReleasedWhateverItsSize) {
  ThereAndBack world(240, kPi, 0.02, 0.05);
  for (int size = 1; size != 6; ++size) {
    world.AddGroup(2 + 7 * size, size, 0.1, 0.05, 0.);
  }
  const size_t first_out = world.graph.edges.size();
  world.AddGroup(50, 5, 0.1, 0.05, 0.);
  world.AddGroup(90, 5, 0.1, 0.05, 0.);
  const size_t first_wrong = world.graph.edges.size();
  world.AddGroup(68, 6, 0.1, 0.05, 8.);
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  // Start with the wrong group and those that are far from it.
  std::vector<Pose2> poses =
      SolvedWithoutLoops(first_out, first_wrong, world.poses, &solver);
  ASSERT_GT(TruncatedCost(edges, poses), 10. * kChi2Gate);
  for (size_t i = first_wrong; i != edges.size(); ++i) {
    ASSERT_LT(Chi2(edges[i], poses[edges[i].from], poses[edges[i].to]),
              kChi2Gate);
  }
  EXPECT_GT(
      RegrowGroups(world.support, RegrowOptions(), &solver, &poses, nullptr),
      0);
  EXPECT_NEAR(TruncatedCost(edges, poses), 6. * kChi2Gate, 1e-3);
  EXPECT_LT(AbsoluteTrajectoryError(poses, world.truth), 1e-3);
}

// Several right groups together explain more than a wrong one that is larger
// than each of them and all that is in force.
TEST(GroupRegrowthTest, AMapGrowsAnewFromAGroupThatIsRejected) {
  ThereAndBack world(240, kPi, 0.02, 0.05);
  for (const int from : {20, 45, 70, 95}) {
    world.AddGroup(from, 3, 0.1, 0.05, 0.);
  }
  const size_t first_wrong = world.graph.edges.size();
  world.AddGroup(57, 8, 0.1, 0.05, 8.);
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  const std::vector<Pose2> folded =
      SolvedWithoutLoops(0, first_wrong, world.poses, &solver);
  ASSERT_GT(TruncatedCost(edges, folded), 10. * kChi2Gate);
  RegrowOptions options;  // none of the other moves
  options.max_failures = 0;
  options.max_near = 0;
  options.max_starts = 0;
  std::vector<Pose2> poses = folded;
  EXPECT_EQ(RegrowGroups(world.support, options, &solver, &poses, nullptr), 0);
  options.max_starts = 5;
  EXPECT_GT(RegrowGroups(world.support, options, &solver, &poses, nullptr), 0);
  EXPECT_NEAR(TruncatedCost(edges, poses), 8. * kChi2Gate, 1e-3);
  EXPECT_LT(AbsoluteTrajectoryError(poses, world.truth), 1e-3);
}

// What remains when a wrong group is released does not unfold by descent.
TEST(GroupRegrowthTest, AReleasedRingUnfolds) {
  for (const uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
    test::GridWorld world = test::MakeWeakRing(seed, 0.1, true);
    const PoseGraphEdge right = world.graph.edges.back();
    for (int j = 0; j != 6; ++j) {
      PoseGraphEdge edge = right;
      edge.from = 20 + j;
      edge.to = 160 + j;
      edge.measurement = Pose2(0.3, 0., 0.);
      world.graph.edges.push_back(edge);
    }
    const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
    RobustSolver solver(edges);
    std::vector<Pose2> truth = world.truth;
    PolishTruncated(kChi2Gate, 30, &solver, &truth, nullptr);
    std::vector<Pose2> poses = world.graph.poses;
    solver.Solve(SolverOptions(), &poses);
    PolishTruncated(kChi2Gate, 30, &solver, &poses, nullptr);
    ASSERT_GT(TruncatedCost(edges, poses),
              TruncatedCost(edges, truth) + 10. * kChi2Gate);
    RegrowGroups(FindLoopSupport(world.graph, LoopSupportOptions()),
                 RegrowOptions(), &solver, &poses, nullptr);
    EXPECT_LT(TruncatedCost(edges, poses), TruncatedCost(edges, truth) + 1.)
        << seed;
  }
}

// What the loops in force have wound, no descent unwinds.
TEST(GroupRegrowthTest, LoopsInForceAreWoundOtherwise) {
  const test::GridWorld world = test::MakeWeakRing(16, 0.15, true);
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  const LoopSupport support =
      FindLoopSupport(world.graph, LoopSupportOptions());
  RobustSolver solver(edges);
  std::vector<Pose2> right = world.truth, start = world.graph.poses;
  PolishTruncated(kChi2Gate, 30, &solver, &right, nullptr);
  SolverOptions dcs;
  dcs.kernel = DefaultKernel(KernelType::kDcs);
  solver.Solve(dcs, &start);
  PolishTruncated(kChi2Gate, 30, &solver, &start, nullptr);
  RegrowOptions options;
  std::vector<Pose2> poses = start;
  EXPECT_GT(RegrowGroups(support, options, &solver, &poses, nullptr), 0);
  EXPECT_LT(TruncatedCost(edges, poses), TruncatedCost(edges, right) + 1e-3);
  options.max_windings = 0;
  poses = start;
  RegrowGroups(support, options, &solver, &poses, nullptr);
  EXPECT_GT(TruncatedCost(edges, poses),
            TruncatedCost(edges, right) + kChi2Gate);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
