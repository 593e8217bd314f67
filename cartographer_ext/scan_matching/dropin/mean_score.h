// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Score of a scan in a grid of the host at a pose: the mean probability under
// its points, in [0, 1]; in a TSDF one minus the mean distance divided by the
// truncation distance. `pose` is (frame of the grid <- cloud). Zero without
// points.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_MEAN_SCORE_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_MEAN_SCORE_H_

#include <cmath>

#include "Eigen/Core"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace scan_matching {

// The score, see above.
inline double MeanScore(const Pose2& pose,
                        const cartographer::sensor::PointCloud& cloud,
                        const cartographer::mapping::Grid2D& grid) {
  if (cloud.empty()) return 0.;
  const bool is_tsdf =
      grid.GetGridType() == cartographer::mapping::GridType::TSDF;
  const float c = static_cast<float>(std::cos(pose.theta));
  const float s = static_cast<float>(std::sin(pose.theta));
  const float x = static_cast<float>(pose.x), y = static_cast<float>(pose.y);
  double sum = 0.;
  for (const auto& point : cloud) {
    const Eigen::Vector3f& p = point.position;
    const Eigen::Array2i cell = grid.limits().GetCellIndex(
        Eigen::Vector2f(x + c * p.x() - s * p.y(), y + s * p.x() + c * p.y()));
    const double cost = grid.GetCorrespondenceCost(cell);
    sum += is_tsdf ? 1. - std::abs(cost) / grid.GetMaxCorrespondenceCost()
                   : 1. - cost;
  }
  return sum / static_cast<double>(cloud.size());
}

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_MEAN_SCORE_H_
