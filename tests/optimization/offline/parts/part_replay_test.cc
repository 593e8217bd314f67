// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/parts/part_replay.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr PartOfPath kFirst = {0, 90};

bool IsIn(const PartOfPath& part, const int pose) {
  return part.begin <= pose && pose < part.end;
}

// The part swung about its last pose, as by wrong loops.
std::vector<Pose2> Swung(std::vector<Pose2> poses, const PartOfPath& part) {
  const Pose2 hinge = poses[part.end - 1];
  const Pose2 motion = hinge * Pose2(0., 0., 1.5) * hinge.Inverse();
  for (int i = part.begin; i != part.end; ++i) poses[i] = motion * poses[i];
  return poses;
}

// The errors of the poses with regard to the first one.
double LargestError(const std::vector<Pose2>& poses,
                    const std::vector<Pose2>& truth) {
  double result = 0.;
  for (size_t i = 0; i != poses.size(); ++i) {
    const Pose2 error =
        Between(Between(truth[0], truth[i]), Between(poses[0], poses[i]));
    result = std::max(result, error.translation().norm());
  }
  return result;
}

// A map of 900 poses whose first 90 ten wrong loops that agree hold in a wrong place,
// where they keep out all right ones that lead out of these. Near the hinge there are
// none that would come in one after the other.
struct LostMap {
  test::GridWorld world;
  std::vector<Pose2> right;
  std::vector<Pose2> lost;
};

LostMap MakeLostMap() {
  LostMap result;
  result.world = test::MakeGridWorld(900, 8, 3);
  PoseGraph& graph = result.world.graph;
  const PartOfPath hinge = {kFirst.end - 20, kFirst.end + 20};
  graph.edges.erase(
      std::remove_if(graph.edges.begin(), graph.edges.end(),
                     [&](const PoseGraphEdge& edge) {
                       return edge.is_loop &&
                              (IsIn(hinge, edge.from) || IsIn(hinge, edge.to));
                     }),
      graph.edges.end());
  std::vector<double> weights;
  for (const PoseGraphEdge& edge : graph.edges) {
    const bool leaves =
        edge.is_loop && IsIn(kFirst, edge.from) != IsIn(kFirst, edge.to);
    weights.push_back(leaves ? 0. : 1.);
  }
  const std::vector<Pose2>& truth = result.world.truth;
  result.right = truth;
  SolveRobust(Whiten(graph.edges), SolverOptions(), &result.right);
  const std::vector<Pose2> swung = Swung(truth, kFirst);
  for (int k = 0; k != 10; ++k) {
    PoseGraphEdge edge = graph.edges.front();
    edge.is_loop = true;
    edge.from = 5 + k;
    edge.to = 500 + k;
    edge.measurement = Between(swung[5 + k], swung[500 + k]);
    graph.edges.push_back(edge);
    weights.push_back(1.);
  }
  SolverOptions options;
  options.edge_weights = weights;
  result.lost = swung;
  SolveRobust(Whiten(graph.edges), options, &result.lost);
  return result;
}

// What leads out of the part leads to the held pose with the same chi2.
TEST(PartReplayTest, ThePartAloneHasTheChi2OfItsEdges) {
  test::GridWorld world = test::MakeGridWorld(200, 3, 1);
  PoseGraph& graph = world.graph;
  const PartOfPath part = {60, 120};
  // Small errors of their own, as conjugation is linear in these only.
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    PoseGraphEdge& edge = graph.edges[i];
    edge.measurement =
        Between(world.truth[edge.from], world.truth[edge.to]) *
        Pose2(1e-5 * (1. + i % 3), -2e-5 * (1. + i % 2), 1e-5 * (1. + i % 5));
    edge.information << 4e10, 1e10, -1e10, 1e10, 9e10, 2e10, -1e10, 2e10, 5e10;
    // Loops are written in both directions.
    if (i % 2 == 0 && edge.is_loop) {
      std::swap(edge.from, edge.to);
      edge.measurement = edge.measurement.Inverse();
    }
  }
  std::vector<double> expected;
  int leaving = 0;
  for (const PoseGraphEdge& edge : graph.edges) {
    if (!IsIn(part, edge.from) && !IsIn(part, edge.to)) continue;
    leaving += edge.is_loop && IsIn(part, edge.from) != IsIn(part, edge.to);
    expected.push_back(
        Chi2(Whiten(edge), world.truth[edge.from], world.truth[edge.to]));
  }
  ASSERT_GT(leaving, 20);
  for (const PartSide side : {PartSide::kBegin, PartSide::kEnd}) {
    const PoseGraph alone = GraphOfPart(graph, world.truth, part, side);
    ASSERT_EQ(alone.poses.size(), 61u);
    ASSERT_TRUE(ValidatePoseGraph(alone).ok());
    ASSERT_EQ(alone.edges.size(), expected.size());
    for (size_t i = 0; i != expected.size(); ++i) {
      const PoseGraphEdge& edge = alone.edges[i];
      EXPECT_NEAR(
          Chi2(Whiten(edge), alone.poses[edge.from], alone.poses[edge.to]),
          expected[i], 5e-3 * expected[i] + 1e-6)
          << i;
    }
  }
}

