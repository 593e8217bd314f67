// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/graph/pose_graph.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "Eigen/Cholesky"
#include "Eigen/LU"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/order_statistics.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Beyond this, and below its inverse, products of three leave the range of a
// double.
constexpr double kLargestInformation = 1e60;

bool IsFinite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) &&
         std::isfinite(pose.theta);
}

std::string Name(const PoseGraph& graph, size_t edge_index) {
  const PoseGraphEdge& edge = graph.edges[edge_index];
  return absl::StrCat("edge ", edge_index, " (", graph.ids[edge.from], " -> ",
                      graph.ids[edge.to], ")");
}

absl::Status ValidateEdge(const PoseGraph& graph, size_t index) {
  const PoseGraphEdge& edge = graph.edges[index];
  const int num_poses = graph.poses.size();
  if (edge.from < 0 || edge.from >= num_poses || edge.to < 0 ||
      edge.to >= num_poses) {
    return absl::InvalidArgumentError(absl::StrCat(
        "edge ", index, " names a vertex that does not exist (index ",
        edge.from, " -> ", edge.to, " of ", num_poses, " vertices)"));
  }
  if (edge.from == edge.to) {
    return absl::InvalidArgumentError(
        absl::StrCat(Name(graph, index), " joins a vertex to itself"));
  }
  if (!IsFinite(edge.measurement) || !edge.information.allFinite()) {
    return absl::InvalidArgumentError(
        absl::StrCat(Name(graph, index), " has a value that is not finite"));
  }
  // Most graphs have one information matrix or two.
  if (index > 0 && edge.information == graph.edges[index - 1].information) {
    return absl::OkStatus();
  }
  const double scale = edge.information.cwiseAbs().maxCoeff();
  if ((edge.information - edge.information.transpose()).cwiseAbs().maxCoeff() >
      1e-9 * scale) {
    return absl::InvalidArgumentError(
        absl::StrCat(Name(graph, index),
                     " has an information matrix that is not symmetric"));
  }
  const Eigen::LLT<Eigen::Matrix3d> factor(edge.information);
  if (factor.info() != Eigen::Success ||
      !(factor.matrixLLT().diagonal().minCoeff() > 0.)) {
    return absl::InvalidArgumentError(
        absl::StrCat(Name(graph, index),
                     " has an information matrix that is not positive "
                     "definite"));
  }
  const double smallest = factor.matrixLLT().diagonal().minCoeff();
  if (scale > kLargestInformation ||
      smallest * smallest < 1. / kLargestInformation) {
    return absl::InvalidArgumentError(absl::StrCat(
        Name(graph, index), " has an information matrix out of range (",
        1. / kLargestInformation, " to ", kLargestInformation, ")"));
  }
  return absl::OkStatus();
}

// The representative of a pose's component, by halving the paths to it.
int FindRoot(int pose, std::vector<int>* const parents) {
  while ((*parents)[pose] != pose) {
    (*parents)[pose] = (*parents)[(*parents)[pose]];
    pose = (*parents)[pose];
  }
  return pose;
}

}  // namespace

void MarkLoops(PoseGraph* const graph) {
  constexpr uint64_t kLongGap = 10;
  const size_t num_steps = graph->poses.empty() ? 0 : graph->poses.size() - 1;
  // As unsigned numbers: ids may be anywhere.
  std::vector<uint64_t> gaps(num_steps);
  for (size_t k = 0; k != num_steps; ++k) {
    gaps[k] = static_cast<uint64_t>(graph->ids[k + 1]) -
              static_cast<uint64_t>(graph->ids[k]);
  }
  const uint64_t usual_gap = gaps.empty() ? 0 : UpperMedian(gaps);
  std::vector<bool> has_forward(num_steps, false);
  for (const PoseGraphEdge& edge : graph->edges) {
    if (edge.to == edge.from + 1) has_forward[edge.from] = true;
  }
  for (PoseGraphEdge& edge : graph->edges) {
    const int k = std::min(edge.from, edge.to);
    edge.is_loop = std::max(edge.from, edge.to) != k + 1 ||
                   (edge.from != k && has_forward[k]) ||
                   (gaps[k] - 1) / kLongGap >= usual_gap;
  }
}

