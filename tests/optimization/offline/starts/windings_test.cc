// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/starts/windings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "Eigen/Cholesky"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gmock/gmock.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr double kTurn = 2. * kPi;
constexpr double kLoopSigma = 0.05;

// A circle of thirty poses driven three times without noise, with the headings of
// odometry known to `sigma`, and loops.
struct Circle {
  explicit Circle(const double sigma) {
    for (int i = 0; i != 90; ++i) {
      poses.push_back(i == 0 ? Pose2()
                             : poses.back() * Pose2(1., 0., kTurn / 30.));
    }
    for (int i = 1; i != 90; ++i) Add(i - 1, i, sigma, false);
    for (const std::vector<int>& ends :
         {std::vector<int>{0, 30}, {5, 65}, {40, 70}, {12, 42}}) {
      Add(ends[0], ends[1], kLoopSigma, true);
    }
    edges = Whiten(graph);
    in_force.assign(edges.size(), 1.);
  }

  void Add(const int from, const int to, const double sigma,
           const bool is_loop) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = is_loop;
    edge.measurement = Between(poses[from], poses[to]);
    edge.information =
        Eigen::Vector3d(100., 100., 1. / Squared(sigma)).asDiagonal();
    graph.push_back(edge);
  }

  std::vector<PoseGraphEdge> graph;
  std::vector<WhitenedEdge> edges;
  std::vector<double> in_force;
  std::vector<Pose2> poses;
};

// Least chi2 of the headings with these turns of the four loops, from the lengths of
// path that they share.
double BruteForce(const Circle& circle, const double sigma,
                  const std::vector<int>& turns) {
  const int first = 89;
  Eigen::Matrix4d covariance;
  Eigen::Vector4d errors;
  for (int i = 0; i != 4; ++i) {
    const PoseGraphEdge& a = circle.graph[first + i];
    errors[i] = kTurn * turns[i];
    for (int j = 0; j != 4; ++j) {
      const PoseGraphEdge& b = circle.graph[first + j];
      const int shared = std::min(a.to, b.to) - std::max(a.from, b.from);
      covariance(i, j) = std::max(0, shared) * Squared(sigma) +
                         (i == j ? Squared(kLoopSigma) : 0.);
    }
  }
  return errors.dot(covariance.llt().solve(errors));
}

TEST(WindingsTest, FindsAllWithinTheLimit) {
  constexpr double kSigma = 0.4, kLimit = 40.;
  const Circle circle(kSigma);
  std::map<std::vector<int>, double> expected;
  for (int n = 0; n != 7 * 7 * 7 * 7; ++n) {
    const std::vector<int> turns = {n % 7 - 3, n / 7 % 7 - 3, n / 49 % 7 - 3,
                                    n / 343 - 3};
    const double chi2 = BruteForce(circle, kSigma, turns);
    if (n != 1200 && chi2 <= kLimit) expected[turns] = chi2;
  }
  ASSERT_GE(expected.size(), 10u);
  WindingOptions options;
  options.max_chi2 = kLimit;
  options.max_windings = 1000;
  const std::vector<Winding> found =
      FindWindings(circle.edges, circle.in_force, circle.poses, options);
  EXPECT_EQ(found.size(), expected.size());
  double last = 0.;
  for (const Winding& winding : found) {
    const std::vector<int> turns(winding.turns.end() - 4, winding.turns.end());
    ASSERT_EQ(expected.count(turns), 1u);
    EXPECT_NEAR(winding.chi2, expected[turns], 1e-9);
    EXPECT_GE(winding.chi2, last);
    last = winding.chi2;
  }
}

TEST(WindingsTest, ThereAreNoneWhereOdometryTellsTheHeading) {
  const Circle circle(0.05);
  WindingOptions options;
  options.max_chi2 = 100.;
  EXPECT_TRUE(FindWindings(circle.edges, circle.in_force, circle.poses, options)
                  .empty());
}

