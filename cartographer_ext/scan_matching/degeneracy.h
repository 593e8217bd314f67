// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Motions of the robot that a scan does not observe (paper G, improved graph
// optimisation 2024, section 3.3, eq. 17 and 18).
//
// In a blank corridor the scan does not change when the robot moves along it:
// the cost of the scan matcher has no curvature in this direction, and the
// result of the match along it is noise. The paper uses the covariance of the
// match,
//
//   G eq. 17   Sigma = [cov(x,x) cov(x,y); cov(y,x) cov(y,y)]
//   G eq. 18   C_d, C_n, C_f: rows are the degenerate, the other, all
//              eigenvectors
//   G eq. 19   X_f = C_f^-1 C_d X_0 + C_f^-1 C_n X_s
//
// with X_0 the prediction (odometry) and X_s the match. (Eq. 19 as printed has
// the singular C_d^-1 in the first term.) With orthonormal eigenvectors v_i
// this is
//
//   X_f = sum over i of  v_i v_i^T (w_i X_s + (1 - w_i) X_0),   w_i = 0 or 1.
//
// This file finds v_i and w_i; eq. 19 is applied in scan_information.h.
//
// Differences from the paper, and the reasons:
//  * The matrix is the information of the occupied space alone. The Hessian of
//    the whole problem contains the priors that pull to the prediction, and
//    these dominate it: its covariance is round even in a corridor.
//  * Metres and radians are never in one decomposition. Rotation is eliminated
//    by the Schur complement, S = A - b b^T / c for H = [A b; b^T c], and S is
//    decomposed; the rotation has its own information c - b^T A^-1 b.
//  * A bare ratio of eigenvalues fails, because a quantised wall has spurious
//    information along itself. An eigenvalue counts only as far as it exceeds a
//    floor (match_information.h gives its origin).
//  * w_i changes smoothly from 0 at the floor to 1 at `full_ratio` times the
//    floor, so that the map does not jump when a door comes into view.
//
// Worked example: H = diag(4, 400, 50), floor 10, full_ratio 10. Along x (4 <
// 10) w = 0: the match is ignored. Along y (400 >= 100) w = 1.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_DEGENERACY_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_DEGENERACY_H_

#include "Eigen/Core"

namespace cartographer_ext {
namespace scan_matching {

// How degenerate directions are determined.
enum class DegeneracyMode {
  kNoiseFloor,    // as described above
  kPaperLiteral,  // eq. 17, 18: ratio of the covariance eigenvalues,
                  // weights 0 or 1
};

// Floors and thresholds of the analysis.
struct DegeneracyOptions {
  DegeneracyMode mode = DegeneracyMode::kNoiseFloor;
  // Spurious information of a blank wall along itself, in the units of the
  // Hessian, >= 0. Small rotations are scaled by the displacement of the
  // points. Depends on the scan (MatchInformation).
  double translation_floor = 0.;  // 1/m^2
  double rotation_floor = 0.;     // 1/rad^2
  double full_ratio = 3.;         // > 1
  double paper_ratio = 2.;        // kPaperLiteral: degenerate above, > 1
};

// The degenerate part of the pose.
enum class DegeneracyState {
  kNone,         // everything is observed
  kTranslation,  // one direction of translation is not
  kPosition,     // no direction of translation is
  kRotation,     // only the heading is not
  // One direction of translation and the heading are not: as in a round room,
  // where the scan is unchanged by driving around the centre while turning.
  kTranslationAndRotation,
  kEverything,  // nothing is observed
};

// Result of the analysis of one scan.
struct DegeneracyResult {
  // Translation information with the rotation eliminated: eigenvalues in
  // ascending order (1/m^2), unit eigenvectors as columns, in the frame of the
  // matrix.
  Eigen::Vector2d eigenvalues = Eigen::Vector2d::Zero();
  Eigen::Matrix2d eigenvectors = Eigen::Matrix2d::Identity();
  double rotation_information = 0.;  // 1/rad^2, with translation eliminated
  // Weight of the match along each eigenvector and in rotation, [0, 1].
  Eigen::Vector2d translation_weights = Eigen::Vector2d::Ones();
  double rotation_weight = 1.;
  DegeneracyState state = DegeneracyState::kNone;
  // Angle of the weakest direction in [0, pi), radians.
  double direction = 0.;
  // Ratio of the smaller to the larger eigenvalue, in [0, 1].
  double ratio = 1.;
};

// `hessian` is the information of the scan about (x, y, theta), metres and
// radians, in any frame and any unit of cost. A matrix with NaN or infinity
// counts as without information.
DegeneracyResult AnalyzeDegeneracy(const DegeneracyOptions& options,
                                   const Eigen::Matrix3d& hessian);

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_DEGENERACY_H_
