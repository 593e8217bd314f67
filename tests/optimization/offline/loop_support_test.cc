// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/loop_support.h"

#include "Eigen/LU"
#include "cartographer_ext/optimization/offline/noise_scale.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"
#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

// Two straight passes over the same 20 poses.
PoseGraph TwoPasses() {
  PoseGraph graph;
  for (int i = 0; i != 40; ++i) {
    graph.ids.push_back(i);
    graph.poses.push_back(Pose2(i % 20, 0., 0.));
  }
  for (int i = 1; i != 40; ++i) {
    PoseGraphEdge edge;
    edge.from = i - 1;
    edge.to = i;
    // The path back was driven in one step.
    edge.measurement = Pose2(i == 20 ? -19. : 1., 0., 0.);
    edge.information = 100. * Eigen::Matrix3d::Identity();
    graph.edges.push_back(edge);
  }
  return graph;
}

int AddLoop(const int from, const int to, const Pose2& measurement,
            PoseGraph* const graph) {
  PoseGraphEdge edge;
  edge.from = from;
  edge.to = to;
  edge.measurement = measurement;
  edge.information = 100. * Eigen::Matrix3d::Identity();
  edge.is_loop = true;
  graph->edges.push_back(edge);
  return graph->edges.size() - 1;
}

TEST(LoopSupportTest, NeighboursThatAgreeFormAGroup) {
  PoseGraph graph = TwoPasses();
  const int a = AddLoop(3, 23, Pose2(), &graph);
  // Written the other way round.
  const int b = AddLoop(26, 5, Pose2(-1., 0., 0.), &graph);
  const int wrong = AddLoop(4, 24, Pose2(3., 0., 0.), &graph);
  const int far = AddLoop(2, 39, Pose2(17., 0., 0.), &graph);
  LoopSupportOptions options;
  options.window = 5;
  const LoopSupport support = FindLoopSupport(graph, options);
  EXPECT_THAT(support.agreeing[a], ElementsAre(b));
  EXPECT_THAT(support.agreeing[b], ElementsAre(a));
  EXPECT_THAT(support.agreeing[wrong], IsEmpty());
  EXPECT_EQ(support.group[a], support.group[b]);
  EXPECT_NE(support.group[a], support.group[wrong]);
  EXPECT_NE(support.group[a], support.group[far]);
  EXPECT_EQ(support.group[0], -1);
  EXPECT_EQ(support.groups.size(), 3u);
  EXPECT_THAT(support.groups[support.group[a]], UnorderedElementsAre(a, b));
}

TEST(LoopSupportTest, ChiSquareOfCyclesIsHonest) {
  Random random(7);
  double sum = 0.;
  int count = 0;
  for (int trial = 0; trial != 400; ++trial) {
    PoseGraph graph = TwoPasses();
    AddLoop(3, 23, Pose2(), &graph);
    AddLoop(8, 29, Pose2(1., 0., 0.), &graph);
    for (PoseGraphEdge& edge : graph.edges) {
      edge.information = 1e4 * Eigen::Matrix3d::Identity();
      edge.measurement = edge.measurement * Pose2(random.Normal(0., 0.01),
                                                  random.Normal(0., 0.01),
                                                  random.Normal(0., 0.01));
    }
    for (const double chi2 :
         FindLoopSupport(graph, LoopSupportOptions()).cycle_chi2) {
      sum += chi2;
      ++count;
    }
  }
  ASSERT_EQ(count, 400);
  EXPECT_NEAR(sum / count, 3., 0.4);
}

// What is kept of the paths costs memory and saves time.
TEST(LoopSupportTest, IsTheSameHoweverManyPathsAreKept) {
  test::GridWorld world = test::MakeGridWorld(300, 8, 3);
  test::AddOutliers(test::Outliers(200, OutlierType::kLocalGrouped),
                    &world.graph);
  const LoopSupport support =
      FindLoopSupport(world.graph, LoopSupportOptions());
  ASSERT_GT(support.cycle_chi2.size(), 500u);
  ASSERT_LT(support.groups.size(), support.cycle_chi2.size());
  for (const int max_paths : {0, 1, 7}) {
    LoopSupportOptions options;
    options.max_paths = max_paths;
    const LoopSupport other = FindLoopSupport(world.graph, options);
    EXPECT_EQ(other.cycle_chi2, support.cycle_chi2);
    EXPECT_EQ(other.agreeing, support.agreeing);
    EXPECT_EQ(other.groups, support.groups);
  }
}

// The same as by the composition of uncertain poses.
TEST(LoopSupportTest, ChiSquareIsThatOfUncertainPoses) {
  using uncertainty::Compose;
  using uncertainty::Invert;
  using uncertainty::UncertainPose;
  const auto pose = [](const PoseGraphEdge& edge) -> UncertainPose {
    return {edge.measurement, edge.information.inverse()};
  };
  Random random(3);
  PoseGraph graph = TwoPasses();
  const int a = AddLoop(3, 23, Pose2(0.1, -0.2, 0.7), &graph);
  const int b = AddLoop(25, 4, Pose2(-1., 0.3, -2.9), &graph);
  for (PoseGraphEdge& edge : graph.edges) {
    const Eigen::Matrix3d root =
        Eigen::Matrix3d::NullaryExpr([&] { return random.Normal(0., 1.); });
    edge.information = root * root.transpose() + Eigen::Matrix3d::Identity();
    edge.measurement = edge.measurement * Pose2(0.3, random.Normal(0., 0.2),
                                                random.Normal(0., 0.5));
  }
  const UncertainPose late =
      Compose(pose(graph.edges[23]), pose(graph.edges[24]));
  const UncertainPose cycle = Compose(
      Compose(Compose(pose(graph.edges[a]), late), pose(graph.edges[b])),
      Invert(pose(graph.edges[3])));
  const Eigen::Vector3d error(cycle.pose.x, cycle.pose.y, cycle.pose.theta);
  const LoopSupport support = FindLoopSupport(graph, LoopSupportOptions());
  ASSERT_EQ(support.cycle_chi2.size(), 1u);
  const double expected = error.dot(cycle.covariance.inverse() * error);
  EXPECT_NEAR(support.cycle_chi2[0], expected, 1e-9 * expected);
  // The parts of its covariance grow with the noise of either kind.
  const auto cycles = FindLoopCycles(graph, LoopSupportOptions());
  ASSERT_EQ(cycles.size(), 1u);
  EXPECT_LT((cycles[0].error - error).norm(), 1e-9);
  EXPECT_LT(
      (cycles[0].of_loops + cycles[0].of_odometry - cycle.covariance).norm(),
      1e-9 * cycle.covariance.norm());
  const auto scaled =
      FindLoopCycles(WithNoiseScale(graph, 2., 3.), LoopSupportOptions());
  EXPECT_LT((scaled[0].of_odometry - 4. * cycles[0].of_odometry).norm(),
            1e-9 * scaled[0].of_odometry.norm());
  EXPECT_LT((scaled[0].of_loops - 9. * cycles[0].of_loops).norm(),
            1e-9 * scaled[0].of_loops.norm());
}

TEST(LoopSupportTest, NoAgreementAcrossAGapOfOdometry) {
  PoseGraph graph = TwoPasses();
  const int a = AddLoop(3, 23, Pose2(), &graph);
  AddLoop(6, 26, Pose2(), &graph);
  graph.edges.erase(graph.edges.begin() + 3);  // 3 -> 4
  const LoopSupport support = FindLoopSupport(graph, LoopSupportOptions());
  EXPECT_THAT(support.agreeing[a - 1], IsEmpty());
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
