// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A stored state small enough to count by hand.
#ifndef TESTS_MAP_SMALL_STATE_H_
#define TESTS_MAP_SMALL_STATE_H_

#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/host_types.h"
#include "tests/map/probability_grid.h"

namespace cartographer_ext {
namespace evaluation {
namespace test {

inline cartographer::transform::proto::Rigid3d PoseProto(double x) {
  cartographer::transform::proto::Rigid3d proto;
  proto.mutable_translation()->set_x(x);
  proto.mutable_rotation()->set_w(1.);
  return proto;
}

// One submap at the origin with three nodes, one metre and one second apart.
inline io::Pbstream SmallState() {
  io::Pbstream state;
  state.header.set_format_version(2);
  auto* const sensors = state.options.add_options_with_sensor_ids();
  sensors->add_sensor_id()->set_id("scan");
  auto* const trajectory = state.pose_graph.add_trajectory();
  auto* const placed = trajectory->add_submap();
  *placed->mutable_pose() = PoseProto(10.);
  state.submaps.emplace_back();
  auto* const submap = state.submaps.back().mutable_submap_2d();
  *submap->mutable_local_pose() = PoseProto(0.);
  submap->set_finished(true);
  submap->set_num_range_data(3);
  *submap->mutable_grid() =
      cartographer_ext::test::ProbabilityGrid(0.05, 1., 0., 1, 1, 1);
  for (int i = 0; i < 3; ++i) {
    const int64_t ticks = cartographer::common::ToUniversal(
        ToHostTime((1000 + i) * 1000000000LL));
    auto* const node = trajectory->add_node();
    node->set_node_index(i);
    node->set_timestamp(ticks);
    *node->mutable_pose() = PoseProto(10. + i);
    state.nodes.emplace_back();
    state.nodes.back().mutable_node_id()->set_node_index(i);
    auto* const data = state.nodes.back().mutable_node_data();
    data->set_timestamp(ticks);
    data->mutable_gravity_alignment()->set_w(1.);
    *data->mutable_local_pose() = PoseProto(i);
    auto* const constraint = state.pose_graph.add_constraint();
    constraint->mutable_submap_id();
    constraint->mutable_node_id()->set_node_index(i);
    *constraint->mutable_relative_pose() = PoseProto(i);
    constraint->set_translation_weight(500.);
    constraint->set_rotation_weight(1600.);
  }
  return state;
}

}  // namespace test
}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // TESTS_MAP_SMALL_STATE_H_
