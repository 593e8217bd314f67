// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// FastCorrelativeSearch2D for the host's grids and clouds, with the methods of
// the host's FastCorrelativeScanMatcher2D and the same results.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_FAST_CORRELATIVE_MATCHER_2D_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_FAST_CORRELATIVE_MATCHER_2D_H_

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "Eigen/Core"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/proto/scan_matching/fast_correlative_scan_matcher_options_2d.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"
#include "cartographer_ext/scan_matching/dropin/grid_rows.h"

namespace cartographer_ext {
namespace scan_matching {

// The host's options as those of the search.
inline FastCorrelativeSearchOptions ToSearchOptions(
    const cartographer::mapping::scan_matching::proto::
        FastCorrelativeScanMatcherOptions2D& options) {
  FastCorrelativeSearchOptions result;
  result.window.linear = options.linear_search_window();
  result.window.angular = options.angular_search_window();
  result.branch_and_bound_depth = options.branch_and_bound_depth();
  return result;
}

// The scores 1 - |correspondence cost| of a probability grid or TSDF in 256
// steps.
inline SearchGrid2D ToSearchGrid(const cartographer::mapping::Grid2D& grid) {
  const cartographer::mapping::MapLimits& limits = grid.limits();
  SearchGrid2D result;
  result.num_x = limits.cell_limits().num_x_cells;
  result.num_y = limits.cell_limits().num_y_cells;
  result.resolution = limits.resolution();
  result.max_x = limits.max().x();
  result.max_y = limits.max().y();
  result.min_score = 1.f - grid.GetMaxCorrespondenceCost();
  result.max_score = 1.f - grid.GetMinCorrespondenceCost();
  const float steps_per_score = 255.f / (result.max_score - result.min_score);
  result.values.resize(static_cast<size_t>(result.num_x) * result.num_y);
  uint8_t* value = result.values.data();
  std::vector<float> costs(result.num_x);
  for (int y = 0; y != result.num_y; ++y) {
    CopyCosts(grid, 0, y, result.num_x, costs.data());
    for (int x = 0; x != result.num_x; ++x) {
      const float score = 1.f - std::abs(costs[x]);
      // Rounds like lround: the sum is exact and not negative.
      const double step =
          static_cast<double>((score - result.min_score) * steps_per_score);
      *value++ = static_cast<uint8_t>(
          static_cast<int>(std::min(255., std::max(0., step)) + 0.5));
    }
  }
  return result;
}

// The x and y of the host's point cloud, metres.
inline PlanarCloud ToPlanarCloud(
    const cartographer::sensor::PointCloud& point_cloud) {
  PlanarCloud result;
  result.x.reserve(point_cloud.size());
  result.y.reserve(point_cloud.size());
  for (const auto& point : point_cloud) {
    result.x.push_back(point.position.x());
    result.y.push_back(point.position.y());
  }
  return result;
}

// Copies what it needs from the grid. May be used by several threads at once.
class FastCorrelativeMatcher2D {
 public:
  using PointCloud = cartographer::sensor::PointCloud;
  using Rigid2d = cartographer::transform::Rigid2d;

  FastCorrelativeMatcher2D(const cartographer::mapping::Grid2D& grid,
                           const FastCorrelativeSearchOptions& options)
      : search_(ToSearchGrid(grid), options) {}
  FastCorrelativeMatcher2D(const cartographer::mapping::Grid2D& grid,
                           const cartographer::mapping::scan_matching::proto::
                               FastCorrelativeScanMatcherOptions2D& options)
      : FastCorrelativeMatcher2D(grid, ToSearchOptions(options)) {}

  // As the host's matcher: true, with score and pose (local frame of the submap
  // <- node), when the best score of the window is above `min_score`; otherwise
  // nothing is written.
  bool Match(const Rigid2d& initial_pose_estimate,
             const PointCloud& point_cloud, const float min_score,
             float* const score, Rigid2d* const pose_estimate) const {
    return Unpack(search_.Match(ToUnwrappedPose2(initial_pose_estimate),
                                ToPlanarCloud(point_cloud), min_score),
                  score, pose_estimate);
  }
  bool MatchFullSubmap(const PointCloud& point_cloud, const float min_score,
                       float* const score, Rigid2d* const pose_estimate) const {
    return Unpack(search_.MatchFullSubmap(ToPlanarCloud(point_cloud), min_score,
                                          SearchBudget()),
                  score, pose_estimate);
  }

  // The same with a given window (half sizes in metres and radians), a budget,
  // and statistics.
  SearchResult Match(const Rigid2d& initial_pose_estimate,
                     const PointCloud& point_cloud, const SearchWindow& window,
                     const float min_score, const SearchBudget& budget) const {
    return search_.Match(ToUnwrappedPose2(initial_pose_estimate),
                         ToPlanarCloud(point_cloud), window, min_score, budget);
  }
  SearchResult MatchFullSubmap(const PointCloud& point_cloud,
                               const float min_score,
                               const SearchBudget& budget) const {
    return search_.MatchFullSubmap(ToPlanarCloud(point_cloud), min_score,
                                   budget);
  }

  // The search object, for SearchTask.
  const FastCorrelativeSearch2D& search() const { return search_; }
  size_t MemoryBytes() const { return search_.MemoryBytes(); }

 private:
  static bool Unpack(const SearchResult& result, float* const score,
                     Rigid2d* const pose_estimate) {
    if (!result.found) return false;
    *score = result.score;
    *pose_estimate = ToRigid2d(result.pose);
    return true;
  }

  const FastCorrelativeSearch2D search_;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_FAST_CORRELATIVE_MATCHER_2D_H_
