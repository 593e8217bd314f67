// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A small state with something of everything, for tests.
#ifndef TESTS_IO_PBSTREAM_PBSTREAM_EXAMPLE_H_
#define TESTS_IO_PBSTREAM_PBSTREAM_EXAMPLE_H_

#include "cartographer_ext/io/pbstream/pbstream_reader.h"

namespace cartographer_ext {
namespace io {

inline void SetPose(const double x, const double y,
                    cartographer::transform::proto::Rigid3d* const pose) {
  pose->mutable_translation()->set_x(x);
  pose->mutable_translation()->set_y(y);
  pose->mutable_rotation()->set_w(1.);
}

// A submap of 2 x 3 cells.
inline void AddExampleSubmap(const int i, Pbstream* const result) {
  namespace proto = cartographer::mapping::proto;
  proto::Trajectory* const trajectory =
      result->pose_graph.mutable_trajectory(0);
  auto* const global = trajectory->add_submap();
  global->set_submap_index(i);
  SetPose(i, 0.5, global->mutable_pose());

  result->submaps.emplace_back();
  proto::Submap& submap = result->submaps.back();
  submap.mutable_submap_id()->set_submap_index(i);
  proto::Submap2D* const submap_2d = submap.mutable_submap_2d();
  SetPose(i, 0., submap_2d->mutable_local_pose());
  submap_2d->set_num_range_data(90);
  submap_2d->set_finished(i == 0);
  proto::Grid2D* const grid = submap_2d->mutable_grid();
  grid->mutable_limits()->set_resolution(0.05);
  grid->mutable_limits()->mutable_max()->set_x(1.);
  grid->mutable_limits()->mutable_max()->set_y(2.);
  grid->mutable_limits()->mutable_cell_limits()->set_num_x_cells(2);
  grid->mutable_limits()->mutable_cell_limits()->set_num_y_cells(3);
  for (const int cell : {0, 1, 32767, 16000, 0, 5}) grid->add_cells(cell);
  grid->mutable_known_cells_box()->set_max_x(1);
  grid->mutable_known_cells_box()->set_max_y(2);
  grid->mutable_probability_grid_2d();
  grid->set_min_correspondence_cost(0.1f);
  grid->set_max_correspondence_cost(0.9f);
}

// A node at the time 100 + 10 i, in submap i / 2.
inline void AddExampleNode(const int i, Pbstream* const result) {
  namespace proto = cartographer::mapping::proto;
  proto::Trajectory* const trajectory =
      result->pose_graph.mutable_trajectory(0);
  auto* const global = trajectory->add_node();
  global->set_node_index(i);
  global->set_timestamp(100 + 10 * i);
  SetPose(0.1 * i, 0., global->mutable_pose());

  result->nodes.emplace_back();
  proto::Node& node = result->nodes.back();
  node.mutable_node_id()->set_node_index(i);
  proto::TrajectoryNodeData* const data = node.mutable_node_data();
  data->set_timestamp(100 + 10 * i);
  data->mutable_gravity_alignment()->set_w(1.);
  SetPose(0.2 * i, 0., data->mutable_local_pose());
  auto* const cloud = data->mutable_filtered_gravity_aligned_point_cloud();
  cloud->set_num_points(2);
  for (const int value : {2, 0, -1, 0, 5, 7 << 10}) {
    cloud->add_point_data(value);
  }
  data->mutable_high_resolution_point_cloud();
  data->mutable_low_resolution_point_cloud();

  auto* const constraint = result->pose_graph.add_constraint();
  constraint->mutable_node_id()->set_node_index(i);
  constraint->mutable_submap_id()->set_submap_index(i / 2);
  SetPose(0.1, 0.2, constraint->mutable_relative_pose());
  constraint->set_translation_weight(500.);
  constraint->set_rotation_weight(1600.);
  if (i == 1) constraint->set_tag(proto::PoseGraph::Constraint::INTER_SUBMAP);
}

inline void AddExampleReadings(Pbstream* const result) {
  result->trajectory_data.emplace_back();
  result->trajectory_data[0].set_gravity_constant(9.8);
  for (int i = 0; i != 2; ++i) {
    result->odometry_data.emplace_back();
    auto* const odometry = result->odometry_data[i].mutable_odometry_data();
    odometry->set_timestamp(90 + 20 * i);
    SetPose(i, 0., odometry->mutable_pose());
    result->imu_data.emplace_back();
    auto* const imu = result->imu_data[i].mutable_imu_data();
    imu->set_timestamp(90 + 20 * i);
    imu->mutable_linear_acceleration()->set_z(9.8);
    imu->mutable_angular_velocity()->set_z(0.1);
  }
  result->fixed_frame_pose_data.emplace_back();
  result->fixed_frame_pose_data[0]
      .mutable_fixed_frame_pose_data()
      ->set_timestamp(95);
  result->landmark_data.emplace_back();
  auto* const seen = result->landmark_data[0].mutable_landmark_data();
  seen->set_timestamp(96);
  auto* const observation = seen->add_landmark_observations();
  observation->set_id("door");
  SetPose(3., 4., observation->mutable_landmark_to_tracking_transform());
  observation->set_translation_weight(1e3);
  observation->set_rotation_weight(1e2);
}

// One trajectory, two submaps of 2 x 3 cells, three nodes at 100, 110, 120.
inline Pbstream ExamplePbstream() {
  namespace proto = cartographer::mapping::proto;
  Pbstream result;
  result.header.set_format_version(2);
  auto* const options = result.options.add_options_with_sensor_ids();
  auto* const sensor_id = options->add_sensor_id();
  sensor_id->set_type(proto::SensorId::RANGE);
  sensor_id->set_id("scan");
  options->mutable_trajectory_builder_options()
      ->mutable_trajectory_builder_2d_options()
      ->set_max_range(30.f);

  result.pose_graph.add_trajectory();
  for (int i = 0; i != 2; ++i) AddExampleSubmap(i, &result);
  for (int i = 0; i != 3; ++i) AddExampleNode(i, &result);
  auto* const landmark = result.pose_graph.add_landmark_poses();
  landmark->set_landmark_id("door");
  SetPose(1., 2., landmark->mutable_global_pose());
  AddExampleReadings(&result);
  return result;
}

}  // namespace io
}  // namespace cartographer_ext

#endif  // TESTS_IO_PBSTREAM_PBSTREAM_EXAMPLE_H_
