// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/graph/slam_pose_graph.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "cartographer_ext/common/loop_information.h"
#include "cartographer_ext/common/order_statistics.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Standard deviation (metres, radians) that keeps frozen trajectories in place.
constexpr double kFrozenSigma = 1e-4;
// Of loops in Cartographer's configurations, where the graph has no loop.
constexpr double kStockLoopWeight = 1.1e4;

SlamId SubmapOf(const SlamConstraint& constraint) {
  return {constraint.id.submap_trajectory, constraint.id.submap_index};
}

SlamId NodeOf(const SlamConstraint& constraint) {
  return {constraint.id.node_trajectory, constraint.id.node_index};
}

// Factor from relative weights to inverse standard deviations.
double WeightScale(const std::vector<SlamConstraint>& constraints,
                   const double loop_sigma) {
  std::vector<double> weights;
  for (const SlamConstraint& constraint : constraints) {
    if (constraint.is_loop && constraint.translation_weight > 0.) {
      weights.push_back(constraint.translation_weight);
    }
  }
  if (weights.empty()) return 1. / (kStockLoopWeight * loop_sigma);
  return 1. / (UpperMedian(std::move(weights)) * loop_sigma);
}

class Builder {
 public:
  Builder(const SlamGraph& slam, const SlamPoseGraphOptions& options)
      : slam_(slam),
        options_(options),
        scale_(WeightScale(slam.constraints, options.loop_sigma)) {}

  SlamPoseGraph Build() {
    AddVertices();
    const size_t num_edges = slam_.constraints.size() + slam_.nodes.size();
    result_.graph.edges.reserve(num_edges);
    result_.constraint_of_edge.reserve(num_edges);
    AddConstraints();
    AddLocalSlam();
    AddFrozen();
    return std::move(result_);
  }

 private:
  bool HasNode(const SlamId& id) const {
    const auto node = std::lower_bound(
        slam_.nodes.begin(), slam_.nodes.end(), id,
        [](const SlamNode& a, const SlamId& b) { return a.id < b; });
    return node != slam_.nodes.end() && node->id == id;
  }

  // The submaps that each node is the first one of.
  std::map<SlamId, std::vector<SlamId>> SubmapsOfFirstNodes() const {
    std::map<SlamId, SlamId> first_node;
    for (const SlamConstraint& constraint : slam_.constraints) {
      if (constraint.is_loop) continue;
      const SlamId node = NodeOf(constraint);
      if (!HasNode(node)) continue;
      const auto found = first_node.emplace(SubmapOf(constraint), node).first;
      found->second = std::min(found->second, node);
    }
    std::map<SlamId, std::vector<SlamId>> submaps;
    for (const auto& submap_node : first_node) {
      submaps[submap_node.second].push_back(submap_node.first);
    }
    return submaps;
  }

  int AddVertex(const bool is_submap, const int index, const int trajectory_id,
                const Pose2& pose) {
    const int vertex = static_cast<int>(result_.graph.poses.size());
    result_.graph.ids.push_back(vertex);
    result_.graph.poses.push_back(pose);
    SlamPoseGraph::Vertex origin;
    origin.is_submap = is_submap;
    origin.index = index;
    result_.vertices.push_back(origin);
    if (vertex != 0 && slam_.frozen_trajectories.count(trajectory_id) != 0) {
      frozen_.push_back(vertex);
    }
    return vertex;
  }

  void AddSubmap(const int index) {
    const SlamSubmap& submap = slam_.submaps[index];
    if (vertex_of_submap_.count(submap.id) != 0) return;
    vertex_of_submap_[submap.id] =
        AddVertex(true, index, submap.id.first, submap.global_pose);
  }

