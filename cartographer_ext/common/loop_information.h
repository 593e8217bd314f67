// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The full information matrices of loop closure constraints.
//
// Cartographer's constraints carry a relative pose and two scalar weights, the
// square roots of the information of translation and of rotation. A scan
// matched in a corridor is certain across it and uncertain along it, which only
// a 3x3 matrix can represent. The constraint builder stores the matrix of a
// loop in the context of the pose graph (pose_graph_context.h), and the
// optimization problem of the same pose graph uses it in place of the weights:
//
//   with a matrix   r = S e,                            S^T S = information
//   without         r = (w_t e_x, w_t e_y, w_r e_theta), the stock residual
//
// with e = (z_xy - R(theta_i)^T (t_j - t_i), z_theta - (theta_j - theta_i)),
// metres and radians in the frame of the submap i (Konolige et al., "Efficient
// sparse pose adjustment for 2D mapping", IROS 2010, equation 1). The two
// weights of the constraint must be meaningful on their own, because a stored
// map contains nothing else.
#ifndef CARTOGRAPHER_EXT_COMMON_LOOP_INFORMATION_H_
#define CARTOGRAPHER_EXT_COMMON_LOOP_INFORMATION_H_

#include <array>
#include <cstddef>
#include <deque>
#include <map>

#include "Eigen/Core"
#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer_ext/common/loop_id.h"

namespace cartographer_ext {

// The information that the two weights of a constraint express, in the order x,
// y, theta.
inline Eigen::Matrix3d InformationOfWeights(const double translation_weight,
                                            const double rotation_weight) {
  return Eigen::Vector3d(translation_weight * translation_weight,
                         translation_weight * translation_weight,
                         rotation_weight * rotation_weight)
      .asDiagonal();
}

// The matrices by loop; a part of PoseGraphContext. Thread-safe.
class LoopInformation {
 public:
  // Beyond this number the oldest matrices are dropped (about 25 MB); those
  // loops are weighted by their two weights from then on.
  static constexpr size_t kCapacity = 100000;

  // Sets the information (1/m^2, 1/(m rad), 1/rad^2) of a loop. Returns false
  // and changes nothing unless the matrix is finite, symmetric and positive
  // semi-definite.
  bool Set(const LoopId& id, const Eigen::Matrix3d& information)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // A square root S of the information, S^T S = information. False if the loop
  // has no matrix.
  bool FindSqrt(const LoopId& id, Eigen::Matrix3d* sqrt) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  size_t size() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // Plain numbers: fixed-size matrices would need aligned memory.
  using Sqrt = std::array<double, 9>;

  mutable absl::Mutex mutex_;
  std::map<LoopId, Sqrt> sqrt_of_loop_ ABSL_GUARDED_BY(mutex_);
  std::deque<LoopId> oldest_first_ ABSL_GUARDED_BY(mutex_);
};

// Passes square roots to the residuals of one optimisation. Cartographer
// creates the residual of a constraint from a reference to its pose, without
// ids, so the address of the pose is the key, valid on this thread during the
// lifetime of the scope. Scopes nest.
class ScopedSqrtInformation {
 public:
  using Sqrt = std::array<double, 9>;  // column-major
  // Keyed by the address of Constraint::pose.
  using SqrtOfPose = std::map<const void*, Sqrt>;

  explicit ScopedSqrtInformation(SqrtOfPose sqrt_of_pose);
  ~ScopedSqrtInformation();
  ScopedSqrtInformation(const ScopedSqrtInformation&) = delete;
  ScopedSqrtInformation& operator=(const ScopedSqrtInformation&) = delete;

  // In the innermost scope of this thread; false without one.
  static bool Find(const void* pose, Eigen::Matrix3d* sqrt);

 private:
  const SqrtOfPose sqrt_of_pose_;
  const ScopedSqrtInformation* const outer_;
};

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_LOOP_INFORMATION_H_
