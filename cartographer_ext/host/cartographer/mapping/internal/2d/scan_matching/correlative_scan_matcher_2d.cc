// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/correlative_scan_matcher_2d.h"

#include <algorithm>
#include <cmath>

#include "cartographer/common/math.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

namespace {

// The turn that moves the farthest point by a little less than one cell:
//   0.999 acos(1 - resolution^2 / (2 range^2)).
double AngularStep(const sensor::PointCloud& point_cloud,
                   const double resolution) {
  // Single precision, as the points are.
  std::vector<float> ranges = {static_cast<float>(3.f * resolution)};
  for (const sensor::RangefinderPoint& point : point_cloud) {
    ranges.push_back(point.position.head<2>().norm());
  }
  const float range = *std::max_element(ranges.begin(), ranges.end());
  return 0.999 *
         std::acos(1. - common::Pow2(resolution) / (2. * common::Pow2(range)));
}

int StepsToCover(const double window, const double step) {
  return static_cast<int>(std::ceil(window / step));
}

}  // namespace

SearchParameters::SearchParameters(const double linear_search_window,
                                   const double angular_search_window,
                                   const sensor::PointCloud& point_cloud,
                                   const double resolution)
    : SearchParameters(linear_search_window, angular_search_window,
                       AngularStep(point_cloud, resolution), resolution) {}

SearchParameters::SearchParameters(const double linear_search_window,
                                   const double angular_search_window,
                                   const double angular_step,
                                   const double resolution)
    : SearchParameters(StepsToCover(linear_search_window, resolution),
                       StepsToCover(angular_search_window, angular_step),
                       angular_step, resolution) {}

SearchParameters::SearchParameters(const int num_linear_perturbations,
                                   const int num_angular_perturbations,
                                   const double angular_perturbation_step_size,
                                   const double resolution)
    : num_angular_perturbations(num_angular_perturbations),
      angular_perturbation_step_size(angular_perturbation_step_size),
      resolution(resolution),
      num_scans(2 * num_angular_perturbations + 1) {
  const int reach = num_linear_perturbations;
  linear_bounds.assign(num_scans, LinearBounds{-reach, reach, -reach, reach});
}

Candidate2D::Candidate2D(const int scan_index, const int x_index_offset,
                         const int y_index_offset,
                         const SearchParameters& search_parameters)
    : scan_index(scan_index),
      x_index_offset(x_index_offset),
      y_index_offset(y_index_offset) {
  const double cell = search_parameters.resolution;
  const int steps = scan_index - search_parameters.num_angular_perturbations;
  x = -y_index_offset * cell;
  y = -x_index_offset * cell;
  orientation = steps * search_parameters.angular_perturbation_step_size;
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
