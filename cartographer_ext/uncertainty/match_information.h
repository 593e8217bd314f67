// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How much a matched scan knows about the pose of its node: the one estimator
// of the information of a scan match, for local SLAM and for loop closure. It
// starts from the curvature of the cost (scan_curvature.h), because the
// Gauss-Newton Hessian is nearly as large along a blank wall as across it.
//
// A match errs along an axis of curvature e with the variance
//
//   (a^2 + b^2 / n) / e   squared cells,   n points.
//
// This was found by matching simulated scans with submaps made from other
// simulated scans at the true poses: the part a, which more points do not
// reduce, comes from the map (cells, and the noise of the scans it is made of),
// the part b from the points. The figures behind it and behind the floor are in
// third_party_notes/paper_improved_graph_optimisation_2024.md, the test that
// holds them is tests/scan_matching/dropin/covariance_honesty_test.cc.
//
// The floor is the curvature that blank walls, straight (translation) and round
// (rotation), show along themselves: an axis below it counts as unobserved. All
// curvatures grow with the contrast of the map, of which a young submap has
// little, and so does the noise along a wall: the floor is a share of the
// largest curvature.
//
// The information of the match is
//
//   L = sum over k of  w_k e_k / (a^2 + b^2 / n)  b_k b_k^T
//
// over the axes b_k (as covectors of the pose), with w_k in [0, 1] the belief
// in axis k: 0 up to the floor, 1 from `full_ratio` times the floor on.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_MATCH_INFORMATION_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_MATCH_INFORMATION_H_

#include "Eigen/Core"
#include "cartographer_ext/uncertainty/scan_curvature.h"

namespace cartographer_ext {
namespace uncertainty {

struct MatchInformationOptions {
  // The floor of an axis: absolute (squared cost per squared cell), and as a
  // share of the largest curvature for pure translation and pure rotation, in
  // between by the squares of the axis; all >= 0, the larger counts.
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
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();    // belief in each axis
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();  // cells^2, or infinity
  // L above, about (x, y, theta).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  // From the rises instead of the curvatures (see ScanCurvature), without
  // belief, and the floors in the same unit: for the analysis of degeneracy.
  Eigen::Matrix3d rise_information = Eigen::Matrix3d::Zero();
  double translation_floor = 0.;  // 1/m^2
  double rotation_floor = 0.;     // 1/rad^2
};

// How far information is believed: 0 up to the floor, 1 from `full_ratio` times
// the floor on, in between 3 t^2 - 2 t^3 with t on a logarithmic scale.
double Belief(double information, double floor, double full_ratio);

// A match without points, or with numbers that are not finite, has no
// information.
MatchInformation EstimateMatchInformation(
    const MatchInformationOptions& options, const ScaledMotion& motion,
    const ScanCurvature& curvature, int num_points);

// Nothing is observed.
MatchInformation NoMatchInformation();

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_MATCH_INFORMATION_H_
