// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Not part of Cartographer's interface. The same cells that
// GenerateRotatedScans followed by DiscretizeScans finds, bit for bit, but
// without building the rotated clouds: either all points for one rotation or
// all rotations for one point, in loops that compilers turn into vector
// instructions.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_ROTATED_CELL_INDICES_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_ROTATED_CELL_INDICES_H_

#include <vector>

#include "Eigen/Geometry"
#include "cartographer/mapping/2d/map_limits.h"
#include "cartographer/mapping/internal/2d/scan_matching/correlative_scan_matcher_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

// The cloud turned by the angle of `pose`, in single precision.
sensor::PointCloud RotateCloud(const sensor::PointCloud& point_cloud,
                               const transform::Rigid2d& pose);

class RotatedCellIndices {
 public:
  // `point_cloud` is already turned by the initial pose's angle.
  RotatedCellIndices(const sensor::PointCloud& point_cloud,
                     const SearchParameters& search_parameters,
                     const MapLimits& map_limits,
                     const Eigen::Vector2d& initial_translation);

  int num_points() const { return static_cast<int>(point_x_.size()); }
  int num_rotations() const { return static_cast<int>(rotation_w_.size()); }

  // Writes num_points() indices to each of `x` and `y`.
  void ForRotation(int rotation, int* x, int* y) const;
  // Writes end - begin indices to each, for the rotations [begin, end).
  void ForPoint(int point, int begin, int end, int* x, int* y) const;

 private:
  std::vector<float> point_x_;
  std::vector<float> point_y_;
  // Unit quaternions about z.
  std::vector<float> rotation_w_;
  std::vector<float> rotation_z_;
  float translation_x_;
  float translation_y_;
  double max_x_;
  double max_y_;
  double resolution_;
};

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_ROTATED_CELL_INDICES_H_