  void AddVertices() {
    std::map<SlamId, int> index_of_submap;
    for (size_t i = 0; i != slam_.submaps.size(); ++i) {
      index_of_submap.emplace_hint(index_of_submap.end(), slam_.submaps[i].id,
                                   static_cast<int>(i));
    }
    const auto submaps_of_node = SubmapsOfFirstNodes();
    // Cartographer fixes the very first submap.
    if (!slam_.submaps.empty()) AddSubmap(0);
    for (size_t i = 0; i != slam_.nodes.size(); ++i) {
      const SlamNode& node = slam_.nodes[i];
      vertex_of_node_.emplace_hint(vertex_of_node_.end(), node.id,
                                   AddVertex(false, static_cast<int>(i),
                                             node.id.first, node.global_pose));
      const auto of_node = submaps_of_node.find(node.id);
      if (of_node == submaps_of_node.end()) continue;
      for (const SlamId& submap : of_node->second) {
        const auto found = index_of_submap.find(submap);
        if (found != index_of_submap.end()) AddSubmap(found->second);
      }
    }
    for (size_t i = 0; i != slam_.submaps.size(); ++i) {
      AddSubmap(static_cast<int>(i));
    }
  }

  void AddEdge(const PoseGraphEdge& edge, const int constraint) {
    result_.graph.edges.push_back(edge);
    result_.constraint_of_edge.push_back(constraint);
  }

  void AddConstraints() {
    // Constraints of a node mostly follow each other.
    auto node = vertex_of_node_.end();
    for (size_t i = 0; i != slam_.constraints.size(); ++i) {
      const SlamConstraint& constraint = slam_.constraints[i];
      const auto submap = vertex_of_submap_.find(SubmapOf(constraint));
      if (node == vertex_of_node_.end() || node->first != NodeOf(constraint)) {
        node = vertex_of_node_.find(NodeOf(constraint));
      }
      if (submap == vertex_of_submap_.end() || node == vertex_of_node_.end() ||
          !(constraint.translation_weight > 0.) ||
          !(constraint.rotation_weight > 0.)) {
        continue;
      }
      PoseGraphEdge edge;
      edge.from = submap->second;
      edge.to = node->second;
      edge.measurement = constraint.relative_pose;
      edge.information =
          InformationOfWeights(scale_ * constraint.translation_weight,
                               scale_ * constraint.rotation_weight);
      edge.is_loop = constraint.is_loop;
      AddEdge(edge, static_cast<int>(i));
    }
  }

  void AddLocalSlam() {
    if (!(options_.local_slam_translation_weight > 0.) ||
        !(options_.local_slam_rotation_weight > 0.)) {
      return;
    }
    const Eigen::Matrix3d information =
        InformationOfWeights(scale_ * options_.local_slam_translation_weight,
                             scale_ * options_.local_slam_rotation_weight);
    // Nodes and this map have the same order.
    auto vertex = vertex_of_node_.begin();
    for (size_t i = 1; i < slam_.nodes.size(); ++i, ++vertex) {
      const SlamNode& first = slam_.nodes[i - 1];
      const SlamNode& second = slam_.nodes[i];
      if (second.id != SlamId(first.id.first, first.id.second + 1)) continue;
      PoseGraphEdge edge;
      edge.from = vertex->second;
      edge.to = std::next(vertex)->second;
      edge.measurement = Between(first.local_pose, second.local_pose);
      edge.information = information;
      result_.local_slam_edges.push_back(
          static_cast<int>(result_.graph.edges.size()));
      AddEdge(edge, -1);
    }
  }

  void AddFrozen() {
    const std::vector<Pose2>& poses = result_.graph.poses;
    for (const int vertex : frozen_) {
      PoseGraphEdge edge;
      edge.from = 0;
      edge.to = vertex;
      edge.measurement = Between(poses[0], poses[vertex]);
      edge.information =
          InformationOfWeights(1. / kFrozenSigma, 1. / kFrozenSigma);
      AddEdge(edge, -1);
    }
  }

  const SlamGraph& slam_;
  const SlamPoseGraphOptions& options_;
  const double scale_;
  std::map<SlamId, int> vertex_of_submap_, vertex_of_node_;
  std::vector<int> frozen_;
  SlamPoseGraph result_;
};

}  // namespace

SlamPoseGraph MakeSlamPoseGraph(const SlamGraph& slam,
                                const SlamPoseGraphOptions& options) {
  return Builder(slam, options).Build();
}

}  // namespace optimization
}  // namespace cartographer_ext
