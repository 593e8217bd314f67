// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Uncertainty of local SLAM about the path between two vertices of one
// trajectory, nodes or submaps. Their local poses give the relative pose; its
// error is a random walk whose variance grows with the distance driven and the
// angle turned. With X_k the local pose of vertex k and Q_k the covariance of
// the step to it, in its own frame (uncertain_pose.h),
//
//   cov(u <- v) = Ad(X_v^-1) (S_v - S_u) Ad(X_v^-1)^T,
//   S_n = sum over k <= n of Ad(X_k) Q_k Ad(X_k)^T,
//
// so any pair of vertices costs the same, however far apart.
//
// Three errors are constant along a run (CommonDrift): a heading drift in
// radians per metre, a relative error of the rotations and one of the scale.
// With A the sum of their effects on the steps, transported as above, they add
// A P A^T, where P is their covariance. Their means are removed from the
// relative pose: every step is corrected before the steps are composed.
//
// A step of local SLAM that is longer than the usual distance between nodes may
// be wrong (a jump of the odometry, a gap in the data): its excess over the
// jump thresholds is added to its standard deviation. Where nodes between two
// known ones have not been added yet, the thresholds apply to each of the steps
// between them. If the preceding nodes were farther apart than the thresholds
// assume (a slow laser, a fast robot), both thresholds are scaled accordingly, and
// a step that is ordinary among those nodes, in metres or in radians, is no jump.
//
// So is the covariance of a step that local SLAM itself doubts, and where it knows
// that of dead reckoning over a gap, that is the error of the step instead of its
// excess (step_error.h).
//
// The sums are kept apart for the errors of translation, of rotation per metre
// and of rotation while turning, so that each can be scaled for a trajectory
// whose drift is estimated (drift_model.h).
//
// Not thread-safe; vertices may be added in any order.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_PATH_UNCERTAINTY_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_PATH_UNCERTAINTY_H_

