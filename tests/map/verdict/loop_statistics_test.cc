// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/loop_statistics.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr io::TimeNs kSecond = 1000000000;

// A run along x, one metre and one second a node: out for ten nodes, a pause of
// 100 s, then the same ten places again. Local poses drift by 0.2 m in y on the
// second pass; the optimised poses are the true ones. Submap 0 stands at the
// local origin and has the first ten nodes.
struct Scene {
  MapGraph graph;
  Trajectory truth;

  Scene() {
    std::vector<StampedPose> poses;
    graph.submaps[{0, 0}].finished = true;
    for (int i = 0; i < 20; ++i) {
      const bool again = i >= 10;
      GraphNode node;
      node.time = (i + (again ? 100 : 0)) * kSecond;
      node.global_pose = Pose2(again ? i - 10 : i, 0., 0.);
      node.global_tracking_pose = ToIsometry(node.global_pose);
      node.local_pose = Pose2(0., again ? 0.2 : 0., 0.) * node.global_pose;
      graph.nodes[{0, i}] = node;
      poses.push_back({node.time, node.global_tracking_pose});
      if (!again) {
        GraphConstraint constraint;
        constraint.node_id = {0, i};
        constraint.relative_pose = node.local_pose;
        graph.constraints.push_back(constraint);
      }
    }
    truth = Trajectory(poses);
  }

  void AddLoop(int node_index, const Pose2& relative_pose) {
    GraphConstraint constraint;
    constraint.node_id = {0, node_index};
    constraint.relative_pose = relative_pose;
    constraint.is_loop = true;
    graph.constraints.push_back(constraint);
  }
};

TEST(LoopStatisticsTest, WithoutTruthOnlyCountsAndResiduals) {
  Scene scene;
  scene.AddLoop(12, Pose2(2., 0.3, 0.));
  scene.AddLoop(13, Pose2(3., 0.1, 0.));
  const LoopStatistics statistics = ComputeLoopStatistics(scene.graph);
  EXPECT_EQ(statistics.accepted, 2);
  EXPECT_EQ(statistics.judged, 0);
  EXPECT_FALSE(statistics.precision.has_value());
  EXPECT_FALSE(statistics.recall.has_value());
  EXPECT_NEAR(statistics.residual_translation.mean, 0.2, 1e-12);
  EXPECT_NEAR(statistics.residual_translation.max, 0.3, 1e-12);
  ASSERT_EQ(statistics.loops.size(), 2u);
  EXPECT_EQ(statistics.loops[0].constraint, 10u);
  EXPECT_EQ(statistics.loops[0].verdict, LoopVerdict::kUnknown);
}

TEST(LoopStatisticsTest, ReferenceTrajectoryTellsRightFromWrong) {
  Scene scene;
  scene.AddLoop(12, Pose2(2., 0.3, 0.));  // 0.3 m off
  scene.AddLoop(13, Pose2(8., 0., 0.));   // five metres off
  scene.AddLoop(14, Pose2(4., 0., 0.5));  // turned by half a radian
  const LoopStatistics statistics =
      ComputeLoopStatistics(scene.graph, scene.truth, LoopStatisticsOptions());
  ASSERT_EQ(statistics.loops.size(), 3u);
  EXPECT_EQ(statistics.judged, 3);
  EXPECT_EQ(statistics.correct, 1);
  EXPECT_EQ(statistics.loops[0].verdict, LoopVerdict::kCorrect);
  EXPECT_NEAR(statistics.loops[0].translation_error, 0.3, 1e-12);
  EXPECT_EQ(statistics.loops[1].verdict, LoopVerdict::kWrong);
  EXPECT_NEAR(statistics.loops[1].translation_error, 5., 1e-12);
  EXPECT_EQ(statistics.loops[2].verdict, LoopVerdict::kWrong);
  EXPECT_NEAR(statistics.loops[2].rotation_error, 0.5, 1e-12);
  ASSERT_TRUE(statistics.precision.has_value());
  EXPECT_NEAR(*statistics.precision, 1. / 3., 1e-12);
  // The second pass is one revisit, and a right loop closes it.
  EXPECT_EQ(statistics.revisits, 1);
  ASSERT_TRUE(statistics.recall.has_value());
  EXPECT_EQ(*statistics.recall, 1.);
}

TEST(LoopStatisticsTest, WrongLoopsCloseNoRevisit) {
  Scene scene;
  scene.AddLoop(13, Pose2(8., 0., 0.));
  const LoopStatistics statistics =
      ComputeLoopStatistics(scene.graph, scene.truth, LoopStatisticsOptions());
  EXPECT_EQ(*statistics.precision, 0.);
  EXPECT_EQ(statistics.revisits, 1);
  EXPECT_EQ(statistics.revisits_closed, 0);
  EXPECT_EQ(*statistics.recall, 0.);
}

TEST(LoopStatisticsTest, ARunWithoutRevisitHasNoRecall) {
  Scene scene;
  LoopStatisticsOptions options;
  options.loop_time_gap = 1000 * kSecond;
  const LoopStatistics statistics =
      ComputeLoopStatistics(scene.graph, scene.truth, options);
  EXPECT_EQ(statistics.revisits, 0);
  EXPECT_FALSE(statistics.recall.has_value());
  EXPECT_FALSE(statistics.precision.has_value());
}

Relation MakeRelation(double seconds1, double seconds2, const Pose2& pose) {
  Relation relation;
  relation.time1 = io::FromSeconds(seconds1);
  relation.time2 = io::FromSeconds(seconds2);
  relation.relative = ToIsometry(pose);
  return relation;
}

TEST(LoopStatisticsTest, RelationsJudgeThroughTheLocalTrajectory) {
  Scene scene;
  scene.AddLoop(12, Pose2(2., 0.1, 0.));
  scene.AddLoop(16, Pose2(0., 0., 0.));
  // Half a second after node 12 (2.5, 0) from half a second after node 3
  // (3.5, 0), given the wrong way round; nothing near node 16.
  const LoopStatistics statistics = ComputeLoopStatistics(
      scene.graph, {MakeRelation(112.5, 3.5, Pose2(1., 0., 0.))},
      LoopStatisticsOptions());
  EXPECT_EQ(statistics.accepted, 2);
  EXPECT_EQ(statistics.judged, 1);
  EXPECT_EQ(statistics.correct, 1);
  EXPECT_NEAR(statistics.loops[0].translation_error, 0.1, 1e-12);
  EXPECT_EQ(statistics.loops[1].verdict, LoopVerdict::kUnknown);
  EXPECT_EQ(statistics.revisits, 1);
  EXPECT_EQ(*statistics.recall, 1.);
}

TEST(LoopStatisticsTest, RelationsOfOtherPlacesSayNothing) {
  Scene scene;
  scene.AddLoop(12, Pose2(2., 0.1, 0.));
  const LoopStatistics statistics = ComputeLoopStatistics(
      scene.graph, {MakeRelation(112., 60., Pose2(1., 0., 0.))},
      LoopStatisticsOptions());
  EXPECT_EQ(statistics.judged, 0);
  EXPECT_FALSE(statistics.precision.has_value());
}

TEST(LoopStatisticsTest, ConstraintsOfMissingNodesAreLeftOut) {
  Scene scene;
  scene.AddLoop(99, Pose2());
  const LoopStatistics statistics =
      ComputeLoopStatistics(scene.graph, scene.truth, LoopStatisticsOptions());
  EXPECT_EQ(statistics.accepted, 0);
  EXPECT_TRUE(statistics.loops.empty());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
