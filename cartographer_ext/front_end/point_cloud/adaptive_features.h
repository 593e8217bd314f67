// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Adaptive feature points of a planar scan (paper G, improved graph
// optimisation 2024, section 3.1).
//
//   G eq. 1    C = 1/k sum_j (p_ij - m)(p_ij - m)^T           m = mean of p_ij
//   G eq. 2    C = 1/k sum_j w_j (p_ij - m)(p_ij - m)^T
//              w_j = exp(-|p_ij - p_i|^2 / r^2)
//   G eq. 3    sigma(p_i) = 2 lambda_1 / (lambda_1 + lambda_2)
//              lambda_1 <= lambda_2, the eigenvalues of C
//   G eq. 4    eps_i = 1/k sum_j sigma(p_ij)
//              p_i is a feature if sigma(p_i) > eps_i
//
// over the k nearest neighbours p_ij of p_i (exact, kd-tree). sigma is 0 on a
// straight wall and 1 where the neighbourhood is round. r is the radius of the
// neighbourhood, that is the distance to the k-th neighbour.
//
// On a straight wall hardly any point passes, too few for a match, so the
// points with the largest sigma are added up to a minimum number.
#ifndef CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_ADAPTIVE_FEATURES_H_
#define CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_ADAPTIVE_FEATURES_H_

#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace front_end {

// Neighbourhood and minimum number of features.
struct AdaptiveFeatureOptions {
  int num_neighbors = 10;         // k, > 0; the point itself is not one of them
  bool distance_weighted = true;  // eq. 2 instead of eq. 1
  // Minimum number of features, >= 0: with fewer a match starves.
  int min_points = 80;
};

// sigma(p_i) of eq. 3 for every point; 0 where there are fewer than two
// neighbours or they coincide. Points in metres; points that are not finite get
// 0 and are no neighbours.
std::vector<double> FeatureVariation(
    const AdaptiveFeatureOptions& options,
    const std::vector<Eigen::Vector2d>& points);

// Indices of the feature points in ascending order: those above the threshold
// of eq. 4, and up to the minimum number by descending sigma (then ascending
// index).
std::vector<int> SelectFeatures(const AdaptiveFeatureOptions& options,
                                const std::vector<Eigen::Vector2d>& points);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_ADAPTIVE_FEATURES_H_
