// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_painter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "absl/strings/str_format.h"
#include "cartographer_ext/io/picture.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::Grid2D;

constexpr int kUnknownCell = 0;
constexpr int kMaxCellValue = 32767;
// Marks a cell that was touched in the current update; never meant for files.
constexpr int kUpdateMarker = 1 << 15;
constexpr double kMaxCells = 4e8;
// Limit for maps with few known cells: submaps that are far apart would make a
// small file expand to gigabytes. Even of a thin diagonal corridor, a fiftieth
// of the cells is known.
constexpr double kFreeCells = 1.6e7;
constexpr double kMaxCellsPerKnown = 64.;
constexpr float kSurface = 0.9f;
constexpr float kFree = 0.1f;

// Value of a cell between the bounds; false for an unknown one.
bool Decode(const int cell, const double lower, const double upper,
            double* value) {
  const int number = cell >= kUpdateMarker ? cell - kUpdateMarker : cell;
  if (number <= kUnknownCell || number > kMaxCellValue) return false;
  *value = lower + (number - 1) * (upper - lower) / (kMaxCellValue - 1);
  return true;
}

// The known cells as corners in the map frame. Returns their number.
int64_t AddKnownCells(const PlacedGrid& placed, io::PictureBounds* bounds) {
  const auto& limits = placed.grid->limits();
  const int num_x = limits.cell_limits().num_x_cells();
  const int num_y = limits.cell_limits().num_y_cells();
  int min_x = num_x, max_x = -1, min_y = num_y, max_y = -1;
  int64_t known = 0;
  for (int iy = 0; iy < num_y; ++iy) {
    for (int ix = 0; ix < num_x; ++ix) {
      if (std::isnan(Occupancy(*placed.grid, ix, iy))) continue;
      ++known;
      min_x = std::min(min_x, ix);
      max_x = std::max(max_x, ix);
      min_y = std::min(min_y, iy);
      max_y = std::max(max_y, iy);
    }
  }
  if (max_x < 0) return 0;
  // Cell ix runs against the y axis, iy against the x axis.
  const double resolution = limits.resolution();
  for (const int iy : {min_y, max_y + 1}) {
    for (const int ix : {min_x, max_x + 1}) {
      bounds->Add(placed.map_from_local *
                  Eigen::Vector2d(limits.max().x() - resolution * iy,
                                  limits.max().y() - resolution * ix));
    }
  }
  return known;
}

float LogOdds(const float probability) {
  return std::log(probability / (1.f - probability));
}

// Adds the log odds of one grid to the cells of the map that it covers.
void AddGrid(const PlacedGrid& placed, io::OccupancyMap* map) {
  const auto& limits = placed.grid->limits();
  const double resolution = limits.resolution();
  const int num_x = limits.cell_limits().num_x_cells();
  const int num_y = limits.cell_limits().num_y_cells();
  io::PictureBounds bounds;
  AddKnownCells(placed, &bounds);
  if (bounds.min_x > bounds.max_x) return;
  const auto index = [map](const double value, const double origin,
                           const int size) {
    return static_cast<int>(
        std::clamp((value - origin) / map->resolution, 0., size - 1.));
  };
  const int begin_x = index(bounds.min_x, map->origin.x, map->width);
  const int end_x = index(bounds.max_x, map->origin.x, map->width);
  const int begin_y = index(bounds.min_y, map->origin.y, map->height);
  const int end_y = index(bounds.max_y, map->origin.y, map->height);
  const Pose2 local_from_map = placed.map_from_local.Inverse();
  for (int y = begin_y; y <= end_y; ++y) {
    for (int x = begin_x; x <= end_x; ++x) {
      const Eigen::Vector2d local =
          local_from_map *
          Eigen::Vector2d(map->origin.x + (x + 0.5) * map->resolution,
                          map->origin.y + (y + 0.5) * map->resolution);
      const int iy = static_cast<int>(
          std::floor((limits.max().x() - local.x()) / resolution));
      const int ix = static_cast<int>(
          std::floor((limits.max().y() - local.y()) / resolution));
      if (ix < 0 || iy < 0 || ix >= num_x || iy >= num_y) continue;
      const float occupancy = Occupancy(*placed.grid, ix, iy);
      if (std::isnan(occupancy)) continue;
      float& cell = map->at(x, y);
      cell = (std::isnan(cell) ? 0.f : cell) + LogOdds(occupancy);
    }
  }
}

}  // namespace