absl::Status ValidatePoseGraph(const PoseGraph& graph) {
  if (graph.poses.empty()) {
    return absl::InvalidArgumentError("the graph has no vertices");
  }
  if (graph.ids.size() != graph.poses.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat("the graph has ", graph.poses.size(), " poses but ",
                     graph.ids.size(), " ids"));
  }
  // Most files count upwards.
  const bool ascending =
      std::adjacent_find(graph.ids.begin(), graph.ids.end(),
                         std::greater_equal<int64_t>()) == graph.ids.end();
  std::set<int64_t> seen;
  for (size_t i = 0; i != graph.poses.size(); ++i) {
    if (!ascending && !seen.insert(graph.ids[i]).second) {
      return absl::InvalidArgumentError(
          absl::StrCat("vertex ", graph.ids[i], " appears twice"));
    }
    if (!IsFinite(graph.poses[i])) {
      return absl::InvalidArgumentError(absl::StrCat(
          "vertex ", graph.ids[i], " has a value that is not finite"));
    }
  }
  for (const int pose : graph.fixed) {
    if (pose < 0 || pose >= static_cast<int>(graph.poses.size())) {
      return absl::InvalidArgumentError(
          absl::StrCat("fixed pose ", pose, " does not exist"));
    }
  }
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    const absl::Status status = ValidateEdge(graph, i);
    if (!status.ok()) return status;
  }
  // Components, each under its first pose.
  std::vector<int> parents(graph.poses.size());
  std::iota(parents.begin(), parents.end(), 0);
  for (const PoseGraphEdge& edge : graph.edges) {
    const int a = FindRoot(edge.from, &parents);
    const int b = FindRoot(edge.to, &parents);
    parents[std::max(a, b)] = std::min(a, b);
  }
  for (size_t i = 0; i != parents.size(); ++i) {
    if (FindRoot(i, &parents) != 0) {
      return absl::InvalidArgumentError(
          absl::StrCat("the graph is not connected: vertex ", graph.ids[i],
                       " cannot be reached from vertex ", graph.ids[0]));
    }
  }
  return absl::OkStatus();
}

std::vector<std::vector<int>> EdgesAtPoses(const PoseGraph& graph) {
  std::vector<std::vector<int>> result(graph.poses.size());
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    result[graph.edges[i].from].push_back(i);
    result[graph.edges[i].to].push_back(i);
  }
  return result;
}

Pose2 MeasuredNeighbour(const PoseGraphEdge& edge, const int pose,
                        const std::vector<Pose2>& poses) {
  return edge.from == pose ? poses[pose] * edge.measurement
                           : poses[pose] * edge.measurement.Inverse();
}

void ChainFrom(const PoseGraph& graph,
               const std::vector<std::vector<int>>& edges_at, const int start,
               std::vector<bool>* const reached,
               std::vector<Pose2>* const poses) {
  std::vector<int> queue = {start};
  (*reached)[start] = true;
  for (size_t next = 0; next != queue.size(); ++next) {
    const int pose = queue[next];
    for (const int i : edges_at[pose]) {
      const PoseGraphEdge& edge = graph.edges[i];
      const int other = edge.from == pose ? edge.to : edge.from;
      if (edge.is_loop || (*reached)[other]) continue;
      (*poses)[other] = MeasuredNeighbour(edge, pose, *poses);
      (*reached)[other] = true;
      queue.push_back(other);
    }
  }
}

std::vector<Pose2> DeadReckoning(const PoseGraph& graph) {
  std::vector<Pose2> poses = graph.poses;
  if (poses.empty()) return poses;
  std::vector<bool> reached(poses.size(), false);
  ChainFrom(graph, EdgesAtPoses(graph), 0, &reached, &poses);
  return poses;
}

