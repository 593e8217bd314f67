// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/motion_disagreement.h"

#include <map>
#include <vector>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/map/host_types.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr io::TimeNs kSecond = 1000000000LL;

void AddNode(const GraphId& id, const io::TimeNs time, const Pose2& local,
             const Pose2& global, MapGraph* const graph) {
  GraphNode& node = graph->nodes[id];
  node.time = time;
  node.local_pose = local;
  node.global_pose = global;
}

// Two nodes a metre and two seconds apart, and a third after a quarter turn on
// the spot; a second trajectory has one node only.
MapGraph ThreeNodes() {
  MapGraph graph;
  AddNode({0, 0}, 10 * kSecond, Pose2(), Pose2(5., 5., 1.), &graph);
  // The map has bent the step by 0.3 m.
  AddNode({0, 1}, 12 * kSecond, Pose2(1., 0., 0.),
          Pose2(5., 5., 1.) * Pose2(1.3, 0., 0.), &graph);
  // And turned the last one by 0.1 rad less.
  AddNode({0, 2}, 13 * kSecond, Pose2(1., 0., kPi / 2.),
          Pose2(5., 5., 1.) * Pose2(1.3, 0., kPi / 2. - 0.1), &graph);
  AddNode({1, 0}, 13 * kSecond, Pose2(), Pose2(), &graph);
  return graph;
}

TEST(MotionDisagreementTest, WithoutOdometryTheMapIsHeldAgainstLocalSlam) {
  const MotionDisagreement result = CompareMotions(ThreeNodes(), {});
  ASSERT_EQ(result.steps.size(), 2u);
  const MotionStep& first = result.steps[0];
  EXPECT_EQ(first.node_id, (GraphId{0, 1}));
  EXPECT_EQ(first.time, 12 * kSecond);
  EXPECT_NEAR(first.seconds, 2., 1e-12);
  EXPECT_NEAR(first.metres, 1., 1e-12);
  EXPECT_NEAR(first.bend_translation, 0.3, 1e-12);
  EXPECT_NEAR(first.bend_rotation, 0., 1e-12);
  EXPECT_FALSE(first.has_odometry);
  EXPECT_NEAR(result.steps[1].metres, 0., 1e-12);
  EXPECT_NEAR(result.steps[1].bend_rotation, 0.1, 1e-12);
  EXPECT_EQ(result.bend_translation.count, 2);
  EXPECT_NEAR(result.bend_translation.mean, 0.15, 1e-12);
  EXPECT_NEAR(result.bend_rotation_degrees.max, RadToDeg(0.1), 1e-9);
  EXPECT_EQ(result.odometry_translation.count, 0);
  EXPECT_TRUE(CompareMotions(MapGraph(), {}).steps.empty());
}

TEST(MotionDisagreementTest, OdometryIsInterpolated) {
  // Readings at 9 s and 12.5 s: 2 m/s along x, in a frame of its own. The node
  // at 13 s is not covered.
  std::map<int, Trajectory> odometry;
  odometry[0] = Trajectory(std::vector<StampedPose>{
      {9 * kSecond, ToIsometry(Pose2(50., 0., 0.))},
      {25 * kSecond / 2, ToIsometry(Pose2(57., 0., 0.))}});
  const MotionDisagreement result = CompareMotions(ThreeNodes(), odometry);
  ASSERT_EQ(result.steps.size(), 2u);
  // Four metres by the wheels, one by local SLAM.
  EXPECT_TRUE(result.steps[0].has_odometry);
  EXPECT_NEAR(result.steps[0].odometry_translation, 3., 1e-9);
  EXPECT_NEAR(result.steps[0].odometry_rotation, 0., 1e-9);
  EXPECT_FALSE(result.steps[1].has_odometry);
  EXPECT_EQ(result.odometry_translation.count, 1);
  EXPECT_NEAR(result.odometry_translation.mean, 3., 1e-9);
  // That of another trajectory says nothing.
  const std::map<int, Trajectory> other = {{1, odometry.at(0)}};
  EXPECT_FALSE(CompareMotions(ThreeNodes(), other).steps[0].has_odometry);
}

// Local SLAM stands still for 60 s, a node each second, in two trajectories;
// the heading of the wheels is a function of the time.
template <typename Heading>
MotionDisagreement Standing(const Heading& heading) {
  MapGraph graph;
  std::map<int, Trajectory> odometry;
  for (const int trajectory_id : {0, 1}) {
    std::vector<StampedPose> readings;
    for (int i = 0; i <= 60; ++i) {
      AddNode({trajectory_id, i}, i * kSecond, Pose2(), Pose2(), &graph);
      readings.push_back(
          {i * kSecond, ToIsometry(Pose2(0., 0., heading(trajectory_id, i)))});
    }
    odometry[trajectory_id] = Trajectory(readings);
  }
  return CompareMotions(graph, odometry);
}