float Occupancy(const Grid2D& grid, const int ix, const int iy) {
  const int index = grid.limits().cell_limits().num_x_cells() * iy + ix;
  double value = 0.;
  if (grid.has_tsdf_2d()) {
    const double truncation = grid.tsdf_2d().truncation_distance();
    if (!Decode(grid.cells(index), -truncation, truncation, &value)) {
      return io::OccupancyMap::Unknown();
    }
    return std::abs(value) <= 0.5 * grid.limits().resolution() ? kSurface
                                                               : kFree;
  }
  // Older files do not name their bounds.
  const bool named = grid.max_correspondence_cost() > 0.f;
  const double lower = named ? grid.min_correspondence_cost() : 0.1;
  const double upper = named ? grid.max_correspondence_cost() : 0.9;
  if (!Decode(grid.cells(index), lower, upper, &value)) {
    return io::OccupancyMap::Unknown();
  }
  return static_cast<float>(1. - value);
}

absl::Status CheckGrid(const Grid2D& grid) {
  const int64_t num_x = grid.limits().cell_limits().num_x_cells();
  const int64_t num_y = grid.limits().cell_limits().num_y_cells();
  if (num_x < 0 || num_y < 0 || num_x * num_y != grid.cells_size()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the grid has %d cells but limits of %d x %d",
                        grid.cells_size(), num_x, num_y));
  }
  if (!(grid.limits().resolution() > 0.) ||
      !std::isfinite(grid.limits().resolution()) ||
      !std::isfinite(grid.limits().max().x()) ||
      !std::isfinite(grid.limits().max().y())) {
    return absl::InvalidArgumentError(
        "the grid's resolution or corner is out of range");
  }
  const double lower = grid.min_correspondence_cost();
  const double upper = grid.max_correspondence_cost();
  if (!grid.has_tsdf_2d() && !(lower == 0. && upper == 0.) &&
      !(lower > 0. && lower < upper && upper < 1.)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the grid's correspondence costs %g to %g are not within (0, 1)", lower,
        upper));
  }
  return absl::OkStatus();
}

absl::StatusOr<io::OccupancyMap> PaintMap(const std::vector<PlacedGrid>& grids,
                                          const double resolution) {
  if (!(resolution > 0.) || !std::isfinite(resolution)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("resolution %g is not above 0", resolution));
  }
  io::PictureBounds bounds;
  double known = 0.;  // in cells of the map
  for (const PlacedGrid& placed : grids) {
    const absl::Status status = CheckGrid(*placed.grid);
    if (!status.ok()) return status;
    known += static_cast<double>(AddKnownCells(placed, &bounds)) *
             std::pow(placed.grid->limits().resolution() / resolution, 2);
  }
  if (bounds.min_x > bounds.max_x) {
    return absl::InvalidArgumentError("no submap has a known cell");
  }
  const double min_x = std::floor(bounds.min_x / resolution);
  const double min_y = std::floor(bounds.min_y / resolution);
  const double width = std::ceil(bounds.max_x / resolution) - min_x;
  const double height = std::ceil(bounds.max_y / resolution) - min_y;
  if (!(width * height <= kMaxCells)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the map would have %.0f x %.0f cells of %g m, more "
                        "than %g in total: use a coarser resolution",
                        width, height, resolution, kMaxCells));
  }
  if (width * height > kFreeCells + kMaxCellsPerKnown * known) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the map would have %.0f x %.0f cells of %g m, of which only %.0f are "
        "known: the submaps are too far apart; use a coarser resolution",
        width, height, resolution, known));
  }
  io::OccupancyMap map =
      io::OccupancyMap::Make(std::max(1, static_cast<int>(width)),
                             std::max(1, static_cast<int>(height)), resolution,
                             Pose2(min_x * resolution, min_y * resolution, 0.));
  for (const PlacedGrid& placed : grids) AddGrid(placed, &map);
  for (float& cell : map.occupancy) {
    if (!std::isnan(cell)) cell = 1.f / (1.f + std::exp(-cell));
  }
  return map;
}

}  // namespace evaluation
}  // namespace cartographer_ext