TEST(WindingsTest, TurnsOfTheOtherLoopsFollow) {
  Circle circle(0.4);
  for (int i = 0; i != 20; ++i) circle.Add(i, i + 30, kLoopSigma, true);
  circle.edges = Whiten(circle.graph);
  circle.in_force.assign(circle.edges.size(), 1.);
  WindingOptions options;
  options.max_chi2 = 60.;
  options.max_windings = options.max_choices = 10000;
  const std::vector<Winding> all =
      FindWindings(circle.edges, circle.in_force, circle.poses, options);
  options.max_loops = 6;
  options.max_windings = 2;
  const std::vector<Winding> some =
      FindWindings(circle.edges, circle.in_force, circle.poses, options);
  ASSERT_FALSE(some.empty());
  for (const Winding& winding : some) {
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Winding& other) {
      return other.turns == winding.turns;
    }));
  }
}

// A loop that joins what odometry does not may be turned as a whole.
TEST(WindingsTest, ALoopThatJoinsTrajectoriesHasNoOther) {
  Circle circle(0.4);
  circle.graph.erase(circle.graph.begin() + 89, circle.graph.end());
  circle.graph.erase(circle.graph.begin() + 50);  // odometry from 50 to 51
  circle.Add(25, 80, kLoopSigma, true);
  circle.edges = Whiten(circle.graph);
  circle.in_force.assign(circle.edges.size(), 1.);
  WindingOptions options;
  options.max_chi2 = 1e3;
  EXPECT_TRUE(FindWindings(circle.edges, circle.in_force, circle.poses, options)
                  .empty());
  circle.in_force.back() = 0.;  // nothing joins them
  EXPECT_TRUE(FindWindings(circle.edges, circle.in_force, circle.poses, options)
                  .empty());
}

TEST(WindingsTest, ASinglePoseHasNone) {
  std::vector<Pose2> poses(1);
  EXPECT_TRUE(FindWindings({}, {}, poses, WindingOptions()).empty());
  EXPECT_FALSE(Rewind({}, {}, {}, &poses));
}

TEST(WindingsTest, LeadsToAnotherMinimumAndBack) {
  const Circle circle(0.4);
  WindingOptions options;
  options.max_chi2 = 30.;
  const std::vector<Winding> windings =
      FindWindings(circle.edges, circle.in_force, circle.poses, options);
  ASSERT_FALSE(windings.empty());
  std::vector<Pose2> poses = circle.poses;
  ASSERT_TRUE(Rewind(circle.edges, circle.in_force, windings[0].turns, &poses));
  RobustSolver solver(circle.edges);
  const double cost = solver.Solve(SolverOptions(), &poses).final_cost;
  EXPECT_GT(cost, windings[0].chi2);
  EXPECT_FALSE(
      HaveSameWinding(circle.edges, circle.in_force, circle.poses, poses));
  options.max_chi2 = cost;
  double lowest = cost;
  for (const Winding& winding :
       FindWindings(circle.edges, circle.in_force, poses, options)) {
    std::vector<Pose2> back = poses;
    ASSERT_TRUE(Rewind(circle.edges, circle.in_force, winding.turns, &back));
    const double again = solver.Solve(SolverOptions(), &back).final_cost;
    if (again >= lowest) continue;
    lowest = again;
    if (again > 1e-6) continue;
    EXPECT_LT(AbsoluteTrajectoryError(back, circle.poses), 1e-3);
    EXPECT_TRUE(
        HaveSameWinding(circle.edges, circle.in_force, circle.poses, back));
  }
  EXPECT_LT(lowest, 1e-6);
}

TEST(WindingsTest, MapsNearEachOtherHaveTheSame) {
  const Circle circle(0.4);
  Random random(1);
  std::vector<Pose2> poses = circle.poses;
  for (size_t i = 1; i != poses.size(); ++i) {
    poses[i] = Pose2(0., 0., 3.) * poses[i] *
               Pose2(0.1, 0.2, random.Uniform(-0.5, 0.5));
    poses[i].theta = NormalizeAngle(poses[i].theta);
  }
  poses[0] = Pose2(0., 0., 3.);
  EXPECT_TRUE(
      HaveSameWinding(circle.edges, circle.in_force, circle.poses, poses));
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