namespace {

WhitenedEdge Whiten(const PoseGraphEdge& edge, const Eigen::Matrix3d& upper) {
  WhitenedEdge result;
  result.from = edge.from;
  result.to = edge.to;
  result.is_loop = edge.is_loop;
  result.measurement = Eigen::Vector3d(edge.measurement.x, edge.measurement.y,
                                       edge.measurement.theta);
  const double c = std::cos(edge.measurement.theta);
  const double s = std::sin(edge.measurement.theta);
  Eigen::Matrix3d rotation;
  rotation << c, s, 0., -s, c, 0., 0., 0., 1.;
  result.whitening = upper * rotation;
  return result;
}

Eigen::Matrix3d UpperRoot(const Eigen::Matrix3d& information) {
  return Eigen::LLT<Eigen::Matrix3d>(information).matrixU();
}

}  // namespace

WhitenedEdge Whiten(const PoseGraphEdge& edge) {
  return Whiten(edge, UpperRoot(edge.information));
}

std::vector<WhitenedEdge> Whiten(const std::vector<PoseGraphEdge>& edges) {
  std::vector<WhitenedEdge> result;
  result.reserve(edges.size());
  // Most graphs have one information matrix or two.
  Eigen::Matrix3d upper;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (i == 0 || edges[i].information != edges[i - 1].information) {
      upper = UpperRoot(edges[i].information);
    }
    result.push_back(Whiten(edges[i], upper));
  }
  return result;
}

Eigen::Vector3d Residual(const WhitenedEdge& edge, const Pose2& from,
                         const Pose2& to) {
  return Residual(edge, from, to, std::cos(from.theta), std::sin(from.theta));
}

Eigen::Vector3d Linearize(const WhitenedEdge& edge, const Pose2& from,
                          const Pose2& to, Eigen::Matrix3d* jacobian_from,
                          Eigen::Matrix3d* jacobian_to) {
  const double c = std::cos(from.theta), s = std::sin(from.theta);
  const double dx = to.x - from.x, dy = to.y - from.y;
  const double along = c * dx + s * dy, across = -s * dx + c * dy;
  const Eigen::Vector3d error(
      along - edge.measurement.x(), across - edge.measurement.y(),
      NormalizeAngle(to.theta - from.theta - edge.measurement.z()));
  const Eigen::Vector3d w0 = edge.whitening.col(0);
  const Eigen::Vector3d w1 = edge.whitening.col(1);
  const Eigen::Vector3d w2 = edge.whitening.col(2);
  jacobian_to->col(0) = c * w0 - s * w1;
  jacobian_to->col(1) = s * w0 + c * w1;
  jacobian_to->col(2) = w2;
  jacobian_from->col(0) = -jacobian_to->col(0);
  jacobian_from->col(1) = -jacobian_to->col(1);
  // d(along)/dtheta = across, d(across)/dtheta = -along.
  jacobian_from->col(2) = across * w0 - along * w1 - w2;
  return edge.whitening * error;
}

double UnwhitenedSquaredNorm(const WhitenedEdge& edge,
                             const Eigen::Vector3d& residual) {
  // The rotation inside `whitening` keeps the length.
  return edge.whitening.partialPivLu().solve(residual).squaredNorm();
}

std::vector<double> Chi2OfEdges(const std::vector<WhitenedEdge>& edges,
                                const std::vector<Pose2>& poses) {
  std::vector<Eigen::Vector2d> rotations(poses.size());
  for (size_t i = 0; i != poses.size(); ++i) {
    const double theta = poses[i].theta;
    rotations[i] = Eigen::Vector2d(std::cos(theta), std::sin(theta));
  }
  std::vector<double> result;
  result.reserve(edges.size());
  for (const WhitenedEdge& edge : edges) {
    const Eigen::Vector2d& rotation = rotations[edge.from];
    result.push_back(Residual(edge, poses[edge.from], poses[edge.to],
                              rotation.x(), rotation.y())
                         .squaredNorm());
  }
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