TEST(PartReplayTest, OnlyTheHeldSideIsTrusted) {
  const test::GridWorld world = test::MakeGridWorld(200, 3, 1);
  for (const PartSide side : {PartSide::kBegin, PartSide::kEnd}) {
    const PoseGraph alone =
        GraphOfPart(world.graph, world.truth, {60, 120}, side);
    int odometry = 0;
    for (const PoseGraphEdge& edge : alone.edges) {
      if (edge.is_loop) continue;
      ++odometry;
      EXPECT_EQ(std::abs(edge.to - edge.from), 1);
    }
    EXPECT_EQ(odometry, 60);
  }
}

TEST(PartReplayTest, PutsAPartBack) {
  const test::GridWorld world = test::MakeGridWorld(300, 4, 2);
  std::vector<Pose2> right = world.truth;
  SolveRobust(Whiten(world.graph.edges), SolverOptions(), &right);
  for (const PartOfPath part :
       {PartOfPath{0, 100}, PartOfPath{100, 180}, PartOfPath{220, 315}}) {
    for (const PartSide side : {PartSide::kBegin, PartSide::kEnd}) {
      PartOfPath swung = part;
      swung.end = std::min(swung.end, 300);
      const std::vector<Pose2> before = Swung(right, swung);
      std::vector<Pose2> poses = before;
      ASSERT_GT(LargestError(poses, right), 2.);
      const bool possible =
          side == PartSide::kBegin ? part.begin > 0 : part.end < 300;
      EXPECT_EQ(ReplayPart(world.graph, part, side, SmootherOptions(), &poses),
                possible);
      EXPECT_EQ(poses[0].x, before[0].x);
      EXPECT_EQ(poses[0].theta, before[0].theta);
      if (possible) {
        EXPECT_LT(LargestError(poses, right), 0.1) << part.begin;
      } else {
        EXPECT_EQ(poses[110].x, before[110].x);
      }
    }
  }
}

TEST(PartReplayTest, BringsAPartBackThatWrongLoopsHold) {
  const LostMap map = MakeLostMap();
  const std::vector<WhitenedEdge> edges = Whiten(map.world.graph.edges);
  RobustSolver solver(edges);
  ASSERT_GT(LargestError(map.lost, map.right), 2.);
  std::vector<Pose2> poses = map.lost;
  // What decides and solves in turn does not find out.
  PolishTruncated(kChi2Gate, kFullPolishRounds, &solver, &poses, nullptr);
  ASSERT_GT(LargestError(poses, map.right), 2.);
  ASSERT_TRUE(
      FindLostPart(edges, DecideLoops(edges, poses, kChi2Gate)).has_value());
  ReplayResult replay;
  replay.poses = poses;
  replay.accepted.assign(edges.size(), true);
  EXPECT_TRUE(
      ReplayLostParts(map.world.graph, SmootherOptions(), &solver, &poses));
  // The map that the right one is polished to.
  std::vector<Pose2> right = map.right;
  PolishTruncated(kChi2Gate, kFullPolishRounds, &solver, &right, nullptr);
  EXPECT_LE(TruncatedCost(edges, poses), TruncatedCost(edges, right) + 1e-6);
  EXPECT_LT(LargestError(poses, right), 0.1);
  SmootherOptions options;
  options.adaptive_gate = false;
  EXPECT_TRUE(ReplayLostParts(map.world.graph, options, &solver, &replay));
  EXPECT_LT(LargestError(replay.poses, right), 0.1);
  const std::vector<double> decisions =
      DecideLoops(edges, replay.poses, kChi2Gate);
  for (size_t i = 0; i != edges.size(); ++i) {
    EXPECT_EQ(replay.accepted[i], decisions[i] > 0.5) << i;
    const bool is_wrong = i + 10 >= edges.size();
    EXPECT_FALSE(is_wrong && replay.accepted[i]) << i;
  }
}

TEST(PartReplayTest, LeavesARightMapAsItIs) {
  const LostMap map = MakeLostMap();
  const std::vector<WhitenedEdge> edges = Whiten(map.world.graph.edges);
  RobustSolver solver(edges);
  std::vector<Pose2> poses = map.right;
  EXPECT_FALSE(
      ReplayLostParts(map.world.graph, SmootherOptions(), &solver, &poses));
  for (size_t i = 0; i != poses.size(); ++i) {
    EXPECT_EQ(poses[i].x, map.right[i].x);
  }
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
