// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/graph/stretch_bend.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "cartographer_ext/optimization/solvers/block_ldlt.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kMaxIterations = 5;
constexpr double kStepTolerance = 1e-4;
// Instead of the number of a variable.
constexpr int kHeld = -1;
constexpr int kUnknown = -2;

class Stretches {
 public:
  Stretches(const PoseGraph& graph, const std::vector<int>& neighbours,
            const CondensedGraph& condensed, const std::vector<Pose2>& poses)
      : graph_(graph),
        poses_(graph.poses.size()),
        variable_(graph.poses.size(), kUnknown),
        next_(graph.poses.size(), -1),
        is_neighbour_(graph.edges.size(), false) {
    for (size_t v = 0; v != poses.size(); ++v) {
      poses_[condensed.pose_of_vertex[v]] = poses[v];
      variable_[condensed.pose_of_vertex[v]] = kHeld;
    }
    for (const int i : neighbours) {
      next_[graph.edges[i].from] = i;
      is_neighbour_[i] = true;
    }
  }

  // The steps from the vertex `start` to the next one.
  void Add(const int start) {
    for (int v = start; next_[v] >= 0;) {
      const PoseGraphEdge& step = graph_.edges[next_[v]];
      edges_.push_back(Whiten(step));
      if (variable_[step.to] == kHeld) break;
      variable_[step.to] = free_.size();
      free_.push_back(step.to);
      poses_[step.to] = poses_[v] * step.measurement;
      v = step.to;
    }
  }

  // The trusted edges from these steps to elsewhere; false where that is not
  // known.
  bool AddOthers() {
    num_steps_ = edges_.size();
    for (size_t i = 0; i != graph_.edges.size(); ++i) {
      const PoseGraphEdge& edge = graph_.edges[i];
      if (edge.is_loop || is_neighbour_[i]) continue;
      const int from = variable_[edge.from], to = variable_[edge.to];
      if (from < 0 && to < 0) continue;
      if (from == kUnknown || to == kUnknown) return false;
      edges_.push_back(Whiten(edge));
    }
    return true;
  }

  // Gauss-Newton.
  bool Solve() {
    if (free_.empty()) return true;
    std::vector<std::pair<int, int>> pairs;
    for (const WhitenedEdge& edge : edges_) {
      if (variable_[edge.from] >= 0 && variable_[edge.to] >= 0) {
        pairs.push_back({variable_[edge.from], variable_[edge.to]});
      }
    }
    BlockLdlt factor;
    factor.Analyze(free_.size(), pairs, {});
    for (int iteration = 0; iteration != kMaxIterations; ++iteration) {
      factor.SetZero();
      Eigen::VectorXd step = Eigen::VectorXd::Zero(3 * free_.size());
      int pair = 0;
      for (const WhitenedEdge& edge : edges_) {
        const int from = variable_[edge.from], to = variable_[edge.to];
        Eigen::Matrix3d of_from, of_to;
        const Eigen::Vector3d residual = Linearize(
            edge, poses_[edge.from], poses_[edge.to], &of_from, &of_to);
        if (from >= 0) {
          factor.AddDiagonal(from, of_from.transpose() * of_from);
          step.segment<3>(3 * from) -= of_from.transpose() * residual;
        }
        if (to >= 0) {
          factor.AddDiagonal(to, of_to.transpose() * of_to);
          step.segment<3>(3 * to) -= of_to.transpose() * residual;
        }
        if (from >= 0 && to >= 0) {
          factor.AddOffDiagonal(pair++, of_from.transpose() * of_to);
        }
      }
      if (!factor.Factorize(0.)) return false;
      factor.Solve(&step);
      for (size_t k = 0; k != free_.size(); ++k) {
        Pose2& pose = poses_[free_[k]];
        pose.x += step[3 * k];
        pose.y += step[3 * k + 1];
        pose.theta = NormalizeAngle(pose.theta + step[3 * k + 2]);
      }
      if (step.cwiseAbs().maxCoeff() < kStepTolerance) break;
    }
    return true;
  }

  double LargestChi2OfSteps() const {
    double largest = 0.;
    for (size_t i = 0; i != num_steps_; ++i) {
      const WhitenedEdge& edge = edges_[i];
      largest =
          std::max(largest, Chi2(edge, poses_[edge.from], poses_[edge.to]));
    }
    return largest;
  }

 private:
  const PoseGraph& graph_;
  std::vector<Pose2> poses_;
  std::vector<int> variable_;  // of each pose
  std::vector<int> next_;      // step from each pose, or -1
  std::vector<bool> is_neighbour_;
  std::vector<int> free_;            // pose of each variable
  std::vector<WhitenedEdge> edges_;  // the steps come first
  size_t num_steps_ = 0;
};

}  // namespace

double LargestBend(const PoseGraph& graph, const std::vector<int>& neighbours,
                   const CondensedGraph& condensed,
                   const std::vector<Pose2>& poses,
                   const std::vector<int>& stretches) {
  Stretches steps(graph, neighbours, condensed, poses);
  for (const int stretch : stretches) {
    const int edge = condensed.chain[stretch];
    steps.Add(condensed.pose_of_vertex[condensed.graph.edges[edge].from]);
  }
  if (!steps.AddOthers() || !steps.Solve()) {
    return std::numeric_limits<double>::infinity();
  }
  return steps.LargestChi2OfSteps();
}

}  // namespace optimization
}  // namespace cartographer_ext
