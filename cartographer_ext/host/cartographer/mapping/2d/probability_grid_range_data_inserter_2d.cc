// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/probability_grid_range_data_inserter_2d.h"

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/internal/2d/ray_to_pixel_mask.h"
#include "cartographer/mapping/probability_values.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

// Ray ends are placed on a grid this many times finer than the cells.
constexpr int kSubpixelScale = 1000;
// Keeps points on the border of the grid inside it, in metres.
constexpr float kBorder = 1e-6f;

Eigen::AlignedBox2f BoundingBox(const sensor::RangeData& range_data) {
  Eigen::AlignedBox2f box(Eigen::Vector2f(range_data.origin.head<2>()));
  for (const sensor::PointCloud* cloud :
       {&range_data.returns, &range_data.misses}) {
    for (const sensor::RangefinderPoint& point : *cloud) {
      if (point.position.head<2>().allFinite()) {
        box.extend(Eigen::Vector2f(point.position.head<2>()));
      }
    }
  }
  return box;
}

// Indices on the fine grid of the finite points of a cloud.
std::vector<Eigen::Array2i> FineIndices(const MapLimits& fine_limits,
                                        const sensor::PointCloud& cloud) {
  std::vector<Eigen::Array2i> indices;
  indices.reserve(cloud.size());
  for (const sensor::RangefinderPoint& point : cloud) {
    if (point.position.head<2>().allFinite()) {
      indices.push_back(fine_limits.GetCellIndex(point.position.head<2>()));
    }
  }
  return indices;
}

}  // namespace

proto::ProbabilityGridRangeDataInserterOptions2D
CreateProbabilityGridRangeDataInserterOptions2D(
    common::LuaParameterDictionary* const table) {
  proto::ProbabilityGridRangeDataInserterOptions2D options;
  options.set_insert_free_space(true);
  common::ReadFields(table, &options, {"insert_free_space"});
  CHECK_GT(options.hit_probability(), 0.5);
  CHECK_LT(options.miss_probability(), 0.5);
  return options;
}

ProbabilityGridRangeDataInserter2D::ProbabilityGridRangeDataInserter2D(
    const proto::ProbabilityGridRangeDataInserterOptions2D& options)
    : options_(options),
      hit_table_(ComputeLookupTableToApplyCorrespondenceCostOdds(
          Odds(options.hit_probability()))),
      miss_table_(ComputeLookupTableToApplyCorrespondenceCostOdds(
          Odds(options.miss_probability()))) {}

void ProbabilityGridRangeDataInserter2D::Insert(
    const sensor::RangeData& range_data, GridInterface* const grid) const {
  ProbabilityGrid* const probability_grid = static_cast<ProbabilityGrid*>(grid);
  CHECK(probability_grid != nullptr);
  if (!range_data.origin.head<2>().allFinite()) return;

  const Eigen::AlignedBox2f box = BoundingBox(range_data);
  const Eigen::Vector2f border = Eigen::Vector2f::Constant(kBorder);
  probability_grid->GrowLimits(box.min() - border);
  probability_grid->GrowLimits(box.max() + border);

  const MapLimits& limits = probability_grid->limits();
  const MapLimits fine_limits(
      limits.resolution() / kSubpixelScale, limits.max(),
      CellLimits(limits.cell_limits().num_x_cells * kSubpixelScale,
                 limits.cell_limits().num_y_cells * kSubpixelScale));
  const ProbabilityGrid::Updater updater(probability_grid);
  const int stride = updater.stride();
  Eigen::AlignedBox2i known_cells;

  // Hits go first: a cell takes part once per insertion.
  const std::vector<Eigen::Array2i> ends =
      FineIndices(fine_limits, range_data.returns);
  for (const Eigen::Array2i& end : ends) {
    const Eigen::Array2i cell = end / kSubpixelScale;
    known_cells.extend(cell.matrix());
    updater.Apply(stride * cell.y() + cell.x(), hit_table_.data());
  }

  if (options_.insert_free_space()) {
    const Eigen::Array2i begin =
        fine_limits.GetCellIndex(range_data.origin.head<2>());
    const auto apply_miss = [&](const int x, const int y) {
      updater.Apply(stride * y + x, miss_table_.data());
    };
    const std::vector<Eigen::Array2i> empty_ends =
        FineIndices(fine_limits, range_data.misses);
    if (!ends.empty() || !empty_ends.empty()) {
      known_cells.extend((begin / kSubpixelScale).matrix());
    }
    for (const Eigen::Array2i& end : ends) {
      VisitRayPixels(begin, end, kSubpixelScale, apply_miss);
    }
    for (const Eigen::Array2i& end : empty_ends) {
      known_cells.extend((end / kSubpixelScale).matrix());
      VisitRayPixels(begin, end, kSubpixelScale, apply_miss);
    }
  }
  if (!known_cells.isEmpty()) updater.ExtendKnownCells(known_cells);
  probability_grid->FinishUpdate();
}

}  // namespace mapping
}  // namespace cartographer
