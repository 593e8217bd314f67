// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/pbstream_validation.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/host_ticks.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/pbstream/pbstream_example.h"

namespace cartographer_ext {
namespace io {
namespace {

namespace proto = cartographer::mapping::proto;
using ::testing::ElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

proto::PoseGraph* Graph(Pbstream* const p) { return &p->pose_graph; }
proto::Trajectory* FirstTrajectory(Pbstream* const p) {
  return p->pose_graph.mutable_trajectory(0);
}
proto::Submap2D* SecondSubmap(Pbstream* const p) {
  return p->submaps[1].mutable_submap_2d();
}
proto::TrajectoryNodeData* SecondNode(Pbstream* const p) {
  return p->nodes[1].mutable_node_data();
}

// The change to the example makes just this problem.
void ExpectProblem(const std::function<void(Pbstream*)>& change,
                   const std::string& problem) {
  Pbstream example = ExamplePbstream();
  change(&example);
  EXPECT_THAT(FindPbstreamProblems(example), ElementsAre(problem));
}

TEST(PbstreamValidationTest, TheExampleIsValid) {
  EXPECT_TRUE(FindPbstreamProblems(ExamplePbstream()).empty());
}

TEST(PbstreamValidationTest, StopsAtTheLimit) {
  Pbstream example = ExamplePbstream();
  example.nodes.clear();
  example.submaps.clear();
  EXPECT_EQ(FindPbstreamProblems(example, 2).size(), 2);
  EXPECT_GT(FindPbstreamProblems(example).size(), 2);
}

TEST(PbstreamValidationTest, ProblemsOfPoseGraphs) {
  ExpectProblem(
      [](Pbstream* p) { p->options.add_options_with_sensor_ids(); },
      "the pose graph has 1 trajectories, but there are options for 2");
  ExpectProblem(
      [](Pbstream* p) {
        Graph(p)->add_trajectory();
        p->options.add_options_with_sensor_ids();
      },
      "trajectory 0 is there twice");
  ExpectProblem(
      [](Pbstream* p) {
        Graph(p)->add_trajectory()->set_trajectory_id(-4);
        p->options.add_options_with_sensor_ids();
      },
      "a trajectory has the negative id -4");
  ExpectProblem(
      [](Pbstream* p) {
        FirstTrajectory(p)->mutable_submap()->SwapElements(0, 1);
      },
      "submap (0, 0) of the pose graph is out of order");
  ExpectProblem(
      [](Pbstream* p) {
        FirstTrajectory(p)
            ->mutable_submap(0)
            ->mutable_pose()
            ->mutable_translation()
            ->set_z(kNan);
      },
      "submap (0, 0) has no valid global pose");
  ExpectProblem(
      [](Pbstream* p) { FirstTrajectory(p)->mutable_node(2)->clear_pose(); },
      "node (0, 2) has no valid global pose");
  ExpectProblem(
      [](Pbstream* p) {
        FirstTrajectory(p)->mutable_node(1)->set_timestamp(50);
        SecondNode(p)->set_timestamp(50);
      },
      "node (0, 1) is older than the node before it");
  ExpectProblem(
      [](Pbstream* p) {
        Graph(p)->mutable_constraint(0)->mutable_node_id()->set_node_index(9);
      },
      "constraint 0 refers to node (0, 9), which does not exist");
  ExpectProblem(
      [](Pbstream* p) {
        Graph(p)->mutable_constraint(1)->mutable_submap_id()->set_trajectory_id(
            1);
      },
      "constraint 1 refers to submap (1, 0), which does not exist");
  ExpectProblem(
      [](Pbstream* p) {
        Graph(p)
            ->mutable_constraint(0)
            ->mutable_relative_pose()
            ->mutable_rotation()
            ->set_x(1.);
      },
      "constraint 0 has no valid pose");
  ExpectProblem(
      [](Pbstream* p) {
        Graph(p)->mutable_constraint(2)->set_rotation_weight(-1.);
      },
      "constraint 2 has no valid weights");
  ExpectProblem(
      [](Pbstream* p) {
        Graph(p)->mutable_constraint(0)->set_tag(
            static_cast<
                cartographer::mapping::proto::PoseGraph::Constraint::Tag>(5));
      },
      "constraint 0 has the unknown tag 5");
}

TEST(PbstreamValidationTest, ProblemsOfSubmaps) {
  ExpectProblem([](Pbstream* p) { p->submaps.push_back(p->submaps[0]); },
                "submap (0, 0) is there twice");
  ExpectProblem(
      [](Pbstream* p) {
        p->submaps.push_back(p->submaps[0]);
        p->submaps.back().mutable_submap_id()->set_submap_index(7);
      },
      "submap (0, 7) is not in the pose graph");
  ExpectProblem([](Pbstream* p) { p->submaps[0].clear_submap_2d(); },
                "submap (0, 0) is not a 2D submap");
  ExpectProblem([](Pbstream* p) { SecondSubmap(p)->clear_local_pose(); },
                "submap (0, 1) has no valid local pose");
  ExpectProblem([](Pbstream* p) { SecondSubmap(p)->set_num_range_data(-1); },
                "submap (0, 1) has a negative number of scans");
  ExpectProblem(
      [](Pbstream* p) { SecondSubmap(p)->mutable_grid()->add_cells(1); },
      "submap (0, 1) has 7 cells instead of 2 x 3");
  ExpectProblem(
      [](Pbstream* p) { SecondSubmap(p)->mutable_grid()->set_cells(0, 32768); },
      "submap (0, 1) has a cell with the value 32768");
  ExpectProblem(
      [](Pbstream* p) {
        SecondSubmap(p)->mutable_grid()->mutable_limits()->set_resolution(0.);
      },
      "submap (0, 1) has cells of 0 m");
  ExpectProblem(
      [](Pbstream* p) {
        auto* const limits = SecondSubmap(p)->mutable_grid()->mutable_limits();
        limits->mutable_cell_limits()->set_num_x_cells(1 << 20);
        limits->mutable_cell_limits()->set_num_y_cells(1 << 20);
      },
      "submap (0, 1) has the size 1048576 x 1048576");
  ExpectProblem(
      [](Pbstream* p) {
        SecondSubmap(p)->mutable_grid()->mutable_known_cells_box()->set_max_x(
            2);
      },
      "submap (0, 1) has a box of known cells beyond its limits");
  ExpectProblem(
      [](Pbstream* p) {
        SecondSubmap(p)->mutable_grid()->clear_probability_grid_2d();
      },
      "submap (0, 1) has a grid of unknown type");
  ExpectProblem(
      [](Pbstream* p) {
        SecondSubmap(p)->mutable_grid()->set_min_correspondence_cost(0.95f);
      },
      "submap (0, 1) has correspondence costs between 0.95 and 0.9");
  ExpectProblem(
      [](Pbstream* p) {
        SecondSubmap(p)->mutable_grid()->set_max_correspondence_cost(1.5f);
      },
      "submap (0, 1) has correspondence costs between 0.1 and 1.5");
  ExpectProblem(
      [](Pbstream* p) {
        auto* const tsdf = SecondSubmap(p)->mutable_grid()->mutable_tsdf_2d();
        tsdf->set_truncation_distance(0.3f);
        tsdf->set_max_weight(10.f);
      },
      "submap (0, 1) has 0 weights for 6 cells");
}

TEST(PbstreamValidationTest, ProblemsOfNodes) {
  ExpectProblem([](Pbstream* p) { p->nodes.push_back(p->nodes[0]); },
                "node (0, 0) is there twice");
  ExpectProblem([](Pbstream* p) { SecondNode(p)->set_timestamp(7); },
                "node (0, 1) has another time in the pose graph");
  ExpectProblem(
      [](Pbstream* p) {
        SecondNode(p)->mutable_gravity_alignment()->set_w(kNan);
      },
      "node (0, 1) has no valid gravity alignment");
  ExpectProblem([](Pbstream* p) { SecondNode(p)->clear_local_pose(); },
                "node (0, 1) has no valid local pose");
  for (int broken = 0; broken != 4; ++broken) {
    ExpectProblem(
        [broken](Pbstream* p) {
          auto* cloud =
              SecondNode(p)->mutable_filtered_gravity_aligned_point_cloud();
          if (broken == 0) cloud->set_num_points(3);
          if (broken == 1) cloud->set_point_data(0, 1000);
          if (broken == 2) cloud->set_point_data(1, 1 << 20);
          if (broken == 3) cloud->set_point_data(0, -1);
        },
        "node (0, 1) has a corrupt point cloud");
  }
}

TEST(PbstreamValidationTest, ProblemsOfReadings) {
  ExpectProblem([](Pbstream* p) { p->pose_graph.add_landmark_poses(); },
                "landmark '' has no valid pose");
  ExpectProblem(
      [](Pbstream* p) { p->trajectory_data[0].set_trajectory_id(3); },
      "the data of trajectory 3 is of a trajectory that does not exist");
  ExpectProblem(
      [](Pbstream* p) { p->trajectory_data[0].set_gravity_constant(kNan); },
      "the data of trajectory 0 has no finite gravity");
  ExpectProblem(
      [](Pbstream* p) {
        p->odometry_data[1].mutable_odometry_data()->set_timestamp(90);
      },
      "the odometry reading of trajectory 0 at 90 is out of order");
  ExpectProblem(
      [](Pbstream* p) { p->odometry_data[1].set_trajectory_id(2); },
      "the odometry reading of trajectory 2 at 110 is of a trajectory that "
      "does not exist");
  ExpectProblem(
      [](Pbstream* p) {
        p->odometry_data[0].mutable_odometry_data()->clear_pose();
      },
      "the odometry reading of trajectory 0 at 90 has no valid pose");
  ExpectProblem(
      [](Pbstream* p) {
        p->imu_data[0].mutable_imu_data()->mutable_linear_acceleration()->set_x(
            kNan);
      },
      "the IMU reading of trajectory 0 at 90 is not finite");
  ExpectProblem(
      [](Pbstream* p) {
        p->fixed_frame_pose_data[0]
            .mutable_fixed_frame_pose_data()
            ->mutable_pose();
      },
      "the fixed frame reading of trajectory 0 at 95 has no valid pose");
  ExpectProblem(
      [](Pbstream* p) {
        p->landmark_data[0]
            .mutable_landmark_data()
            ->mutable_landmark_observations(0)
            ->set_rotation_weight(kNan);
      },
      "the landmark reading of trajectory 0 at 96 has no valid pose or "
      "weights");
}

void SetNodeTime(const int index, const int64_t time, Pbstream* const p) {
  FirstTrajectory(p)->mutable_node(index)->set_timestamp(time);
  p->nodes[index].mutable_node_data()->set_timestamp(time);
}

TEST(PbstreamValidationTest, StampsThatNoClockHas) {
  constexpr int64_t kMin = std::numeric_limits<int64_t>::min();
  constexpr int64_t kMax = std::numeric_limits<int64_t>::max();
  const std::string problem = ", which no clock can show";
  for (const int64_t time : {kMin, int64_t{-1}}) {
    ExpectProblem([time](Pbstream* p) { SetNodeTime(0, time, p); },
                  absl::StrCat("node (0, 0) is at ", time, problem));
    ExpectProblem(
        [time](Pbstream* p) {
          p->odometry_data[0].mutable_odometry_data()->set_timestamp(time);
        },
        absl::StrCat("the odometry reading of trajectory 0 at ", time,
                     problem));
  }
  for (const int64_t time : {kMaxHostTicks + 1, kMax}) {
    ExpectProblem([time](Pbstream* p) { SetNodeTime(2, time, p); },
                  absl::StrCat("node (0, 2) is at ", time, problem));
    ExpectProblem(
        [time](Pbstream* p) {
          p->imu_data[1].mutable_imu_data()->set_timestamp(time);
        },
        absl::StrCat("the IMU reading of trajectory 0 at ", time, problem));
    ExpectProblem(
        [time](Pbstream* p) {
          p->fixed_frame_pose_data[0]
              .mutable_fixed_frame_pose_data()
              ->set_timestamp(time);
        },
        absl::StrCat("the fixed frame reading of trajectory 0 at ", time,
                     problem));
    ExpectProblem(
        [time](Pbstream* p) {
          p->landmark_data[0].mutable_landmark_data()->set_timestamp(time);
        },
        absl::StrCat("the landmark reading of trajectory 0 at ", time,
                     problem));
    ExpectProblem(
        [time](Pbstream* p) {
          p->options.mutable_options_with_sensor_ids(0)
              ->mutable_trajectory_builder_options()
              ->mutable_initial_trajectory_pose()
              ->set_timestamp(time);
        },
        absl::StrCat("options 0 have an initial pose at ", time, problem));
  }
}

TEST(PbstreamValidationTest, ClocksMayBeginInTheYear1) {
  Pbstream example = ExamplePbstream();
  SetNodeTime(0, 0, &example);
  SetNodeTime(1, 1, &example);
  SetNodeTime(2, kMaxHostTicks, &example);
  example.odometry_data[0].mutable_odometry_data()->set_timestamp(0);
  EXPECT_THAT(FindPbstreamProblems(example), ElementsAre());
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
