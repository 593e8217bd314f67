// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/wall_normals.h"

#include <cstddef>

#include "Eigen/Eigenvalues"

namespace cartographer_ext {
namespace scan_matching {
namespace {

// Points within this distance are on the same wall, metres.
constexpr double kNeighbourhood = 0.5;
constexpr int kMinNeighbours = 3;  // with the point itself
// Largest ratio of the widths of the points, across and along a wall.
constexpr double kLargestRatio = 0.5;

}  // namespace

std::vector<Eigen::Vector2d> WallNormals(
    const std::vector<Eigen::Vector2d>& points, const int first) {
  std::vector<Eigen::Vector2d> normals;
  for (size_t i = first; i < points.size(); ++i) {
    int count = 0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
    for (const Eigen::Vector2d& point : points) {
      const Eigen::Vector2d offset = point - points[i];
      if (offset.squaredNorm() > kNeighbourhood * kNeighbourhood) continue;
      ++count;
      mean += offset;
      moments += offset * offset.transpose();
    }
    normals.push_back(Eigen::Vector2d::Zero());
    if (count < kMinNeighbours) continue;
    mean /= count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
        moments / count - mean * mean.transpose());
    const Eigen::Vector2d variances = solver.eigenvalues();
    if (!(variances(0) <= kLargestRatio * kLargestRatio * variances(1))) {
      continue;
    }
    normals.back() = solver.eigenvectors().col(0);
  }
  return normals;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
