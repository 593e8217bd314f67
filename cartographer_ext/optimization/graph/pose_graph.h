// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A planar pose graph on plain types. Poses x_i are (map <- i); an edge
// measures z_ij = (i <- j) with an information matrix in the order x, y, theta.
// The error is that of g2o,
//
//   e_ij = z_ij^-1 * (x_i^-1 * x_j)            (metres, metres, radians)
//
// and its squared Mahalanobis length is chi2 = e' Omega e. A whitened residual
// is r = A e with A' A = Omega, so that chi2 = r' r. Poses are stepped
// additively in (x, y, theta), as sparse pose adjustment does.
//
// Edges are either odometry (trusted, never disabled) or loops (each may be
// wrong). The papers distinguish them by their ends: odometry joins k to k + 1.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_POSE_GRAPH_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_POSE_GRAPH_H_

#include <cstdint>
#include <vector>

#include "Eigen/Core"
#include "absl/status/status.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace optimization {

// A relative measurement with its information.
struct PoseGraphEdge {
  int from = 0;       // index into PoseGraph::poses
  int to = 0;         // index into PoseGraph::poses
  Pose2 measurement;  // (from <- to)
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  bool is_loop = false;
};

// Poses and edges.
struct PoseGraph {
  std::vector<int64_t> ids;  // id of each pose in its file
  std::vector<Pose2> poses;  // initial or current estimate, (map <- pose)
  std::vector<PoseGraphEdge> edges;
  // Fixed poses (Optimize); if empty, the first one is fixed.
  std::vector<int> fixed;
};

// The rule of the papers and of Vertigo: every edge that does not lead from
// pose k to pose k + 1 is a loop.
inline bool IsLoopById(int64_t from_id, int64_t to_id) {
  return to_id != from_id + 1;
}

// Sets is_loop of all edges, the poses being in order of id. Odometry leads
// from a pose to the next one; where no such edge exists, the edges that lead
// back from the next one are. With ids that count by ones this is IsLoopById,
// but for odometry written backwards. Ids may have gaps; one of more than ten
// times the usual step begins another trajectory.
void MarkLoops(PoseGraph* graph);

// OK, or an error which names the first offending vertex or edge: no poses,
// ids not unique or not as many as poses, an end out of range, both ends equal,
// a value that is not finite, an information matrix that is not symmetric
// positive definite or has entries beyond 1e60, a pose that cannot be reached
// from the first one.
absl::Status ValidatePoseGraph(const PoseGraph& graph);

// Indices of the edges at each pose.
std::vector<std::vector<int>> EdgesAtPoses(const PoseGraph& graph);

// The pose at the other end of an edge of `pose`, as the edge measures it.
Pose2 MeasuredNeighbour(const PoseGraphEdge& edge, int pose,
                        const std::vector<Pose2>& poses);

// Chains odometry edges from the pose `start` (breadth first, over non-loop
// edges in both directions, given by EdgesAtPoses). Poses already reached keep
// their estimate; newly reached ones are marked, `start` included.
void ChainFrom(const PoseGraph& graph,
               const std::vector<std::vector<int>>& edges_at, int start,
               std::vector<bool>* reached, std::vector<Pose2>* poses);

// Poses by chaining odometry edges from the first pose. Unreachable poses keep
// their estimate.
std::vector<Pose2> DeadReckoning(const PoseGraph& graph);

// An edge prepared for repeated evaluation.
struct WhitenedEdge {
  int from = 0;
  int to = 0;
  bool is_loop = false;
  Eigen::Vector3d measurement;
  // A * blockdiag(R(z)', 1): whitens the error before its rotation into the
  // frame of the measured end.
  Eigen::Matrix3d whitening;
};

// Prepares edges; the information matrix must be positive definite.
WhitenedEdge Whiten(const PoseGraphEdge& edge);
// Prepares edges; the information matrix must be positive definite.
std::vector<WhitenedEdge> Whiten(const std::vector<PoseGraphEdge>& edges);

// NormalizeAngle of a sum of angles. Up to a turn and a quarter the subtraction of
// a turn is exact, and so the same at a fraction of the time.
inline double NormalizeSum(const double angle) {
  if (angle > kPi && angle <= 2.5 * kPi) return angle - 2. * kPi;
  if (angle < -kPi && angle >= -2.5 * kPi) return angle + 2. * kPi;
  return NormalizeAngle(angle);
}

// What the edge is off its measurement at the poses of its ends (metres, radians),
// in the frame of `from`, whose angle has this cosine and sine.
inline Eigen::Vector3d MeasurementError(const WhitenedEdge& edge,
                                        const Pose2& from, const Pose2& to,
                                        const double cos_from,
                                        const double sin_from) {
  const double dx = to.x - from.x, dy = to.y - from.y;
  return Eigen::Vector3d(
      cos_from * dx + sin_from * dy - edge.measurement.x(),
      -sin_from * dx + cos_from * dy - edge.measurement.y(),
      NormalizeSum(to.theta - from.theta - edge.measurement.z()));
}

// Whitened residual r of the edge at the poses of its ends.
inline Eigen::Vector3d Residual(const WhitenedEdge& edge, const Pose2& from,
                                const Pose2& to, const double cos_from,
                                const double sin_from) {
  return edge.whitening * MeasurementError(edge, from, to, cos_from, sin_from);
}
// The same without precomputed cosine and sine.
Eigen::Vector3d Residual(const WhitenedEdge& edge, const Pose2& from,
                         const Pose2& to);

// Same, with dr/dx_from and dr/dx_to (3 x 3, columns x, y, theta).
Eigen::Vector3d Linearize(const WhitenedEdge& edge, const Pose2& from,
                          const Pose2& to, Eigen::Matrix3d* jacobian_from,
                          Eigen::Matrix3d* jacobian_to);

// chi2 of the edge.
inline double Chi2(const WhitenedEdge& edge, const Pose2& from,
                   const Pose2& to) {
  return Residual(edge, from, to).squaredNorm();
}

// The same error without the metric, chi' of the ACS paper (before eq. 9):
// squared Euclidean length of e, which adds square metres and square radians.
// `residual` is the edge's whitened residual.
double UnwhitenedSquaredNorm(const WhitenedEdge& edge,
                             const Eigen::Vector3d& residual);

// chi2 of every edge at `poses`.
std::vector<double> Chi2OfEdges(const std::vector<WhitenedEdge>& edges,
                                const std::vector<Pose2>& poses);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_POSE_GRAPH_H_
