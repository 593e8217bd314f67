// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a matched scan knows about the pose of its node, from the curvature of
// its cost (scan_curvature.h): information, believed directions, and how scan
// and prediction are put together.
//
// A match errs along an axis of curvature e with the variance
//
//   (a^2 + b^2 / n) / e   squared cells,
//
// n points. It was found by matching simulated scans with submaps made from
// other simulated scans at the true poses: the part a, which more points do not
// reduce, comes from the map (cells, and the noise of the scans it is made of),
// the part b from the points. The figures behind it and behind the floor are in
// third_party_notes/paper_improved_graph_optimisation_2024.md, the test that
// holds them is tests/scan_matching/dropin/covariance_honesty_test.cc.
//
// The floor is the curvature that blank walls, straight (translation) and round
// (rotation), show along themselves: below it an axis counts as not determined.
// All curvatures grow with the contrast of the map, which a young submap has
// little of, and so does the noise along a wall: the floor is a share of the
// largest curvature.
//
// Scan match X_s and prediction X_0 with covariance P become
//
//   X_f = X_0 + (L + P^-1)^-1 L (X_s - X_0),   L = sum w_k e_k / (a^2 + b^2/n)
//   b_k b_k^T
//
// over the axes b_k (as covectors of the pose), w_k in [0, 1] the belief.
//
// Where P is not known, G eq. 19 with smooth weights over the directions of
// translation. The heading is then that of the match, which has the prior of
// the stock matcher in it: a scan in a round room that knows little of its
// heading is treated no worse than there, and the directions are judged with
// the heading given (no Schur complement), since that is how they are used.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_INFORMATION_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_INFORMATION_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/degeneracy.h"
#include "cartographer_ext/scan_matching/match_report.h"
#include "cartographer_ext/scan_matching/scan_curvature.h"

namespace cartographer_ext {
namespace scan_matching {

struct ScanInformationOptions {
  DegeneracyMode mode = DegeneracyMode::kNoiseFloor;
  // The floor of an axis: absolute (squared cost per squared cell), and as a
  // share of the largest curvature for pure translation and pure rotation, in
  // between by the squares of the axis; all >= 0, the larger counts.
  double floor = 0.001;
  double translation_floor = 0.05;
  double rotation_floor = 0.015;
  double full_ratio = 3.;      // > 1
  double paper_ratio = 30.;    // kPaperLiteral, > 1
  double map_noise = 0.018;    // a above, > 0
  double point_noise = 0.165;  // b above, >= 0
};

struct ScanInformation {
  // In the frame of the grid, real units: eigenvalues are 1/m^2 and 1/rad^2.
  DegeneracyResult degeneracy;
  // The axes as motions of the pose (metres, metres, radians per cell),
  // columns.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d inverse_axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d curvature = Eigen::Vector3d::Zero();  // never negative
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();    // belief in each axis
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();  // cells^2, or infinity
  // Directions of translation while the heading stays that of the match, as
  // columns, and the belief in them.
  Eigen::Matrix2d directions = Eigen::Matrix2d::Identity();
  Eigen::Vector2d direction_weights = Eigen::Vector2d::Zero();
  // L above, about (x, y, theta).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

// `gauss_newton` (any unit) is looked at in kPaperLiteral only.
ScanInformation AnalyzeScan(const ScanInformationOptions& options,
                            const ScaledMotion& motion,
                            const ScanCurvature& curvature, int num_points,
                            const Eigen::Matrix3d& gauss_newton);

// What counts as no information at all: nothing is determined.
ScanInformation NoInformation();

// The inverse where `covariance` is finite and positive definite, else false.
bool InvertCovariance(const Eigen::Matrix3d& covariance,
                      Eigen::Matrix3d* information);

// X_f from match X_s and prediction X_0, by G eq. 19.
Pose2 Remap(const ScanInformation& scan, DegeneracyMode mode,
            const Pose2& prediction, const Pose2& match);

// X_f by the information of both. `prior` is P^-1, positive definite.
Pose2 Fuse(const ScanInformation& scan, const Pose2& prediction,
           const Eigen::Matrix3d& prior, const Pose2& match);

// Sets disagreement, Mahalanobis distance and degrees of freedom. `covariance`
// of the prediction may be null.
void Compare(const ScanInformation& scan, const Pose2& prediction,
             const Eigen::Matrix3d* covariance, const Pose2& match,
             MatchReport* report);

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_INFORMATION_H_
