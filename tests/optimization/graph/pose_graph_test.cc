// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/graph/pose_graph.h"

#include <cmath>
#include <limits>

#include "cartographer_ext/common/random.h"
#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using ::testing::HasSubstr;

PoseGraphEdge MakeEdge(const int from, const int to, const Pose2& measurement) {
  PoseGraphEdge edge;
  edge.from = from;
  edge.to = to;
  edge.measurement = measurement;
  return edge;
}

// A chain of three poses with one loop.
PoseGraph Triangle() {
  PoseGraph graph;
  graph.ids = {10, 11, 12};
  graph.poses = {Pose2(0., 0., 0.), Pose2(1., 0., 0.), Pose2(2., 0., 0.)};
  graph.edges = {MakeEdge(0, 1, Pose2(1., 0., 0.)),
                 MakeEdge(1, 2, Pose2(1., 0., 0.)),
                 MakeEdge(0, 2, Pose2(2., 0., 0.))};
  graph.edges[2].is_loop = true;
  return graph;
}

TEST(PoseGraphTest, LoopsAreWhateverDoesNotLeadToTheNextId) {
  EXPECT_FALSE(IsLoopById(4, 5));
  EXPECT_TRUE(IsLoopById(5, 4));
  EXPECT_TRUE(IsLoopById(4, 6));
  EXPECT_TRUE(IsLoopById(4, 4));
}

std::vector<bool> Loops(const std::vector<int64_t>& ids,
                        const std::vector<std::pair<int, int>>& ends) {
  PoseGraph graph;
  graph.ids = ids;
  graph.poses.resize(ids.size());
  for (const std::pair<int, int>& pair : ends) {
    graph.edges.push_back(MakeEdge(pair.first, pair.second, Pose2()));
    graph.edges.back().is_loop = true;
  }
  MarkLoops(&graph);
  std::vector<bool> result;
  for (const PoseGraphEdge& edge : graph.edges) result.push_back(edge.is_loop);
  return result;
}

TEST(PoseGraphTest, MarksLoopsAlsoWhereIdsHaveGapsOrOdometryLeadsBack) {
  using Flags = std::vector<bool>;
  // By ones, with a loop to the pose before.
  EXPECT_EQ(Loops({3, 4, 5}, {{0, 1}, {1, 2}, {2, 1}, {0, 2}, {1, 2}}),
            (Flags{false, false, true, true, false}));
  // By tens.
  EXPECT_EQ(Loops({0, 10, 20}, {{0, 1}, {1, 2}, {2, 0}}),
            (Flags{false, false, true}));
  // Key frames.
  EXPECT_EQ(Loops({0, 3, 4, 11}, {{0, 1}, {1, 2}, {2, 3}, {0, 3}}),
            (Flags{false, false, false, true}));
  // Written backwards.
  EXPECT_EQ(Loops({0, 1, 2}, {{1, 0}, {2, 1}, {2, 0}}),
            (Flags{false, false, true}));
  // Two robots: what joins them is no odometry.
  EXPECT_EQ(Loops({0, 1, 2, 1000, 1001, 1002},
                  {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}),
            (Flags{false, false, true, false, false}));
  // The widest gap there is.
  const int64_t large = std::numeric_limits<int64_t>::max();
  EXPECT_EQ(Loops({-large - 1, large - 1, large}, {{0, 1}, {1, 2}}),
            (Flags{false, false}));
  EXPECT_TRUE(Loops({7}, {}).empty());
}

TEST(PoseGraphTest, RefusesFixedPosesThatDoNotExist) {
  PoseGraph graph = Triangle();
  graph.fixed = {2};
  EXPECT_TRUE(ValidatePoseGraph(graph).ok());
  graph.fixed = {0, 3};
  EXPECT_FALSE(ValidatePoseGraph(graph).ok());
  graph.fixed = {-1};
  EXPECT_FALSE(ValidatePoseGraph(graph).ok());
}

TEST(PoseGraphTest, ResidualOfHandComputedCase) {
  // From (1, 2) looking along +y, the pose (0, 4, pi) lies 2 ahead, 1 to the
  // left, turned by pi/2. Measured: (1.5, 1, pi/2), so the error before its
  // rotation is (0.5, 0, 0); rotated into the measured end's frame by
  // R(pi/2)' it is (0, -0.5, 0). Information 4 on y gives chi2 = 1.
  PoseGraphEdge edge = MakeEdge(0, 1, Pose2(1.5, 1., kPi / 2.));
  edge.information.diagonal() << 100., 4., 25.;
  const WhitenedEdge whitened = Whiten(edge);
  const Eigen::Vector3d r =
      Residual(whitened, Pose2(1., 2., kPi / 2.), Pose2(0., 4., kPi));
  EXPECT_NEAR(r.x(), 0., 1e-12);
  EXPECT_NEAR(r.y(), -1., 1e-12);
  EXPECT_NEAR(r.z(), 0., 1e-12);
  // Without the metric: 0.5^2.
  EXPECT_NEAR(UnwhitenedSquaredNorm(whitened, r), 0.25, 1e-12);
}

TEST(PoseGraphTest, AnglesWrap) {
  const WhitenedEdge edge = Whiten(MakeEdge(0, 1, Pose2(0., 0., 3.1)));
  const Eigen::Vector3d r = Residual(edge, Pose2(), Pose2(0., 0., -3.1));
  EXPECT_NEAR(r.z(), 2. * kPi - 6.2, 1e-12);
}

