// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the best pose of a scan in a grid within a large window, exactly, by
// branch and bound over ever coarser grids [Olson 2009; Hess et al. 2016,
// section V]. The coarser grids are made once per grid, hence "fast": each cell
// of level k holds the maximum of a square of 2^k x 2^k cells, so that a score
// on level k bounds the scores of all 4^k poses it covers.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_FAST_CORRELATIVE_SCAN_MATCHER_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_FAST_CORRELATIVE_SCAN_MATCHER_2D_H_

#include <memory>
#include <vector>

#include "Eigen/Core"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/common/port.h"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/correlative_scan_matcher_2d.h"
#include "cartographer/mapping/proto/scan_matching/fast_correlative_scan_matcher_options_2d.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

// Reads `linear_search_window` (metres), `angular_search_window` (radians) and
// `branch_and_bound_depth`.
proto::FastCorrelativeScanMatcherOptions2D
CreateFastCorrelativeScanMatcherOptions2D(
    common::LuaParameterDictionary* parameter_dictionary);

// Cell (x, y) holds the largest score, in 256 steps, found in the `width` x
// `width` cells of the grid that begin at (x, y). It reaches width - 1 cells
// beyond the low borders of the grid, where squares still touch it.
class PrecomputationGrid2D {
 public:
  // Of the first `limits` cells of `grid`. The last argument is scratch memory
  // in Cartographer and is not used here.
  PrecomputationGrid2D(const Grid2D& grid, const CellLimits& limits, int width,
                       std::vector<float>* reusable_intermediate_grid);

  // 0 to 255; 0 outside.
  int GetValue(const Eigen::Array2i& xy_index) const {
    const int x = xy_index.x() + width_ - 1;
    const int y = xy_index.y() + width_ - 1;
    if (static_cast<unsigned>(x) >= static_cast<unsigned>(num_x_cells_) ||
        static_cast<unsigned>(y) >= static_cast<unsigned>(num_y_cells_)) {
      return 0;
    }
    return cells_[y * num_x_cells_ + x];
  }

  // From [0, 255] to scores; fractions are allowed.
  float ToScore(const float value) const {
    return min_score_ + value * ((max_score_ - min_score_) / 255.f);
  }

  // Not part of Cartographer's interface.

  // The same with squares larger by `more` <= width.
  PrecomputationGrid2D Widened(int more) const;
  int width() const { return width_; }
  int num_x_cells() const { return num_x_cells_; }
  int num_y_cells() const { return num_y_cells_; }
  // Row by row; the first is for index (1 - width, 1 - width).
  const uint8* cells() const { return cells_.data(); }
  // Gives the cells' memory back; afterwards only ToScore and the sizes are of
  // use.
  void ReleaseCells() { std::vector<uint8>().swap(cells_); }

 private:
  PrecomputationGrid2D() = default;

  int width_ = 1;
  int num_x_cells_ = 0;
  int num_y_cells_ = 0;
  float min_score_ = 0.f;
  float max_score_ = 1.f;
  std::vector<uint8> cells_;
};

// Levels 0 to branch_and_bound_depth - 1.
class PrecomputationGridStack2D {
 public:
  PrecomputationGridStack2D(
      const Grid2D& grid,
      const proto::FastCorrelativeScanMatcherOptions2D& options);

  const PrecomputationGrid2D& Get(const int index) const {
    return precomputation_grids_[index];
  }
  int max_depth() const {
    return static_cast<int>(precomputation_grids_.size()) - 1;
  }

  // Not part of Cartographer's interface: forgets the cells of the coarsest
  // level, for a user who keeps them in another order.
  void ReleaseCoarsest() { precomputation_grids_.back().ReleaseCells(); }

 private:
  std::vector<PrecomputationGrid2D> precomputation_grids_;
};

// Copies what it needs of the grid. May be used by several threads at once.
class FastCorrelativeScanMatcher2D {
 public:
  FastCorrelativeScanMatcher2D(
      const Grid2D& grid,
      const proto::FastCorrelativeScanMatcherOptions2D& options);
  ~FastCorrelativeScanMatcher2D();
  FastCorrelativeScanMatcher2D(const FastCorrelativeScanMatcher2D&) = delete;
  FastCorrelativeScanMatcher2D& operator=(const FastCorrelativeScanMatcher2D&) =
      delete;

  // Searches the configured window around the initial pose (frame of the grid
  // <- frame of the cloud). True, with score and pose, when the best score is
  // above `min_score`; otherwise nothing is written.
  bool Match(const transform::Rigid2d& initial_pose_estimate,
             const sensor::PointCloud& point_cloud, float min_score,
             float* score, transform::Rigid2d* pose_estimate) const;

  // The same for every pose that leaves a point in the grid.
  bool MatchFullSubmap(const sensor::PointCloud& point_cloud, float min_score,
                       float* score, transform::Rigid2d* pose_estimate) const;

 private:
  class CoarseGrid;
  class Search;

  bool MatchWithSearchParameters(
      SearchParameters search_parameters,
      const transform::Rigid2d& initial_pose_estimate,
      const sensor::PointCloud& point_cloud, float min_score, float* score,
      transform::Rigid2d* pose_estimate) const;

  const proto::FastCorrelativeScanMatcherOptions2D options_;
  const MapLimits limits_;
  const std::unique_ptr<PrecomputationGridStack2D> grids_;
  const std::unique_ptr<const CoarseGrid> coarse_grid_;
};

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_FAST_CORRELATIVE_SCAN_MATCHER_2D_H_
