// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the correlative matchers have in common: the search space of a pose
// (x, y, theta) around an initial one, in cells and angular steps.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_CORRELATIVE_SCAN_MATCHER_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_CORRELATIVE_SCAN_MATCHER_2D_H_

#include <vector>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer/mapping/2d/map_limits.h"
#include "cartographer/mapping/2d/xy_index.h"
#include "cartographer/sensor/point_cloud.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

// The cells a scan's points fall into.
typedef std::vector<Eigen::Array2i> DiscreteScan2D;

struct SearchParameters {
  // In cells, relative to the initial pose; both ends belong to the window.
  struct LinearBounds {
    int min_x;
    int max_x;
    int min_y;
    int max_y;
  };

  // Windows in metres and radians to either side. The angular step moves the
  // farthest point by a little less than one cell of `resolution` metres:
  //   0.999 * acos(1 - resolution^2 / (2 range^2)),  range >= 3 resolution.
  SearchParameters(double linear_search_window, double angular_search_window,
                   const sensor::PointCloud& point_cloud, double resolution);
  // With everything given.
  SearchParameters(int num_linear_perturbations, int num_angular_perturbations,
                   double angular_perturbation_step_size, double resolution);

  int num_angular_perturbations;
  double angular_perturbation_step_size;
  double resolution;
  int num_scans;                            // 2 * num_angular_perturbations + 1
  std::vector<LinearBounds> linear_bounds;  // one per scan

 private:
  SearchParameters(double linear_search_window, double angular_search_window,
                   double angular_step, double resolution);
};

// The cloud turned by every angle of the search, from negative to positive.
std::vector<sensor::PointCloud> GenerateRotatedScans(
    const sensor::PointCloud& point_cloud,
    const SearchParameters& search_parameters);

std::vector<DiscreteScan2D> DiscretizeScans(
    const MapLimits& map_limits, const std::vector<sensor::PointCloud>& scans,
    const Eigen::Translation2f& initial_translation);

// One pose of the search space.
struct Candidate2D {
  Candidate2D(int scan_index, int x_index_offset, int y_index_offset,
              const SearchParameters& search_parameters);

  int scan_index;
  int x_index_offset;
  int y_index_offset;

  // The same, relative to the initial pose, in metres and radians. Cell indices
  // count against the axes of the map, and x and y change places.
  double x;
  double y;
  double orientation;

  float score = 0.f;  // more is better

  bool operator<(const Candidate2D& other) const { return score < other.score; }
  bool operator>(const Candidate2D& other) const { return score > other.score; }
};

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_CORRELATIVE_SCAN_MATCHER_2D_H_
