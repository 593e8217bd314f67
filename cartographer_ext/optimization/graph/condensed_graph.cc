// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/graph/condensed_graph.h"

#include <algorithm>
#include <utility>

#include "Eigen/LU"
#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/optimization/solvers/block_ldlt.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using uncertainty::UncertainPose;

// The information of an edge and the covariance of an uncertain pose are both
// in the frame of the measured end.
Eigen::Matrix3d Inverse(const Eigen::Matrix3d& matrix) {
  Eigen::Matrix3d inverse;
  if (!InvertSpd(matrix, &inverse)) inverse = matrix.inverse();
  return inverse;
}

UncertainPose ToUncertainPose(const PoseGraphEdge& edge) {
  UncertainPose pose;
  pose.pose = edge.measurement;
  pose.covariance = Inverse(edge.information);
  return pose;
}

void SetMeasurement(const UncertainPose& pose, PoseGraphEdge* const edge) {
  edge->measurement = pose.pose;
  edge->information = Symmetric(Inverse(pose.covariance));
}

// Joins `edge` to `sum`, which goes between the same poses.
void Merge(const PoseGraphEdge& edge, PoseGraphEdge* const sum) {
  const Pose2 difference = Between(sum->measurement, edge.measurement);
  const Eigen::Matrix3d information = sum->information + edge.information;
  Eigen::Matrix3d covariance;
  if (!InvertSpd(information, &covariance)) return;
  const Eigen::Vector3d shift =
      covariance *
      (edge.information *
       Eigen::Vector3d(difference.x, difference.y, difference.theta));
  sum->measurement = sum->measurement * Pose2(shift.x(), shift.y(), shift.z());
  sum->information = information;
}

class Condenser {
 public:
  Condenser(const PoseGraph& graph, const std::vector<int>& neighbours)
      : graph_(graph),
        next_(graph.poses.size(), -1),
        previous_(graph.poses.size(), -1),
        is_neighbour_(graph.edges.size(), false),
        anchor_(graph.poses.size()),
        paths_(graph.poses.size()) {
    for (const int i : neighbours) {
      const PoseGraphEdge& edge = graph.edges[i];
      is_neighbour_[i] = true;
      CHECK_LT(edge.from, edge.to);
      CHECK_LT(next_[edge.from], 0);
      CHECK_LT(previous_[edge.to], 0);
      next_[edge.from] = i;
      previous_[edge.to] = i;
    }
  }

  CondensedGraph Run(const int max_steps) {
    ChooseVertices(max_steps);
    AddChain();
    AddOthers();
    return std::move(result_);
  }

 private:
  void ChooseVertices(const int max_steps) {
    const int size = graph_.poses.size();
    std::vector<bool> kept(size);
    for (int v = 0; v != size; ++v) {
      kept[v] = v == 0 || next_[v] < 0 || previous_[v] < 0;
    }
    for (const PoseGraphEdge& edge : graph_.edges) {
      if (edge.is_loop) kept[edge.from] = kept[edge.to] = true;
    }
    for (int start = 0; start != size; ++start) {
      if (!kept[start]) continue;
      int steps = 0;
      for (int v = start; next_[v] >= 0;) {
        v = graph_.edges[next_[v]].to;
        if (kept[v]) break;
        if (++steps >= max_steps) {
          kept[v] = true;
          steps = 0;
        }
      }
    }
    vertex_.assign(size, -1);
    for (int v = 0; v != size; ++v) {
      if (!kept[v]) continue;
      vertex_[v] = result_.pose_of_vertex.size();
      result_.pose_of_vertex.push_back(v);
      result_.graph.ids.push_back(graph_.ids[v]);
      result_.graph.poses.push_back(graph_.poses[v]);
    }
  }

  void AddEdge(const PoseGraphEdge& edge, const int loop) {
    result_.graph.edges.push_back(edge);
    result_.loop_of_edge.push_back(loop);
  }

  // Walks each stretch and composes the path from its first pose to each.
  void AddChain() {
    for (const int start : result_.pose_of_vertex) {
      anchor_[start] = start;
      UncertainPose path;
      int steps = 0;
      for (int v = start; next_[v] >= 0;) {
        const PoseGraphEdge& step = graph_.edges[next_[v]];
        path = steps == 0 ? ToUncertainPose(step)
                          : Compose(path, ToUncertainPose(step));
        ++steps;
        v = step.to;
        if (vertex_[v] < 0) {
          anchor_[v] = start;
          paths_[v] = path;
          continue;
        }
        PoseGraphEdge edge = step;
        edge.from = vertex_[start];
        edge.to = vertex_[v];
        if (steps > 1) SetMeasurement(path, &edge);
        result_.chain.push_back(result_.graph.edges.size());
        result_.chain_steps.push_back(steps);
        AddEdge(edge, -1);
        break;
      }
    }
  }

  void AddOthers() {
    // By the poses that they join.
    using Key = std::pair<std::pair<int, int>, int>;  // and number of the edge
    std::vector<Key> keys;
    std::vector<PoseGraphEdge> trusted;
    trusted.reserve(graph_.edges.size());
    for (size_t i = 0; i != graph_.edges.size(); ++i) {
      if (is_neighbour_[i]) continue;
      PoseGraphEdge edge = graph_.edges[i];
      const int from = anchor_[edge.from], to = anchor_[edge.to];
      if (from != edge.from || to != edge.to) {
        UncertainPose path = ToUncertainPose(edge);
        if (from != edge.from) path = Compose(paths_[edge.from], path);
        if (to != edge.to) path = Compose(path, Invert(paths_[edge.to]));
        SetMeasurement(path, &edge);
        if (from == to) continue;  // within one stretch
      }
      edge.from = vertex_[from];
      edge.to = vertex_[to];
      if (edge.is_loop) {
        AddEdge(edge, i);
      } else {
        keys.push_back({{edge.from, edge.to}, static_cast<int>(keys.size())});
        trusted.push_back(edge);
      }
    }
    std::sort(keys.begin(), keys.end());
    for (size_t k = 0; k != keys.size(); ++k) {
      const PoseGraphEdge& edge = trusted[keys[k].second];
      if (k != 0 && keys[k].first == keys[k - 1].first) {
        Merge(edge, &result_.graph.edges.back());
      } else {
        AddEdge(edge, -1);
      }
    }
  }

  const PoseGraph& graph_;
  std::vector<int> next_, previous_;  // edge along the chain, or -1
  std::vector<bool> is_neighbour_;
  std::vector<int> anchor_;           // kept pose before, or itself
  std::vector<UncertainPose> paths_;  // (anchor <- pose)
  std::vector<int> vertex_;           // of a kept pose; else -1
  CondensedGraph result_;
};

}  // namespace

CondensedGraph Condense(const PoseGraph& graph,
                        const std::vector<int>& neighbours,
                        const int max_steps) {
  return Condenser(graph, neighbours).Run(max_steps);
}

}  // namespace optimization
}  // namespace cartographer_ext
