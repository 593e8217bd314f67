// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The surroundings of the robot as one distance map: what the finished map, the
// obstacle layer and the latest scan say together.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_LOCAL_OBSTACLES_H_
#define CARTOGRAPHER_EXT_NAVIGATION_LOCAL_OBSTACLES_H_

#include <cmath>
#include <vector>

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer_ext/navigation/costmap.h"
#include "cartographer_ext/navigation/footprint.h"
#include "cartographer_ext/navigation/obstacle_layer.h"

namespace cartographer_ext {
namespace navigation {

// A place near the robot with more room around it.
struct WiderPlace {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // map frame
  double clearance = 0.;  // metres from the outline there
};

class LocalObstacles {
 public:
  // A square window of 2 `half_width` metres around `center` (map frame).
  // `layer` may be null; echoes (map frame) that are not finite are ignored.
  LocalObstacles(const Costmap& costmap, const ObstacleLayer* layer,
                 const std::vector<Eigen::Vector2d>& echoes,
                 const Eigen::Vector2d& center, double half_width);

  // Metres from a point to the centre of the nearest obstacle cell, by bilinear
  // interpolation between the centres of cells: in steps of a cell, driving past
  // an obstacle and driving at it would look alike. 0 outside the window.
  double Distance(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d p = geometry_->ToGrid(point);
    const double x = p.x() - 0.5 - first_.x, y = p.y() - 0.5 - first_.y;
    if (!(x >= 0. && y >= 0. && x < width_ - 1 && y < width_ - 1)) return 0.;
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const float* const low = &distances_[row * width_ + column];
    const float* const high = low + width_;
    const double right = x - column, up = y - row;
    return (1. - up) * ((1. - right) * low[0] + right * low[1]) +
           up * ((1. - right) * high[0] + right * high[1]);
  }

  // Metres from the outline at `pose` (map <- robot) to the nearest obstacle;
  // negative inside.
  double Clearance(const Footprint& footprint, const Pose2& pose) const;

  // The place with the most room that a round robot reaches on a straight line
  // of a metre or less, staying `margin` metres off everything or, where it is
  // nearer already, coming no nearer. Nothing where no place has clearly more
  // room than the present one, `pose` (map <- robot).
  absl::optional<WiderPlace> FindWiderPlace(const Footprint& footprint,
                                            double margin,
                                            const Pose2& pose) const;

 private:
  const GridGeometry* geometry_;
  Cell first_;  // lower left cell of the window
  int width_ = 0;
  std::vector<float> distances_;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_LOCAL_OBSTACLES_H_
