// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How uncertain local SLAM is about the way between two nodes. The local poses
// give the relative pose; its error is a random walk whose variance grows with
// the metres driven and the radians turned. With X_k the local pose of node k
// and Q_k the covariance of the step to it, in its own frame,
//
//   cov(u <- v) = Ad(X_v^-1) (S_v - S_u) Ad(X_v^-1)^T,
//   S_n = sum over k <= n of Ad(X_k) Q_k Ad(X_k)^T,
//
// so any pair of nodes costs the same, however far apart. Two errors are the
// same all along a run, a heading that turns away by so many radians a metre
// and a scale; each adds w w^T times its variance, with w the sum of what it
// does to the steps, transported as above.
//
// Where local SLAM moves farther from one node to the next than nodes are apart
// it was led astray (a jump of the odometry, a gap in the data), or could have
// been: what a step exceeds `free_metres` and `free_radians` by counts as its
// standard deviation.
//
// Not thread-safe; nodes may be added in any order.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_PATH_UNCERTAINTY_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_PATH_UNCERTAINTY_H_

#include <deque>
#include <limits>
#include <map>

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/cycle_consistency.h"

namespace cartographer_ext {
namespace loop_closure {

// Standard deviations after one metre driven or one radian turned; they grow
// with the square root of the way.
struct PathNoiseOptions {
  double translation_per_metre = 0.05;   // metres, >= 0
  double translation_per_radian = 0.02;  // metres, >= 0
  double rotation_per_metre = 0.005;     // radians, >= 0
  double rotation_per_radian = 0.015;    // radians, >= 0
  // The same for the whole run.
  double heading_drift = 0.;  // radians a metre, >= 0
  double scale_error = 0.;    // >= 0
  // Steps may be as long, metres and radians, > 0.
  double free_metres = std::numeric_limits<double>::infinity();
  double free_radians = std::numeric_limits<double>::infinity();
};

struct NodeKey {
  int trajectory_id = 0;
  int node_index = 0;
};
inline bool operator==(const NodeKey& a, const NodeKey& b) {
  return a.trajectory_id == b.trajectory_id && a.node_index == b.node_index;
}

class PathUncertainty {
 public:
  // Keeps the newest `max_nodes` (> 0) nodes of each trajectory.
  PathUncertainty(const PathNoiseOptions& options, int max_nodes);

  // (local frame of the trajectory <- node). A node known already, or older
  // than all that are kept of a full trajectory, changes nothing.
  void Add(const NodeKey& node, const Pose2& local_pose);

  // (u <- v). Empty between trajectories and for nodes that are not kept.
  absl::optional<UncertainPose> Between(const NodeKey& u,
                                        const NodeKey& v) const;
  // Metres driven between two nodes, empty as above.
  absl::optional<double> Travelled(const NodeKey& u, const NodeKey& v) const;
  // The way between two nodes as metres of plain driving that would be as
  // uncertain, jumps included; adds up along the trajectory. Empty as above.
  absl::optional<double> Effort(const NodeKey& u, const NodeKey& v) const;
  // The same of a pose with this covariance.
  double EffortOf(const Eigen::Matrix3d& covariance) const;
  // (local frame <- node).
  absl::optional<Pose2> LocalPose(const NodeKey& node) const;

  // The node whose local position is nearest, the oldest of equals. A submap
  // lies where its first node was, so this ties a submap to a node. Empty when
  // the trajectory has no nodes.
  absl::optional<NodeKey> Nearest(int trajectory_id,
                                  const Eigen::Vector2d& local_position) const;
  // The same among the nodes `first` to `last`, both included.
  absl::optional<NodeKey> Nearest(int trajectory_id,
                                  const Eigen::Vector2d& local_position,
                                  int first, int last) const;

  void DeleteTrajectory(int trajectory_id);

 private:
  struct Entry {
    int node_index;
    Pose2 local_pose;
    double travelled = 0.;                          // prefix sum, metres
    double effort = 0.;                             // prefix sum, metres
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();  // S_n
    // Sums of the steps' errors for a unit of drift and scale error.
    Eigen::Vector3d drift = Eigen::Vector3d::Zero();
    Eigen::Vector3d scale = Eigen::Vector3d::Zero();
  };
  struct Trajectory {
    std::deque<Entry> entries;  // by node index
    size_t num_valid = 0;       // entries with valid sums
  };

  const Entry* Find(const NodeKey& node) const;
  // Of a prefix sum, without sign. Empty as `Between`.
  absl::optional<double> Difference(const NodeKey& u, const NodeKey& v,
                                    double Entry::*sum) const;

  const PathNoiseOptions options_;
  const size_t max_nodes_;
  // The sums are computed when they are asked for.
  mutable std::map<int, Trajectory> trajectories_;
};

// A loop between two nodes: (a <- b).
struct LoopEdge {
  NodeKey a;
  NodeKey b;
  UncertainPose pose;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_PATH_UNCERTAINTY_H_
