// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A full information matrix for a constraint that has room for two weights
// only.
//
// Cartographer's constraints carry a relative pose and two scalars, square
// roots of the information of translation and of rotation. Whoever knows the
// whole 3x3 matrix (a scan matched in a corridor is sure across it and unsure
// along it) remembers it here, under the exact bits of pose and weights that
// the constraint is going to have. Constraints are copied bit by bit on their
// way to the optimisation, where the swap `full_information` looks each one up:
//
//   found    r = S e,                          S^T S = information
//   else     r = (w_t e_x, w_t e_y, w_r e_theta), the stock residual
//
// Local SLAM knows the pose of the constraints within a submap beforehand, but
// not the weights they are going to have. It remembers, under the bits of the
// pose alone, which part of the information of the weights is left; looked up
// where no whole matrix is there:
//
//   found    r = S W e,   S^T S = relative information,  W = diag(w_t, w_t,
//   w_r)
//
// with e = (z_xy - R(theta_i)^T (t_j - t_i), z_theta - (theta_j - theta_i)),
// metres and radians in the frame of the submap i (Konolige et al., "Efficient
// sparse pose adjustment for 2D mapping", IROS 2010, equation 1). The two
// scalars stay in the constraint and must make sense on their own: a stored map
// has nothing else, since loading changes the bits.
#ifndef CARTOGRAPHER_EXT_COMMON_FULL_INFORMATION_H_
#define CARTOGRAPHER_EXT_COMMON_FULL_INFORMATION_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "Eigen/Core"

namespace cartographer_ext {

// Bits of a constraint: translation, rotation (w, x, y, z), both weights.
using ConstraintBits = std::array<uint64_t, 9>;

// The oldest entries are forgotten beyond this number (about 25 MB).
constexpr size_t kMaxFullInformation = 100000;

// `ConstraintPose` is Cartographer's PoseGraphInterface::Constraint::Pose.
template <typename ConstraintPose>
ConstraintBits BitsOf(const ConstraintPose& pose) {
  const auto& translation = pose.zbar_ij.translation();
  const auto& rotation = pose.zbar_ij.rotation();
  const std::array<double, 9> values{
      {translation.x(), translation.y(), translation.z(), rotation.w(),
       rotation.x(), rotation.y(), rotation.z(), pose.translation_weight,
       pose.rotation_weight}};
  ConstraintBits bits;
  static_assert(sizeof(bits) == sizeof(values), "double has 64 bits");
  std::memcpy(bits.data(), values.data(), sizeof(bits));
  return bits;
}

// Bits of a relative pose alone.
using PoseBits = std::array<uint64_t, 7>;

// `Rigid3` is Cartographer's transform::Rigid3d.
template <typename Rigid3>
PoseBits PoseBitsOf(const Rigid3& pose) {
  const std::array<double, 7> values{
      {pose.translation().x(), pose.translation().y(), pose.translation().z(),
       pose.rotation().w(), pose.rotation().x(), pose.rotation().y(),
       pose.rotation().z()}};
  PoseBits bits;
  static_assert(sizeof(bits) == sizeof(values), "double has 64 bits");
  std::memcpy(bits.data(), values.data(), sizeof(bits));
  return bits;
}

// What the two weights of a constraint stand for, in the order x, y, theta.
inline Eigen::Matrix3d InformationOfWeights(const double translation_weight,
                                            const double rotation_weight) {
  return Eigen::Vector3d(translation_weight * translation_weight,
                         translation_weight * translation_weight,
                         rotation_weight * rotation_weight)
      .asDiagonal();
}

// Remembers the information (1/m^2, 1/(m rad), 1/rad^2; symmetric, positive
// semi-definite) for constraints of these bits, in place of what was there.
// Returns false and remembers nothing where the matrix is neither or not
// finite. These functions may be called by several threads at once.
bool RememberFullInformation(const ConstraintBits& bits,
                             const Eigen::Matrix3d& information);

// Remembers which part of the information of its weights a constraint with this
// pose has (no unit; symmetric, positive semi-definite, in the frame of the
// constraint). Returns as above.
bool RememberRelativeInformation(const PoseBits& bits,
                                 const Eigen::Matrix3d& relative);

// A square root S of the information, S^T S = information. False where there
// is none.
bool FindSqrtInformation(const ConstraintBits& bits, Eigen::Matrix3d* sqrt);

// Of both kinds together.
size_t CountFullInformation();

// Forgets everything, for tests.
void ForgetFullInformation();

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_FULL_INFORMATION_H_
