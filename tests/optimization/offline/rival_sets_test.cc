// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/rival_sets.h"

#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gmock/gmock.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using ::testing::ElementsAre;

// A chain of eleven poses and two pairs of loops that contradict each other.
struct Rivals {
  std::vector<WhitenedEdge> edges;
  std::vector<Pose2> left, right;
};

Rivals MakeRivals() {
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
  for (const double side : {1., -1.}) {
    add(0, 10, Pose2(10., side, 0.), 400., true);
    add(1, 9, Pose2(8., 0.8 * side, 0.), 400., true);
  }
  Rivals result;
  result.edges = Whiten(list);
  for (const bool left : {true, false}) {
    SolverOptions options;
    options.edge_weights.assign(14, 1.);
    options.edge_weights[left ? 12 : 10] = 0.;
    options.edge_weights[left ? 13 : 11] = 0.;
    std::vector<Pose2> solved = poses;
    SolveRobust(result.edges, options, &solved);
    (left ? result.left : result.right) = solved;
  }
  return result;
}

TEST(RivalSetsTest, FindsTheOtherSet) {
  const Rivals rivals = MakeRivals();
  const double cost = TruncatedCost(rivals.edges, rivals.left);
  const double other = TruncatedCost(rivals.edges, rivals.right);
  const std::vector<RivalSets> found = FindRivalSets(
      rivals.edges, rivals.left, cost,
      {{cost, rivals.left}, {other, rivals.right}, {other, rivals.right}},
      RivalOptions());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].only_in_force, ElementsAre(10, 11));
  EXPECT_THAT(found[0].only_in_rival, ElementsAre(12, 13));
  EXPECT_NEAR(found[0].cost_difference, 0., 1e-3);
  EXPECT_GT(found[0].largest_shift, 0.2);
}

TEST(RivalSetsTest, DearerSetsAreNoRivals) {
  const Rivals rivals = MakeRivals();
  EXPECT_TRUE(FindRivalSets(rivals.edges, rivals.left, 10.,
                            {{10. + 1.1 * kChi2Gate, rivals.right}},
                            RivalOptions())
                  .empty());
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
