// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/wrong_loops.h"

#include "absl/strings/str_cat.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/map/host_map.h"
#include "cartographer_ext/map/pbstream_map.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

namespace mapping = cartographer::mapping;
using cartographer::transform::Embed3D;
using cartographer::transform::Rigid2d;
using cartographer::transform::Rigid3d;

constexpr int kMaxDraws = 1000;
constexpr int kGrowingSubmaps = 2;

Rigid3d ToRigid3d(const Pose2& pose) {
  return Embed3D(Rigid2d(Eigen::Vector2d(pose.x, pose.y), pose.theta));
}

}  // namespace

WrongLoopOptions WithLoopWeights(
    const mapping::proto::MapBuilderOptions& configuration,
    WrongLoopOptions options) {
  const auto& loops =
      configuration.pose_graph_options().constraint_builder_options();
  options.translation_weight = loops.loop_closure_translation_weight();
  options.rotation_weight = loops.loop_closure_rotation_weight();
  return options;
}

absl::StatusOr<GraphConstraint> MakeWrongLoop(const MapGraph& map,
                                              const WrongLoopOptions& options,
                                              Random* const random) {
  std::vector<GraphId> submaps, nodes;
  for (const auto& submap : map.submaps) submaps.push_back(submap.first);
  for (const auto& node : map.nodes) nodes.push_back(node.first);
  const int num_submaps = static_cast<int>(submaps.size()) - kGrowingSubmaps;
  for (int draw = 0; draw != kMaxDraws; ++draw) {
    if (num_submaps < 1 || nodes.empty()) break;
    GraphConstraint loop;
    loop.submap_id = submaps[random->UniformInt(0, num_submaps - 1)];
    loop.node_id = nodes[random->UniformInt(0, nodes.size() - 1)];
    const Pose2& submap = map.submaps.at(loop.submap_id).local_pose;
    const Pose2& node = map.nodes.at(loop.node_id).local_pose;
    if (loop.submap_id.trajectory_id != loop.node_id.trajectory_id ||
        (submap.translation() - node.translation()).norm() <
            options.least_distance) {
      continue;
    }
    // One at a time: the order of evaluation of arguments is not fixed.
    const double x = random->Normal(0., options.translation_sigma);
    const double y = random->Normal(0., options.translation_sigma);
    loop.relative_pose =
        Pose2(x, y, random->Normal(0., options.rotation_sigma));
    loop.translation_weight = options.translation_weight;
    loop.rotation_weight = options.rotation_weight;
    loop.is_loop = true;
    return loop;
  }
  return absl::InvalidArgumentError(absl::StrCat(
      "the map is too small for wrong loops: no submap and node are ",
      options.least_distance, " m apart"));
}

absl::StatusOr<std::vector<int>> AddWrongLoops(const WrongLoopOptions& options,
                                               io::Pbstream* const pbstream) {
  const MapGraph map = MakeMapGraph(*pbstream);
  WrongLoopOptions weighted = options;
  std::vector<double> translation_weights, rotation_weights;
  for (const GraphConstraint& constraint : map.constraints) {
    if (!constraint.is_loop) continue;
    translation_weights.push_back(constraint.translation_weight);
    rotation_weights.push_back(constraint.rotation_weight);
  }
  if (!translation_weights.empty()) {
    weighted.translation_weight = UpperMedian(translation_weights);
    weighted.rotation_weight = UpperMedian(rotation_weights);
  }
  Random random(options.seed);
  std::vector<GraphConstraint> loops;
  for (int k = 0; k < options.count; ++k) {
    const auto loop = MakeWrongLoop(map, weighted, &random);
    if (!loop.ok()) return loop.status();
    loops.push_back(*loop);
  }
  std::vector<int> indices;
  for (const GraphConstraint& loop : loops) {
    indices.push_back(pbstream->pose_graph.constraint_size());
    auto* const proto = pbstream->pose_graph.add_constraint();
    proto->mutable_submap_id()->set_trajectory_id(loop.submap_id.trajectory_id);
    proto->mutable_submap_id()->set_submap_index(loop.submap_id.index);
    proto->mutable_node_id()->set_trajectory_id(loop.node_id.trajectory_id);
    proto->mutable_node_id()->set_node_index(loop.node_id.index);
    *proto->mutable_relative_pose() =
        cartographer::transform::ToProto(ToRigid3d(loop.relative_pose));
    proto->set_translation_weight(loop.translation_weight);
    proto->set_rotation_weight(loop.rotation_weight);
    proto->set_tag(mapping::proto::PoseGraph::Constraint::INTER_SUBMAP);
  }
  return indices;
}

void WrongLoopInjector::AfterScan(
    const int64_t scans, const int64_t total_scans,
    mapping::MapBuilderInterface* const map_builder) {
  const int64_t done = injected_.size();
  if (done >= options_.count ||
      scans * (options_.count + 1) < total_scans * (done + 1)) {
    return;
  }
  auto* const pose_graph =
      dynamic_cast<mapping::PoseGraph*>(map_builder->pose_graph());
  if (pose_graph == nullptr) return;
  const auto loop =
      MakeWrongLoop(MakeMapGraph(*pose_graph), options_, &random_);
  if (!loop.ok()) return;
  const mapping::PoseGraphInterface::Constraint constraint{
      mapping::SubmapId(loop->submap_id.trajectory_id, loop->submap_id.index),
      mapping::NodeId(loop->node_id.trajectory_id, loop->node_id.index),
      {ToRigid3d(loop->relative_pose), loop->translation_weight,
       loop->rotation_weight},
      mapping::PoseGraphInterface::Constraint::INTER_SUBMAP};
  pose_graph->AddSerializedConstraints({constraint});
  injected_.push_back(*loop);
}

}  // namespace evaluation
}  // namespace cartographer_ext
