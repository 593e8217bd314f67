// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_painter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "absl/strings/str_format.h"
#include "cartographer_ext/io/picture.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr double kMaxCells = 4e8;
// Limit for maps with few known cells: submaps that are far apart would make a
// small file expand to gigabytes. Even of a thin diagonal corridor, a fiftieth
// of the cells is known.
constexpr double kFreeCells = 1.6e7;
constexpr double kMaxCellsPerKnown = 64.;

// The corners of what is known, in the map frame.
void AddKnownCells(const PlacedGrid& placed, io::PictureBounds* bounds) {
  const SubmapGrid& grid = *placed.grid;
  const CellBox& known = grid.known_box();
  if (known.empty()) return;
  for (const int iy : {known.min_y, known.max_y + 1}) {
    for (const int ix : {known.min_x, known.max_x + 1}) {
      bounds->Add(
          placed.map_from_local *
          Eigen::Vector2d(grid.max_corner().x() - grid.resolution() * iy,
                          grid.max_corner().y() - grid.resolution() * ix));
    }
  }
}

// Log odds of the values of a grid, NaN for unknown cells; found when they are
// needed.
class LogOddsOfValues {
 public:
  explicit LogOddsOfValues(const SubmapGrid& grid)
      : grid_(grid),
        log_odds_(SubmapGrid::kNumValues,
                  std::numeric_limits<float>::quiet_NaN()) {}

  float At(const int ix, const int iy) {
    const int value = grid_.Value(ix, iy);
    float& log_odds = log_odds_[value];
    if (std::isnan(log_odds) && value != 0) {
      const float probability = grid_.OccupancyOf(value);
      log_odds = std::log(probability / (1.f - probability));
    }
    return log_odds;
  }

 private:
  const SubmapGrid& grid_;
  std::vector<float> log_odds_;
};

// Most of the box around what is known of a grid is not known: whether runs of
// cells of the map can be passed over.
class KnownNearby {
 public:
  // Cells of the map in a run.
  static constexpr int kRun = TileLayout::kSide;

  // Cells of the map, which has the resolution given, are placed in `grid`.
  KnownNearby(const SubmapGrid& grid, const double map_resolution)
      : grid_(grid),
        is_near_(grid.tiles().size(),
                 // Where a run is longer than two tiles, none is passed over.
                 map_resolution > 2. * grid.resolution()) {
    const TileLayout& tiles = grid.tiles();
    for (size_t tile = 0; tile != tiles.size(); ++tile) {
      if (!grid.HasTile(tile)) continue;
      const CellBox cells = tiles.CellsOf(tile);
      for (const int iy : {cells.min_y - 1, cells.min_y, cells.max_y + 1}) {
        for (const int ix : {cells.min_x - 1, cells.min_x, cells.max_x + 1}) {
          if (ix < 0 || iy < 0 || ix >= grid.num_x() || iy >= grid.num_y()) {
            continue;
          }
          is_near_[tiles.TileOf(ix, iy)] = 1;
        }
      }
    }
  }

  // Whether a cell may be known in a run whose middle lies here, in the local
  // frame: no cell of it is more than four cells of the map away, which is no
  // farther than the next tile.
  bool MayKnow(const Eigen::Vector2d& middle) const {
    const auto index = [this](const double offset, const int size) {
      return static_cast<int>(
          std::clamp(offset / grid_.resolution(), 0., size - 1.));
    };
    return is_near_[grid_.tiles().TileOf(
               index(grid_.max_corner().y() - middle.y(), grid_.num_x()),
               index(grid_.max_corner().x() - middle.x(), grid_.num_y()))] != 0;
  }

 private:
  const SubmapGrid& grid_;
  std::vector<uint8_t> is_near_;  // of each tile: it or one beside it is known
};

// Adds the log odds of one grid to the cells of the map that it covers.
void AddGrid(const PlacedGrid& placed, io::OccupancyMap* map) {
  const SubmapGrid& grid = *placed.grid;
  io::PictureBounds bounds;
  AddKnownCells(placed, &bounds);
  if (bounds.min_x > bounds.max_x) return;
  const auto index = [map](const double value, const double origin,
                           const int size) {
    return static_cast<int>(
        std::clamp((value - origin) / map->resolution, 0., size - 1.));
  };
  const int begin_x = index(bounds.min_x, map->origin.x, map->width);
  const int end_x = index(bounds.max_x, map->origin.x, map->width) + 1;
  const int begin_y = index(bounds.min_y, map->origin.y, map->height);
  const int end_y = index(bounds.max_y, map->origin.y, map->height) + 1;
  const Pose2 local_from_map = placed.map_from_local.Inverse();
  // `x` and `y` in cells of the map, whose middles are at halves.
  const auto local = [&](const double x, const double y) -> Eigen::Vector2d {
    return local_from_map *
           Eigen::Vector2d(map->origin.x + x * map->resolution,
                           map->origin.y + y * map->resolution);
  };
  LogOddsOfValues values(grid);
  const KnownNearby nearby(grid, map->resolution);
  const auto add = [&](const int x, const int y) {
    const Eigen::Vector2d place = local(x + 0.5, y + 0.5);
    const int iy = static_cast<int>(
        std::floor((grid.max_corner().x() - place.x()) / grid.resolution()));
    const int ix = static_cast<int>(
        std::floor((grid.max_corner().y() - place.y()) / grid.resolution()));
    if (ix < 0 || iy < 0 || ix >= grid.num_x() || iy >= grid.num_y()) return;
    const float log_odds = values.At(ix, iy);
    if (std::isnan(log_odds)) return;
    float& cell = map->at(x, y);
    cell = (std::isnan(cell) ? 0.f : cell) + log_odds;
  };
  constexpr int kRun = KnownNearby::kRun;
  for (int y = begin_y; y != end_y; ++y) {
    for (int run = begin_x; run < end_x; run += kRun) {
      if (!nearby.MayKnow(local(run + 0.5 * kRun, y + 0.5))) continue;
      for (int x = run; x < std::min(end_x, run + kRun); ++x) add(x, y);
    }
  }
}

}  // namespace

absl::StatusOr<io::OccupancyMap> PaintMap(const std::vector<PlacedGrid>& grids,
                                          const double resolution) {
  if (!(resolution > 0.) || !std::isfinite(resolution)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("resolution %g is not above 0", resolution));
  }
  io::PictureBounds bounds;
  double known = 0.;  // in cells of the map
  for (const PlacedGrid& placed : grids) {
    AddKnownCells(placed, &bounds);
    known += static_cast<double>(placed.grid->num_known()) *
             std::pow(placed.grid->resolution() / resolution, 2);
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