TEST(MotionDisagreementTest, TrimmedNodesLeaveNoStep) {
  // The middle one of three nodes is gone; the wheels did not turn at all.
  std::map<int, Trajectory> odometry;
  odometry[0] = Trajectory(std::vector<StampedPose>{
      {9 * kSecond, ToIsometry(Pose2())}, {14 * kSecond, ToIsometry(Pose2())}});
  MapGraph graph = ThreeNodes();
  AddNode({0, 3}, 14 * kSecond, Pose2(1., 0., kPi / 2.), Pose2(), &graph);
  graph.nodes.erase(GraphId{0, 1});
  const MotionDisagreement result = CompareMotions(graph, odometry);
  ASSERT_EQ(result.steps.size(), 1u);
  EXPECT_EQ(result.steps[0].node_id, (GraphId{0, 3}));
  EXPECT_NEAR(result.steps[0].lasting_rotation, 0., 1e-12);
  EXPECT_EQ(result.bend_translation.count, 1);
  EXPECT_EQ(result.odometry_translation.count, 1);
}

TEST(MotionDisagreementTest, TheLastingTurnEndsAtTrimmedNodes) {
  // By local SLAM a quarter turn before the gap and one behind it, within the
  // seconds that one lasts; by the wheels none.
  MapGraph graph;
  AddNode({0, 0}, 10 * kSecond, Pose2(), Pose2(), &graph);
  AddNode({0, 1}, 11 * kSecond, Pose2(0., 0., kPi / 2.), Pose2(), &graph);
  AddNode({0, 3}, 13 * kSecond, Pose2(0., 0., kPi / 2.), Pose2(), &graph);
  AddNode({0, 4}, 14 * kSecond, Pose2(0., 0., 0.), Pose2(), &graph);
  const std::map<int, Trajectory> odometry = {
      {0, Trajectory(
              std::vector<StampedPose>{{9 * kSecond, ToIsometry(Pose2())},
                                       {15 * kSecond, ToIsometry(Pose2())}})}};
  const MotionDisagreement result = CompareMotions(graph, odometry);
  ASSERT_EQ(result.steps.size(), 2u);
  // What happened in between is unknown, so they do not cancel.
  EXPECT_NEAR(result.steps[0].lasting_rotation, kPi / 2., 1e-12);
  EXPECT_NEAR(result.steps[1].lasting_rotation, kPi / 2., 1e-12);
}

TEST(MotionDisagreementTest, ATurnThatIsCaughtUpWithDoesNotLast) {
  // One reading is off by 0.8 rad; the second trajectory loses a turn.
  const MotionDisagreement result =
      Standing([](const int trajectory_id, const int i) {
        if (trajectory_id == 1) return i < 3 ? 0. : 0.8;
        return i == 20 ? 0.8 : 0.;
      });
  ASSERT_EQ(result.steps.size(), 120u);
  EXPECT_EQ(result.steps[19].node_id, (GraphId{0, 20}));
  EXPECT_NEAR(result.steps[19].odometry_rotation, 0.8, 1e-9);
  EXPECT_NEAR(result.steps[19].lasting_rotation, 0., 1e-9);
  EXPECT_NEAR(result.steps[20].lasting_rotation, 0., 1e-9);
  // Of a step six seconds before, the window ends in between.
  EXPECT_NEAR(result.steps[14].lasting_rotation, 0.8, 1e-9);
  EXPECT_NEAR(result.steps[13].lasting_rotation, 0., 1e-9);
  EXPECT_EQ(result.steps[62].node_id, (GraphId{1, 3}));
  EXPECT_NEAR(result.steps[62].odometry_rotation, 0.8, 1e-9);
  EXPECT_NEAR(result.steps[62].lasting_rotation, 0.8, 1e-9);
  EXPECT_NEAR(result.steps[67].lasting_rotation, 0.8, 1e-9);
  EXPECT_NEAR(result.steps[68].lasting_rotation, 0., 1e-9);
}

TEST(MotionDisagreementTest, ReadsOdometryByTrajectory) {
  io::Pbstream pbstream;
  EXPECT_TRUE(ReadOdometry(pbstream).empty());
  for (const int trajectory_id : {0, 2, 0}) {
    pbstream.odometry_data.emplace_back();
    auto& record = pbstream.odometry_data.back();
    record.set_trajectory_id(trajectory_id);
    // The later one comes first.
    const io::TimeNs time =
        (10 - static_cast<int>(pbstream.odometry_data.size())) * kSecond;
    record.mutable_odometry_data()->set_timestamp(
        cartographer::common::ToUniversal(ToHostTime(time)));
    *record.mutable_odometry_data()->mutable_pose() =
        cartographer::transform::ToProto(
            cartographer::transform::Rigid3d::Translation(
                Eigen::Vector3d(io::ToSeconds(time), 0., 0.)));
  }
  const auto odometry = ReadOdometry(pbstream);
  ASSERT_EQ(odometry.size(), 2u);
  ASSERT_EQ(odometry.at(0).poses().size(), 2u);
  EXPECT_EQ(odometry.at(0).poses()[0].time, 7 * kSecond);
  EXPECT_NEAR(odometry.at(0).poses()[1].pose.translation().x(), 9., 1e-12);
  EXPECT_EQ(odometry.at(2).poses().size(), 1u);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
