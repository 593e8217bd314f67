// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// SearchInRealTime for the host's grids and clouds, with the method of the
// host's RealTimeCorrelativeScanMatcher2D and the same results.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_REAL_TIME_MATCHER_2D_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_REAL_TIME_MATCHER_2D_H_

#include <algorithm>

#include "Eigen/Core"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/internal/2d/scan_matching/real_time_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/proto/scan_matching/real_time_correlative_scan_matcher_options.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/scan_matching/correlative_search/real_time_search_2d.h"
#include "cartographer_ext/scan_matching/dropin/fast_correlative_matcher_2d.h"
#include "cartographer_ext/scan_matching/dropin/grid_rows.h"

namespace cartographer_ext {
namespace scan_matching {

// Costs to the steps of ProbabilityView::CopyRow.
struct RoundUp {
  void operator()(const float* const costs, const int count,
                  uint8_t* const steps) const {
    constexpr float kSteps = 255.f / (ProbabilityView::kMaxProbability -
                                      ProbabilityView::kMinProbability);
    BestSearchKernels().round_up(costs, ProbabilityView::kMaxProbability,
                                 kSteps, count, steps);
  }
};

// View of the host's probability grid for SearchInRealTime.
class ProbabilityGridView : public ProbabilityView {
 public:
  // The grid must outlive this.
  explicit ProbabilityGridView(
      const cartographer::mapping::ProbabilityGrid& grid)
      : grid_(grid) {}

  GridGeometry Geometry() const override {
    GridGeometry geometry;
    geometry.num_x = grid_.limits().cell_limits().num_x_cells;
    geometry.num_y = grid_.limits().cell_limits().num_y_cells;
    geometry.resolution = grid_.limits().resolution();
    geometry.max_x = grid_.limits().max().x();
    geometry.max_y = grid_.limits().max().y();
    return geometry;
  }

  OffsetBounds Known() const override {
    Eigen::Array2i offset;
    cartographer::mapping::CellLimits size;
    grid_.ComputeCroppedLimits(&offset, &size);
    return OffsetBounds{offset.x(), offset.x() + size.num_x_cells - 1,
                        offset.y(), offset.y() + size.num_y_cells - 1};
  }

  void CopyRow(const int y, const int x_begin, const int x_end,
               uint8_t* const values) const override {
    CopyBytes(grid_, x_begin, y, x_end - x_begin, RoundUp(), values);
  }

  float Probability(const int x, const int y) const override {
    return grid_.GetProbability({x, y});
  }

 private:
  const cartographer::mapping::ProbabilityGrid& grid_;
};

// Real-time correlative matcher. May be used by several threads at once.
class RealTimeMatcher2D {
 public:
  using Rigid2d = cartographer::transform::Rigid2d;
  using Options = cartographer::mapping::scan_matching::proto::
      RealTimeCorrelativeScanMatcherOptions;

  explicit RealTimeMatcher2D(const Options& options,
                             const SearchKernels* const kernels = nullptr)
      : stock_(options) {
    options_.window.linear = options.linear_search_window();
    options_.window.angular = options.angular_search_window();
    options_.translation_delta_cost_weight =
        options.translation_delta_cost_weight();
    options_.rotation_delta_cost_weight = options.rotation_delta_cost_weight();
    options_.kernels = kernels;
  }

  // As the host's matcher: poses are (local frame of the submap <- node);
  // returns the score. A TSDF is matched by the host's matcher; an empty cloud
  // gives the initial pose and a score of 0.
  double Match(const Rigid2d& initial_pose_estimate,
               const cartographer::sensor::PointCloud& point_cloud,
               const cartographer::mapping::Grid2D& grid,
               Rigid2d* const pose_estimate) const {
    const auto initial = ToUnwrappedPose2(initial_pose_estimate);
    if (point_cloud.empty()) {
      *pose_estimate = initial_pose_estimate;
      return 0.;
    }
    if (grid.GetGridType() ==
        cartographer::mapping::GridType::PROBABILITY_GRID) {
      const ProbabilityGridView view(
          static_cast<const cartographer::mapping::ProbabilityGrid&>(grid));
      const RealTimeSearchResult result =
          SearchInRealTime(options_, view, initial, ToPlanarCloud(point_cloud));
      if (result.complete) {
        *pose_estimate = ToRigid2d(result.pose);
        return result.score;
      }
    }
    return stock_.Match(initial_pose_estimate, point_cloud, grid,
                        pose_estimate);
  }

 private:
  RealTimeSearchOptions options_;
  const cartographer::mapping::scan_matching::RealTimeCorrelativeScanMatcher2D
      stock_;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_REAL_TIME_MATCHER_2D_H_
