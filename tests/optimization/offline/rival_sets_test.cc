// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/rival_sets.h"

#include "cartographer_ext/optimization/offline/starts/windings.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gmock/gmock.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using ::testing::ElementsAre;

// A chain of eleven poses whose ends some loops see in place, and two pairs of
// loops that contradict each other: these are moved aside by `side` metres.
struct Rivals {
  std::vector<WhitenedEdge> edges;
  std::vector<Pose2> left, right;
};

Rivals MakeRivals(const double side, const int in_place) {
  std::vector<PoseGraphEdge> list;
  std::vector<Pose2> poses = {Pose2()};
  const auto add = [&](const int from, const int to, const Pose2& measurement,
                       const double information, const bool is_loop) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.measurement = measurement;
    edge.information = information * Eigen::Matrix3d::Identity();
    edge.is_loop = is_loop;
    list.push_back(edge);
  };
  for (int i = 0; i != 10; ++i) {
    add(i, i + 1, Pose2(1., 0., 0.), 25., false);
    poses.push_back(poses.back() * Pose2(1., 0., 0.));
  }
  for (const double aside : {side, -side}) {
    add(0, 10, Pose2(10., aside, 0.), 400., true);
    add(1, 9, Pose2(8., 0.8 * aside, 0.), 400., true);
  }
  for (int k = 0; k != in_place; ++k) {
    add(0, 10, Pose2(10., 0., 0.), 400., true);
    add(1, 9, Pose2(8., 0., 0.), 400., true);
  }
  Rivals result;
  result.edges = Whiten(list);
  for (const bool left : {true, false}) {
    SolverOptions options;
    options.edge_weights.assign(list.size(), 1.);
    options.edge_weights[left ? 12 : 10] = 0.;
    options.edge_weights[left ? 13 : 11] = 0.;
    std::vector<Pose2> solved = poses;
    SolveRobust(result.edges, options, &solved);
    (left ? result.left : result.right) = solved;
  }
  return result;
}

std::vector<RivalSets> Find(const Rivals& rivals,
                            const RivalOptions& options = RivalOptions()) {
  RobustSolver solver(rivals.edges);
  const double left = TruncatedCost(rivals.edges, rivals.left);
  const double right = TruncatedCost(rivals.edges, rivals.right);
  return FindRivalSets(
      rivals.left,
      {{left, rivals.left}, {right, rivals.right}, {right, rivals.right}},
      options, &solver);
}

TEST(RivalSetsTest, FindsTheOtherSet) {
  const std::vector<RivalSets> found = Find(MakeRivals(1., 0));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].only_in_force, ElementsAre(10, 11));
  EXPECT_THAT(found[0].only_in_rival, ElementsAre(12, 13));
  EXPECT_NEAR(found[0].cost_difference, 0., 1e-3);
  EXPECT_GT(found[0].largest_shift, 0.2);
  EXPECT_GT(found[0].deviation, 10.);
  EXPECT_TRUE(found[0].moves_map);
}

TEST(RivalSetsTest, LoopsNearTheGateLeaveTheMapWhereItIs) {
  RivalOptions options;
  options.min_loops = 1;
  options.same_place = 0.001;
  const std::vector<RivalSets> found = Find(MakeRivals(0.166, 25), options);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].only_in_force, ElementsAre(10));
  EXPECT_GT(found[0].largest_shift, options.same_place);
  EXPECT_LT(found[0].deviation, options.same_deviation);
  EXPECT_FALSE(found[0].moves_map);
}

// Well known poses that move by millimetres are no other map, either.
TEST(RivalSetsTest, MillimetresAreNoOtherMap) {
  RivalOptions options;
  options.same_place = 10.;
  const std::vector<RivalSets> found = Find(MakeRivals(1., 0), options);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].moves_map);
}

TEST(RivalSetsTest, DearerSetsAreNoRivals) {
  const Rivals rivals = MakeRivals(1., 0);
  RobustSolver solver(rivals.edges);
  const double cost = TruncatedCost(rivals.edges, rivals.left);
  EXPECT_TRUE(FindRivalSets(rivals.left,
                            {{cost + 1.1 * kChi2Gate, rivals.right}},
                            RivalOptions(), &solver)
                  .empty());
}

// The cost of what was found is that of the usual gate, by which a map that rejects
// more costs less than ours with a wider one.
TEST(RivalSetsTest, CostsAreComparedWithTheSameGate) {
  const Rivals rivals = MakeRivals(1., 0);
  RobustSolver solver(rivals.edges);
  RivalOptions options;
  options.gate = 4. * kChi2Gate;
  const std::vector<RivalSets> found = FindRivalSets(
      rivals.left, {{TruncatedCost(rivals.edges, rivals.right), rivals.right}},
      options, &solver);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].cost_difference, 0., 1e-3);
}

// A circle whose end a loop sees at its beginning, and the line back and forth that
// the same loop makes of it where odometry has turned one turn less.
TEST(RivalSetsTest, TheSameLoopsWoundOtherwiseAreARival) {
  std::vector<PoseGraphEdge> list;
  std::vector<Pose2> circle = {Pose2()};
  const auto add = [&](const int from, const int to) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = to != from + 1;
    if (!edge.is_loop) edge.measurement = Pose2(1., 0., kPi / 40.);
    edge.information = Eigen::Vector3d(100., 100., 2.5).asDiagonal();
    list.push_back(edge);
  };
  for (int i = 0; i != 20; ++i) {
    add(i, i + 1);
    circle.push_back(circle.back() * Pose2(1., 0., kPi / 10.));
  }
  add(0, 20);
  const std::vector<WhitenedEdge> edges = Whiten(list);
  const std::vector<double> all(edges.size(), 1.);
  RobustSolver solver(edges);
  solver.Solve(SolverOptions(), &circle);
  WindingOptions options;
  options.max_chi2 = 30.;
  std::vector<Pose2> other = circle;
  const std::vector<Winding> windings =
      FindWindings(edges, all, circle, options);
  ASSERT_FALSE(windings.empty());
  ASSERT_TRUE(Rewind(edges, all, windings[0].turns, &other));
  solver.Solve(SolverOptions(), &other);
  const std::vector<RivalSets> found =
      FindRivalSets(circle,
                    {{TruncatedCost(edges, circle), circle},
                     {TruncatedCost(edges, other), other}},
                    RivalOptions(), &solver);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].only_in_force.empty());
  EXPECT_TRUE(found[0].moves_map);
  EXPECT_GT(found[0].largest_shift, 1.);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
