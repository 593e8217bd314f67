// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Information of a scan match about the pose of its node: the one estimator
// used by local SLAM and by loop closure. It is based on the curvature of the
// cost (scan_curvature.h), because the Gauss-Newton Hessian is nearly as large
// along a blank wall as across it.
//
// The error of a match along an axis of curvature e has the variance
//
//   (a^2 + b^2 / n) / e   squared cells,   n points.
//
// This was found by matching simulated scans with submaps made from other
// simulated scans at the true poses: the part a, which more points do not
// reduce, comes from the map (cells, and the noise of the scans it is made of),
// the part b from the points. The measurements behind it and behind the floor
// are in third_party_notes/paper_improved_graph_optimisation_2024.md;
// tests/scan_matching/dropin/covariance_honesty_test.cc checks them.
//
// The floor is the curvature along blank walls, straight (translation) and
// round (rotation): an axis below it counts as degenerate. All curvatures grow
// with the contrast of the map, which is low in a new submap, and so does the
// noise along a wall, so the floor is a fraction of the largest curvature.
//
// The information of the match is
//
//   L = sum over k of  w_k e_k / (a^2 + b^2 / n)  b_k b_k^T
//
// over the axes b_k (as covectors of the pose), with w_k in [0, 1] the weight
// of axis k: 0 up to the floor, 1 from `full_ratio` times the floor on.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_MATCH_INFORMATION_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_MATCH_INFORMATION_H_

#include "Eigen/Core"
#include "cartographer_ext/uncertainty/scan_curvature.h"

namespace cartographer_ext {
namespace uncertainty {

// Floors and noise of a match, see above.
struct MatchInformationOptions {
  // The floor of an axis: absolute (squared cost per squared cell), and as a
  // fraction of the largest curvature for pure translation and pure rotation,
  // interpolated by the squares of the axis; all >= 0. The larger of the two
  // applies.
  double floor = 0.001;
  double translation_floor = 0.05;
  double rotation_floor = 0.015;
  double full_ratio = 3.;      // > 1
  double map_noise = 0.018;    // a above, > 0
  double point_noise = 0.165;  // b above, >= 0
};

// In the frame of the grid; x, y in metres, theta in radians.
struct MatchInformation {
  // The axes as motions of the pose (metres, metres, radians per cell),
  // columns.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d inverse_axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d curvature = Eigen::Vector3d::Zero();  // never negative
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();    // of each axis
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();  // cells^2, or infinity
  // L above, about (x, y, theta).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  // From the rises instead of the curvatures (see ScanCurvature), without
  // weights, and the floors in the same unit: for the degeneracy analysis.
  Eigen::Matrix3d rise_information = Eigen::Matrix3d::Zero();
  double translation_floor = 0.;  // 1/m^2
  double rotation_floor = 0.;     // 1/rad^2
};

// Weight of an axis by its information: 0 up to the floor, 1 from `full_ratio`
// times the floor on, in between 3 t^2 - 2 t^3 with t on a logarithmic scale.
double Belief(double information, double floor, double full_ratio);

// A match without points, or with numbers that are not finite, has no
// information.
MatchInformation EstimateMatchInformation(
    const MatchInformationOptions& options, const ScaledMotion& motion,
    const ScanCurvature& curvature, int num_points);

// The result of a match that observes nothing.
MatchInformation NoMatchInformation();

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_MATCH_INFORMATION_H_
