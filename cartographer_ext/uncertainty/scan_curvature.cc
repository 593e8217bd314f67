// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/scan_curvature.h"

#include <algorithm>
#include <utility>

#include "Eigen/Eigenvalues"
#include "Eigen/LU"

namespace cartographer_ext {
namespace uncertainty {
namespace {

// One point has no spread, and turning it moves nothing.
constexpr double kMinSpreadCells = 4.;

}  // namespace

ScaledMotion::ScaledMotion(const std::vector<Eigen::Vector2d>& points,
                           const double cell, const Pose2& pose)
    : pose_(pose), cell_(cell) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) mean += point;
  if (!points.empty()) mean /= static_cast<double>(points.size());
  double square = 0.;
  for (const Eigen::Vector2d& point : points) {
    square += (point - mean).squaredNorm();
  }
  if (!points.empty()) square /= static_cast<double>(points.size());
  turn_ = cell / std::max(std::sqrt(square), kMinSpreadCells * cell);
  centroid_ = Pose2(0., 0., pose.theta) * mean;
  to_pose_ << cell, 0., turn_ * centroid_.y(), 0., cell, -turn_ * centroid_.x(),
      0., 0., turn_;
  from_pose_ = to_pose_.inverse();
}

Pose2 ScaledMotion::Moved(const Eigen::Vector3d& motion) const {
  const double angle = turn_ * motion.z();
  const Eigen::Vector2d turned = Pose2(0., 0., angle) * centroid_;
  return Pose2(pose_.x + cell_ * motion.x() + centroid_.x() - turned.x(),
               pose_.y + cell_ * motion.y() + centroid_.y() - turned.y(),
               pose_.theta + angle);
}

namespace internal {

Eigen::Matrix3d Axes(const Eigen::Matrix3d& symmetric) {
  if (!symmetric.allFinite()) return Eigen::Matrix3d::Identity();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric)
      .eigenvectors();
}

void Sort(ScanCurvature* const curvature) {
  for (const int k : {0, 1, 0}) {
    if (curvature->values(k) <= curvature->values(k + 1)) continue;
    std::swap(curvature->values(k), curvature->values(k + 1));
    std::swap(curvature->rises(k), curvature->rises(k + 1));
    curvature->axes.col(k).swap(curvature->axes.col(k + 1));
  }
}

}  // namespace internal
}  // namespace uncertainty
}  // namespace cartographer_ext