#include <cstddef>
#include <deque>
#include <limits>
#include <map>
#include <utility>

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/step_error.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace uncertainty {

// Standard deviations after one metre driven or one radian turned; they grow
// with the square root of both.
struct PathNoiseOptions {
  double translation_per_metre = 0.05;   // metres, >= 0
  double translation_per_radian = 0.02;  // metres, >= 0
  double rotation_per_metre = 0.005;     // radians, >= 0
  double rotation_per_radian = 0.015;    // radians, >= 0
  // Standard deviations of the errors that are constant along the run.
  double heading_drift = 5e-4;  // radians per metre, >= 0
  double scale_error = 0.005;   // >= 0
  // Longer steps between nodes count as jumps, > 0. About twice the distance at
  // which the motion filter of our configurations inserts nodes.
  double jump_threshold_metres = 0.5;
  double jump_threshold_radians = 0.4;
};

// Factors on the standard deviations of PathNoiseOptions, > 0.
struct DriftFactors {
  double translation = 1.;  // translation_per_*
  double rotation = 1.;     // rotation_per_metre
  double turning = 1.;      // rotation_per_radian
};

// Errors that are constant along a run. A step of local SLAM of d metres and a
// radians corresponds to a true step of (1 + scale) d metres and (1 + turning)
// a + heading d radians.
struct CommonDrift {
  // heading (radians per metre), turning, scale
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};
// The prior of the options, with means of zero.
CommonDrift PriorCommonDrift(const PathNoiseOptions& options);

// `noise` with its standard deviations multiplied by the factors.
PathNoiseOptions Scaled(const PathNoiseOptions& noise,
                        const DriftFactors& factors);

// Components of the covariance of a relative pose. With the factors f it is
//   C = f_translation^2 translation + f_rotation^2 rotation
//       + f_turning^2 turning + common P common^T + other.
struct CovarianceParts {
  Eigen::Matrix3d translation = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d turning = Eigen::Matrix3d::Zero();
  // Effects of the errors of CommonDrift, one per column.
  Eigen::Matrix3d common = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d other = Eigen::Matrix3d::Zero();  // jumps, doubts, loops

  // Component by component.
  CovarianceParts& operator+=(const CovarianceParts& parts);
  CovarianceParts& operator-=(const CovarianceParts& parts);
  Eigen::Matrix3d Total(const DriftFactors& factors,
                        const Eigen::Matrix3d& common_covariance) const;
};

// Adjoint C adjoint^T of each part, adjoint A of the common errors.
CovarianceParts Transported(const CovarianceParts& parts,
                            const Eigen::Matrix3d& adjoint);

// Largest step between two consecutive vertices that is no jump.
struct JumpThresholds {
  double metres = std::numeric_limits<double>::infinity();
  double radians = std::numeric_limits<double>::infinity();
};

// Paths within trajectories with their uncertainty, see above. Bounded by
// `max_vertices` per trajectory.
class PathUncertainty {
 public:
  // Keeps the newest `max_vertices` (> 0) nodes and as many submaps of each
  // trajectory.
  PathUncertainty(const PathNoiseOptions& options, int max_vertices);

  // (local frame of the trajectory <- vertex). A vertex that has been added
  // before, or that is older than all that are kept of a full trajectory, is
  // ignored. `error`: of the step that ends there.
  void Add(const VertexId& vertex, const Pose2& local_pose,
           const StepError& error = StepError());

  // (u <- v). Empty for a node and a submap, between trajectories, and for
  // vertices that are not kept.
  absl::optional<UncertainPose> Between(const VertexId& u,
                                        const VertexId& v) const;
  // The components of its covariance for factors of one; empty as above.
  absl::optional<CovarianceParts> Parts(const VertexId& u,
                                        const VertexId& v) const;
  // Drift of a trajectory; initially factors of one and the prior.
  void SetDrift(int trajectory_id, const DriftFactors& factors,
                const CommonDrift& common);
  DriftFactors Drift(int trajectory_id) const;
  CommonDrift Common(int trajectory_id) const;
  // Incremented with every change of the drift.
  int drift_version() const { return drift_version_; }
  // Metres driven between two vertices, empty as above.
  absl::optional<double> Travelled(const VertexId& u, const VertexId& v) const;
  // Uncertainty of the path between two vertices as one number, jumps included:
  // the length in metres of a straight path with the same uncertainty. Additive
  // along the trajectory. Empty as above.
  absl::optional<double> PathCost(const VertexId& u, const VertexId& v) const;
  // The same for a relative pose with this covariance. Both ignore the drift
  // factors.
  double PathCostOf(const Eigen::Matrix3d& covariance) const;
  // (local frame <- vertex).
  absl::optional<Pose2> LocalPose(const VertexId& vertex) const;

  // The node with the nearest local position, the oldest of equals. The origin
  // of a submap is the pose of its first node, so this relates a submap to a
  // node. Empty when the trajectory has no nodes.
  absl::optional<NodeId> Nearest(int trajectory_id,
                                 const Eigen::Vector2d& local_position) const;
  // The same among the nodes `first` to `last`, both included.
  absl::optional<NodeId> Nearest(int trajectory_id,
                                 const Eigen::Vector2d& local_position,
                                 int first, int last) const;

  void DeleteTrajectory(int trajectory_id);

 private:
  struct Entry {
    int index;
    Pose2 local_pose;
    Pose2 step;             // from the entry before, frame of that entry
    StepError error;        // of this step
    double travelled = 0.;  // prefix sum, metres
    double cost = 0.;       // prefix sum, metres
    Pose2 corrected;        // of corrected steps, from that of the first entry
    CovarianceParts sum;    // S_n and the sum of A
  };
  // The nodes, or the submaps, of a trajectory.
  struct Sequence {
    std::deque<Entry> entries;  // by index
    size_t num_valid = 0;       // entries with valid sums
  };
  using SequenceKey = std::pair<bool, int>;  // is_node, trajectory_id

  static SequenceKey KeyOf(const VertexId& vertex) {
    return {vertex.is_node(), vertex.trajectory_id()};
  }
  struct TrajectoryDrift {
    DriftFactors factors;
    CommonDrift common;
  };

  // For the step to the entry at `position`, from the steps before it.
  JumpThresholds Thresholds(const std::deque<Entry>& entries,
                            size_t position) const;
  // Computes the sums of `entry` from those of the entry before.
  // `thresholds`: for one step between consecutive vertices.
  void Accumulate(JumpThresholds thresholds, const Eigen::Vector3d& common,
                  const Entry& before, Entry* entry) const;
  const Entry* Find(const VertexId& vertex) const;
  // Of the path from the older to the newer entry, frame of the newer.
  CovarianceParts PartsBetween(const Entry& from, const Entry& to) const;
  // Of a prefix sum, without sign. Empty as `Between`.
  absl::optional<double> Difference(const VertexId& u, const VertexId& v,
                                    double Entry::*sum) const;

  const PathNoiseOptions options_;
  const size_t max_vertices_;
  // The sums are computed when they are asked for.
  mutable std::map<SequenceKey, Sequence> sequences_;
  std::map<int, TrajectoryDrift> drift_;
  int drift_version_ = 0;
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_PATH_UNCERTAINTY_H_
