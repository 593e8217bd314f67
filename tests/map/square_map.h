// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A small finished map without grids: a square of 10 m walked twice, one node a
// metre, a submap begun every ten nodes at its first node and holding twenty.
// Local SLAM turns a little too far at every step, and the global poses are
// those of local SLAM, so that loops have something to do.
#ifndef TESTS_MAP_SQUARE_MAP_H_
#define TESTS_MAP_SQUARE_MAP_H_

#include <cmath>
#include <vector>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/host_types.h"

namespace cartographer_ext {
namespace test {

struct SquareMap {
  static constexpr int kNodes = 80;
  static constexpr int kNodesPerSubmap = 10;
  static constexpr int kNodesPerRound = 40;

  std::vector<Pose2> truth, local;  // of the nodes
  io::Pbstream pbstream;

  SquareMap() {
    Pose2 true_pose, local_pose;
    for (int i = 0; i != kNodes; ++i) {
      truth.push_back(true_pose);
      local.push_back(local_pose);
      const double turn = i % 10 == 9 ? kPi / 2. : 0.;
      true_pose = true_pose * Pose2(1., 0., turn);
      local_pose = local_pose * Pose2(1., 0., turn + 0.001);
    }
    auto* const trajectory = pbstream.pose_graph.add_trajectory();
    for (int i = 0; i != kNodes; ++i) AddNode(i, trajectory);
    for (int i = 0; i != kNodes; ++i) {
      for (int submap : {i / kNodesPerSubmap - 1, i / kNodesPerSubmap}) {
        if (submap < 0) continue;
        Add(submap, i, Origin(local, submap).Inverse() * local[i], false);
      }
    }
  }

  static Pose2 Origin(const std::vector<Pose2>& poses, const int submap) {
    const Pose2& first = poses[submap * kNodesPerSubmap];
    return Pose2(first.x, first.y, 0.);
  }

  void Add(const int submap, const int node, const Pose2& measurement,
           const bool is_loop) {
    auto* const constraint = pbstream.pose_graph.add_constraint();
    constraint->mutable_submap_id()->set_submap_index(submap);
    constraint->mutable_node_id()->set_node_index(node);
    *constraint->mutable_relative_pose() = ToProto(measurement, 0.);
    constraint->set_translation_weight(is_loop ? 1.1e4 : 500.);
    constraint->set_rotation_weight(is_loop ? 1e5 : 1600.);
    constraint->set_tag(
        is_loop
            ? cartographer::mapping::proto::PoseGraph::Constraint::INTER_SUBMAP
            : cartographer::mapping::proto::PoseGraph::Constraint::
                  INTRA_SUBMAP);
  }

  // Eight loops between the rounds.
  void AddRightLoops() {
    for (int node = kNodesPerRound + 2; node < kNodes; node += 5) {
      const int submap = (node - kNodesPerRound) / kNodesPerSubmap;
      Add(submap, node, Origin(truth, submap).Inverse() * truth[node], true);
    }
  }

  static cartographer::transform::proto::Rigid3d ToProto(const Pose2& pose,
                                                         const double height) {
    return cartographer::transform::ToProto(cartographer::transform::Rigid3d(
        Eigen::Vector3d(pose.x, pose.y, height),
        Eigen::AngleAxisd(pose.theta, Eigen::Vector3d::UnitZ()) *
            Eigen::Quaterniond::Identity()));
  }

 private:
  void AddNode(const int i,
               cartographer::mapping::proto::Trajectory* const trajectory) {
    if (i % kNodesPerSubmap == 0) {
      const int index = i / kNodesPerSubmap;
      auto* const submap = trajectory->add_submap();
      submap->set_submap_index(index);
      *submap->mutable_pose() = ToProto(Origin(local, index), 0.);
      pbstream.submaps.emplace_back();
      pbstream.submaps.back().mutable_submap_id()->set_submap_index(index);
      auto* const data = pbstream.submaps.back().mutable_submap_2d();
      *data->mutable_local_pose() = ToProto(Origin(local, index), 0.);
      data->set_finished(true);
    }
    auto* const node = trajectory->add_node();
    node->set_node_index(i);
    node->set_timestamp(cartographer::common::ToUniversal(
        evaluation::ToHostTime((i + 1) * 1000000000LL)));
    *node->mutable_pose() = ToProto(local[i], 0.5);
    pbstream.nodes.emplace_back();
    pbstream.nodes.back().mutable_node_id()->set_node_index(i);
    auto* const data = pbstream.nodes.back().mutable_node_data();
    data->set_timestamp(cartographer::common::ToUniversal(
        evaluation::ToHostTime((i + 1) * 1000000000LL)));
    *data->mutable_gravity_alignment() = ToProto(Pose2(), 0.).rotation();
    *data->mutable_local_pose() = ToProto(local[i], 0.5);
  }
};

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_MAP_SQUARE_MAP_H_
