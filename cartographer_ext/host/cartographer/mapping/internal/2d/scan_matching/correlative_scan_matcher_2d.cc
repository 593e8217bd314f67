// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/correlative_scan_matcher_2d.h"

#include <algorithm>
#include <cmath>

#include "cartographer/common/math.h"
#include "cartographer/transform/rigid_transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

SearchParameters::SearchParameters(const double linear_search_window,
                                   const double angular_search_window,
                                   const sensor::PointCloud& point_cloud,
                                   const double resolution)
    : resolution(resolution) {
  // Single precision, as the points are.
  float range = 3.f * resolution;
  for (const sensor::RangefinderPoint& point : point_cloud) {
    range = std::max(range, point.position.head<2>().norm());
  }
  angular_perturbation_step_size =
      0.999 *
      std::acos(1. - common::Pow2(resolution) / (2. * common::Pow2(range)));
  num_angular_perturbations = static_cast<int>(
      std::ceil(angular_search_window / angular_perturbation_step_size));
  num_scans = 2 * num_angular_perturbations + 1;
  const int cells =
      static_cast<int>(std::ceil(linear_search_window / resolution));
  linear_bounds.assign(num_scans, LinearBounds{-cells, cells, -cells, cells});
}

SearchParameters::SearchParameters(const int num_linear_perturbations,
                                   const int num_angular_perturbations,
                                   const double angular_perturbation_step_size,
                                   const double resolution)
    : num_angular_perturbations(num_angular_perturbations),
      angular_perturbation_step_size(angular_perturbation_step_size),
      resolution(resolution),
      num_scans(2 * num_angular_perturbations + 1),
      linear_bounds(
          num_scans,
          LinearBounds{-num_linear_perturbations, num_linear_perturbations,
                       -num_linear_perturbations, num_linear_perturbations}) {}

void SearchParameters::ShrinkToFit(const std::vector<DiscreteScan2D>& scans,
                                   const CellLimits& cell_limits) {
  CHECK_EQ(scans.size(), num_scans);
  const Eigen::Array2i last_cell(cell_limits.num_x_cells - 1,
                                 cell_limits.num_y_cells - 1);
  for (int i = 0; i != num_scans; ++i) {
    // Moving the scan's far end to the near border of the grid, and back.
    Eigen::Array2i lowest = Eigen::Array2i::Zero();
    Eigen::Array2i highest = Eigen::Array2i::Zero();
    for (const Eigen::Array2i& cell : scans[i]) {
      lowest = lowest.min(-cell);
      highest = highest.max(last_cell - cell);
    }
    LinearBounds& bounds = linear_bounds[i];
    bounds.min_x = std::max(bounds.min_x, lowest.x());
    bounds.min_y = std::max(bounds.min_y, lowest.y());
    bounds.max_x = std::min(bounds.max_x, highest.x());
    bounds.max_y = std::min(bounds.max_y, highest.y());
  }
}

std::vector<sensor::PointCloud> GenerateRotatedScans(
    const sensor::PointCloud& point_cloud,
    const SearchParameters& search_parameters) {
  std::vector<sensor::PointCloud> scans;
  scans.reserve(search_parameters.num_scans);
  const double step = search_parameters.angular_perturbation_step_size;
  // Summed up, not multiplied: rounding decides between cells.
  double angle = -search_parameters.num_angular_perturbations * step;
  while (static_cast<int>(scans.size()) != search_parameters.num_scans) {
    const Eigen::AngleAxisf rotation(static_cast<float>(angle),
                                     Eigen::Vector3f::UnitZ());
    scans.push_back(sensor::TransformPointCloud(
        point_cloud, transform::Rigid3f::Rotation(rotation)));
    angle += step;
  }
  return scans;
}

std::vector<DiscreteScan2D> DiscretizeScans(
    const MapLimits& map_limits, const std::vector<sensor::PointCloud>& scans,
    const Eigen::Translation2f& initial_translation) {
  std::vector<DiscreteScan2D> discrete_scans(scans.size());
  for (size_t i = 0; i != scans.size(); ++i) {
    discrete_scans[i].reserve(scans[i].size());
    for (const sensor::RangefinderPoint& point : scans[i]) {
      const Eigen::Vector2f moved =
          point.position.head<2>() + initial_translation.vector();
      discrete_scans[i].push_back(map_limits.GetCellIndex(moved));
    }
  }
  return discrete_scans;
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