TEST(PoseGraphTest, Chi2UsesTheFullInformationMatrix) {
  PoseGraphEdge edge = MakeEdge(0, 1, Pose2());
  edge.information << 4., 1., 0., 1., 3., 0.5, 0., 0.5, 2.;
  const Eigen::Vector3d error(0.3, -0.2, 0.1);
  EXPECT_NEAR(
      Chi2(Whiten(edge), Pose2(), Pose2(error.x(), error.y(), error.z())),
      error.dot(edge.information * error), 1e-12);
}

TEST(PoseGraphTest, JacobiansAgreeWithDifferences) {
  Random random(3);
  for (int trial = 0; trial != 20; ++trial) {
    PoseGraphEdge edge = MakeEdge(
        0, 1, Pose2(random.Normal(), random.Normal(), random.Uniform(-3., 3.)));
    Eigen::Matrix3d root;
    for (int i = 0; i != 9; ++i) root(i) = random.Normal();
    edge.information =
        root * root.transpose() + 0.1 * Eigen::Matrix3d::Identity();
    const WhitenedEdge whitened = Whiten(edge);
    Pose2 ends[2] = {
        Pose2(random.Normal(), random.Normal(), random.Uniform(-3., 3.)),
        Pose2(random.Normal(), random.Normal(), random.Uniform(-3., 3.))};
    Eigen::Matrix3d analytic[2];
    const Eigen::Vector3d r =
        Linearize(whitened, ends[0], ends[1], &analytic[0], &analytic[1]);
    EXPECT_LT((r - Residual(whitened, ends[0], ends[1])).norm(), 1e-12);
    if (std::abs(std::abs(NormalizeAngle(ends[1].theta - ends[0].theta -
                                         edge.measurement.theta)) -
                 kPi) < 0.01) {
      continue;  // differences do not exist at the cut
    }
    constexpr double kStep = 1e-6;
    for (int end = 0; end != 2; ++end) {
      for (int k = 0; k != 3; ++k) {
        Eigen::Vector3d values[2];
        for (int side = 0; side != 2; ++side) {
          Pose2 moved[2] = {ends[0], ends[1]};
          const double step = side == 0 ? -kStep : kStep;
          (k == 0   ? moved[end].x
           : k == 1 ? moved[end].y
                    : moved[end].theta) += step;
          values[side] = Residual(whitened, moved[0], moved[1]);
        }
        const Eigen::Vector3d numeric = (values[1] - values[0]) / (2. * kStep);
        EXPECT_LT((numeric - analytic[end].col(k)).norm(),
                  1e-6 * (1. + numeric.norm()));
      }
    }
  }
}

TEST(PoseGraphTest, DeadReckoningFollowsOdometryBothWays) {
  PoseGraph graph = Triangle();
  graph.edges[1] = MakeEdge(2, 1, Pose2(0., 1., kPi / 2.).Inverse());
  const std::vector<Pose2> poses = DeadReckoning(graph);
  EXPECT_NEAR(poses[1].x, 1., 1e-12);
  EXPECT_NEAR(poses[2].x, 1., 1e-12);
  EXPECT_NEAR(poses[2].y, 1., 1e-12);
  EXPECT_NEAR(poses[2].theta, kPi / 2., 1e-12);
}

TEST(PoseGraphTest, ValidGraphPasses) {
  EXPECT_TRUE(ValidatePoseGraph(Triangle()).ok());
  EXPECT_TRUE(ValidatePoseGraph(test::MakeGridWorld(100, 5, 1).graph).ok());
}

TEST(PoseGraphTest, ErrorsNameTheCulprit) {
  const auto message = [](const PoseGraph& graph) {
    return std::string(ValidatePoseGraph(graph).message());
  };
  EXPECT_THAT(message(PoseGraph()), HasSubstr("no vertices"));

  PoseGraph graph = Triangle();
  graph.ids[2] = 10;
  EXPECT_THAT(message(graph), HasSubstr("vertex 10 appears twice"));

  graph = Triangle();
  graph.ids.pop_back();
  EXPECT_THAT(message(graph), HasSubstr("2 ids"));

  graph = Triangle();
  graph.poses[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message(graph), HasSubstr("vertex 11"));

  graph = Triangle();
  graph.edges[2].to = 3;
  EXPECT_THAT(message(graph), HasSubstr("does not exist"));

  graph = Triangle();
  graph.edges[1].to = 1;
  EXPECT_THAT(message(graph), HasSubstr("to itself"));

  graph = Triangle();
  graph.edges[1].measurement.theta = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message(graph), HasSubstr("edge 1 (11 -> 12)"));

  graph = Triangle();
  graph.edges[0].information(2, 2) = 0.;
  EXPECT_THAT(message(graph), HasSubstr("not positive definite"));

  graph = Triangle();
  graph.edges[0].information(0, 0) = -1.;
  EXPECT_THAT(message(graph), HasSubstr("not positive definite"));

  graph = Triangle();
  graph.edges[0].information(0, 1) = 0.5;
  EXPECT_THAT(message(graph), HasSubstr("not symmetric"));

  graph = Triangle();
  graph.edges.resize(1);
  EXPECT_THAT(message(graph), HasSubstr("vertex 12 cannot be reached"));
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
