// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/graph_metrics.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

const std::vector<Pose2> kReference = {Pose2(0., 0., 0.), Pose2(4., 0., 0.),
                                       Pose2(4., 3., 1.), Pose2(0., 3., 2.)};

TEST(GraphMetricsTest, AlignmentRemovesARigidMotion) {
  const Pose2 motion(3., -2., 0.7);
  std::vector<Pose2> moved;
  for (const Pose2& pose : kReference) moved.push_back(motion * pose);
  EXPECT_NEAR(AbsoluteTrajectoryError(moved, kReference), 0., 1e-12);
  const Pose2 back = Align(moved, kReference) * motion;
  EXPECT_NEAR(back.x, 0., 1e-12);
  EXPECT_NEAR(back.y, 0., 1e-12);
  EXPECT_NEAR(back.theta, 0., 1e-12);
}

TEST(GraphMetricsTest, AteOfAHandComputedCase) {
  // Stretched about the centre by 10 %: no motion helps. Every corner is 2.5 m
  // from the centre, so 0.25 m off.
  std::vector<Pose2> stretched = kReference;
  for (Pose2& pose : stretched) {
    pose.x = 2. + 1.1 * (pose.x - 2.);
    pose.y = 1.5 + 1.1 * (pose.y - 1.5);
  }
  EXPECT_NEAR(AbsoluteTrajectoryError(stretched, kReference), 0.25, 1e-12);
  EXPECT_DOUBLE_EQ(AbsoluteTrajectoryError({}, {}), 0.);
}

TEST(GraphMetricsTest, RpeCountsOdometryOnly) {
  std::vector<PoseGraphEdge> edges(3);
  edges[0].from = 0;
  edges[0].to = 1;
  edges[1].from = 1;
  edges[1].to = 2;
  edges[2].from = 0;
  edges[2].to = 3;
  edges[2].is_loop = true;
  std::vector<Pose2> estimate = kReference;
  estimate[1].x += 0.2;  // both odometry edges are 0.2 off
  EXPECT_NEAR(RelativePoseError(edges, estimate, kReference), 0.04, 1e-12);
  estimate = kReference;
  estimate[3].x += 100.;
  EXPECT_DOUBLE_EQ(RelativePoseError(edges, estimate, kReference), 0.);
}

TEST(GraphMetricsTest, ScoresLoops) {
  std::vector<PoseGraphEdge> edges(5);
  for (PoseGraphEdge& edge : edges) edge.is_loop = true;
  // True, kept; true, lost; outliers: rejected; accepted; true by chance.
  edges[0].from = 0, edges[0].to = 1, edges[0].measurement = Pose2(4., 0., 0.);
  edges[1].from = 0, edges[1].to = 3, edges[1].measurement = Pose2(0., 3., 2.);
  edges[2].from = 0, edges[2].to = 2, edges[2].measurement = Pose2(50., 0., 0.);
  edges[3].from = 0, edges[3].to = 3, edges[3].measurement = Pose2(9., 3., 2.);
  edges[4].from = 1, edges[4].to = 2, edges[4].measurement = Pose2(0., 3., 1.);
  std::vector<Pose2> estimate = kReference;
  estimate[3].x = 9.;
  const LoopScore score = ScoreLoops(Whiten(edges), 2, estimate, kReference);
  EXPECT_EQ(score.true_total, 2);
  EXPECT_EQ(score.true_accepted, 1);
  EXPECT_EQ(score.false_accepted, 1);
  EXPECT_EQ(score.accepted, 3);
  EXPECT_DOUBLE_EQ(score.recall, 0.5);
  EXPECT_NEAR(score.precision, 2. / 3., 1e-12);
  // Decided otherwise: both true ones and the first outlier.
  const LoopScore decided = ScoreLoops(
      Whiten(edges), 2, {true, true, true, false, false}, kReference);
  EXPECT_EQ(decided.true_accepted, 2);
  EXPECT_EQ(decided.false_accepted, 1);
  EXPECT_DOUBLE_EQ(decided.recall, 1.);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
