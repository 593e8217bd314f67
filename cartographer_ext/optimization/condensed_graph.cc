// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/condensed_graph.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "Eigen/LU"
#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/optimization/block_ldlt.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// A measurement (a <- b) with its covariance in the frame of a.
struct Link {
  Pose2 measurement;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// Information matrices are in the frame of the measured end.
Link ToLink(const PoseGraphEdge& edge) {
  Link link;
  link.measurement = edge.measurement;
  const Eigen::Matrix3d rotation = PlanarRotation(edge.measurement.theta);
  Eigen::Matrix3d covariance;
  if (!InvertSpd(edge.information, &covariance)) {
    covariance = edge.information.inverse();
  }
  link.covariance = rotation * covariance * rotation.transpose();
  return link;
}

Eigen::Matrix3d InformationOf(const Link& link) {
  const Eigen::Matrix3d rotation = PlanarRotation(link.measurement.theta);
  Eigen::Matrix3d information;
  if (!InvertSpd(link.covariance, &information)) {
    information = link.covariance.inverse();
  }
  information = rotation.transpose() * information * rotation;
  return Symmetric(information);
}

// (a <- c) from (a <- b) and (b <- c).
Link Compose(const Link& ab, const Link& bc) {
  Link result;
  result.measurement = ab.measurement * bc.measurement;
  Eigen::Matrix3d first = Eigen::Matrix3d::Identity();
  first(0, 2) = -(result.measurement.y - ab.measurement.y);
  first(1, 2) = result.measurement.x - ab.measurement.x;
  const Eigen::Matrix3d second = PlanarRotation(ab.measurement.theta);
  result.covariance = first * ab.covariance * first.transpose() +
                      second * bc.covariance * second.transpose();
  return result;
}

// (b <- a) from (a <- b).
Link Inverse(const Link& link) {
  Link result;
  result.measurement = link.measurement.Inverse();
  Eigen::Matrix3d jacobian = PlanarRotation(result.measurement.theta);
  jacobian(0, 2) = -result.measurement.y;
  jacobian(1, 2) = result.measurement.x;
  result.covariance = jacobian * link.covariance * jacobian.transpose();
  return result;
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
        links_(graph.poses.size()) {
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

  // Walks each stretch and notes how its poses hang on the one before.
  void AddChain() {
    for (const int start : result_.pose_of_vertex) {
      anchor_[start] = start;
      Link link;
      int steps = 0;
      for (int v = start; next_[v] >= 0;) {
        const PoseGraphEdge& step = graph_.edges[next_[v]];
        link = steps == 0 ? ToLink(step) : Compose(link, ToLink(step));
        ++steps;
        v = step.to;
        if (vertex_[v] < 0) {
          anchor_[v] = start;
          links_[v] = link;
          continue;
        }
        PoseGraphEdge edge = step;
        edge.from = vertex_[start];
        edge.to = vertex_[v];
        if (steps > 1) {
          edge.measurement = link.measurement;
          edge.information = InformationOf(link);
        }
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
        Link link = ToLink(edge);
        if (from != edge.from) link = Compose(links_[edge.from], link);
        if (to != edge.to) link = Compose(link, Inverse(links_[edge.to]));
        edge.measurement = link.measurement;
        edge.information = InformationOf(link);
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
  std::vector<int> anchor_;  // kept pose that a pose hangs on
  std::vector<Link> links_;  // from the anchor to the pose
  std::vector<int> vertex_;  // of a kept pose; else -1
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
