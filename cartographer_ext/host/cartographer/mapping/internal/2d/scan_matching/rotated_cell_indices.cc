// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/rotated_cell_indices.h"

#include <algorithm>
#include <cmath>

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

// Nearest integer, halves away from zero, as common::RoundToInt has it, but
// without a function call and safe for any number: what is far outside every
// grid (or NaN) stays far outside.
inline int RoundIndex(const double value) {
  constexpr double kFarAway = 1e8;
  // The largest number below 0.5, so that 0.49999999999999994 rounds to 0.
  constexpr double kAlmostHalf = 0.49999999999999994;
  // In this order NaN becomes the lower bound.
  const double bounded = std::min(kFarAway, std::max(-kFarAway, value));
  return static_cast<int>(bounded + std::copysign(kAlmostHalf, bounded));
}

struct Frame {
  float translation_x;
  float translation_y;
  double max_x;
  double max_y;
  double resolution;
};

// The operations of Eigen's quaternion-vector product in its order, without those
// that cannot change the result; then a cell index.
inline void Index(const float x, const float y, const float w, const float z,
                  const Frame& frame, int* const x_index, int* const y_index) {
  float u = -(z * y);
  float v = z * x;
  u += u;
  v += v;
  const float world_x = ((x + w * u) - z * v) + frame.translation_x;
  const float world_y = ((y + w * v) + z * u) + frame.translation_y;
  *x_index = RoundIndex((frame.max_y - world_y) / frame.resolution - 0.5);
  *y_index = RoundIndex((frame.max_x - world_x) / frame.resolution - 0.5);
}

}  // namespace

sensor::PointCloud RotateCloud(const sensor::PointCloud& point_cloud,
                               const transform::Rigid2d& pose) {
  const Eigen::AngleAxisf rotation(pose.rotation().cast<float>().angle(),
                                   Eigen::Vector3f::UnitZ());
  return sensor::TransformPointCloud(point_cloud,
                                     transform::Rigid3f::Rotation(rotation));
}

RotatedCellIndices::RotatedCellIndices(
    const sensor::PointCloud& point_cloud,
    const SearchParameters& search_parameters, const MapLimits& map_limits,
    const Eigen::Vector2d& initial_translation)
    : translation_x_(static_cast<float>(initial_translation.x())),
      translation_y_(static_cast<float>(initial_translation.y())),
      max_x_(map_limits.max().x()),
      max_y_(map_limits.max().y()),
      resolution_(map_limits.resolution()) {
  point_x_.reserve(point_cloud.size());
  point_y_.reserve(point_cloud.size());
  for (const sensor::RangefinderPoint& point : point_cloud) {
    point_x_.push_back(point.position.x());
    point_y_.push_back(point.position.y());
  }
  rotation_w_.reserve(search_parameters.num_scans);
  rotation_z_.reserve(search_parameters.num_scans);
  const double step = search_parameters.angular_perturbation_step_size;
  double angle = -search_parameters.num_angular_perturbations * step;
  for (int i = 0; i != search_parameters.num_scans; ++i) {
    const Eigen::Quaternionf rotation(
        Eigen::AngleAxisf(static_cast<float>(angle), Eigen::Vector3f::UnitZ()));
    rotation_w_.push_back(rotation.w());
    rotation_z_.push_back(rotation.z());
    angle += step;
  }
}

void RotatedCellIndices::ForRotation(const int rotation,
                                     int* __restrict const x,
                                     int* __restrict const y) const {
  const Frame frame{translation_x_, translation_y_, max_x_, max_y_,
                    resolution_};
  const float w = rotation_w_[rotation];
  const float z = rotation_z_[rotation];
  const float* __restrict const point_x = point_x_.data();
  const float* __restrict const point_y = point_y_.data();
  const int count = num_points();
  for (int i = 0; i < count; ++i) {
    Index(point_x[i], point_y[i], w, z, frame, x + i, y + i);
  }
}

void RotatedCellIndices::ForPoint(const int point, const int begin,
                                  const int end, int* __restrict const x,
                                  int* __restrict const y) const {
  const Frame frame{translation_x_, translation_y_, max_x_, max_y_,
                    resolution_};
  const float point_x = point_x_[point];
  const float point_y = point_y_[point];
  const float* __restrict const w = rotation_w_.data() + begin;
  const float* __restrict const z = rotation_z_.data() + begin;
  const int count = end - begin;
  for (int i = 0; i < count; ++i) {
    Index(point_x, point_y, w[i], z[i], frame, x + i, y + i);
  }
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
