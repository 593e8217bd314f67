// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/submap_cells.h"

#include <array>
#include <cmath>
#include <utility>

#include "glog/logging.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr float kOccupiedFrom = 0.6f;
constexpr float kFreeUpTo = 0.4f;
constexpr float kUnknownProbability = 0.1f;

// Rounded to a byte.
double RoundedProbability(const float occupancy) {
  return static_cast<double>(
             std::lround(255.f * (std::isnan(occupancy) ? kUnknownProbability
                                                        : occupancy))) /
         255.;
}

// The box of what is known and so many cells around it, within the grid.
CellBox AroundKnown(const SubmapGrid& grid, const int cells) {
  const CellBox& known = grid.known_box();
  if (known.empty()) return known;
  return {std::max(0, known.min_x - cells),
          std::min(grid.num_x() - 1, known.max_x + cells),
          std::max(0, known.min_y - cells),
          std::min(grid.num_y() - 1, known.max_y + cells)};
}

}  // namespace

// A byte for each cell of a box, and a border so that all have neighbours.
class SubmapCells::BoxBytes {
 public:
  BoxBytes(const CellBox& box, const uint8_t value)
      : box_(box),
        stride_(box.max_x - box.min_x + 3),
        bytes_(stride_ * (box.max_y - box.min_y + 3), value) {}

  const CellBox& box() const { return box_; }
  uint8_t* At(const int ix, const int iy) {
    return &bytes_[(iy - box_.min_y + 1) * stride_ + (ix - box_.min_x + 1)];
  }

  // Makes each cell its distance to the nearest that is 0, at most `far`, which
  // the others are.
  void MeasureDistances(const uint8_t far) {
    const auto lower = [far](uint8_t* const cell, const ptrdiff_t row,
                             const ptrdiff_t column) {
      const int nearest = std::min(std::min(cell[column], cell[row]),
                                   std::min(cell[row - 1], cell[row + 1]));
      *cell = static_cast<uint8_t>(
          std::min(std::min<int>(*cell, far), nearest + 1));
    };
    for (int iy = box_.min_y; iy <= box_.max_y; ++iy) {
      uint8_t* cell = At(box_.min_x, iy);
      for (int ix = box_.min_x; ix <= box_.max_x; ++ix) {
        lower(cell++, -stride_, -1);
      }
    }
    for (int iy = box_.max_y; iy >= box_.min_y; --iy) {
      uint8_t* cell = At(box_.max_x, iy);
      for (int ix = box_.max_x; ix >= box_.min_x; --ix) {
        lower(cell--, stride_, 1);
      }
    }
  }

 private:
  const CellBox box_;
  const ptrdiff_t stride_;
  std::vector<uint8_t> bytes_;
};

constexpr double SubmapCells::kReach;
constexpr uint8_t SubmapCells::kFar;
constexpr uint8_t SubmapCells::kFree;

SubmapCells::SubmapCells(SubmapGrid grid, const double margin)
    : grid_(std::move(grid)), radius_(InCells(margin)) {
  const int reach = std::max({1, radius_, InCells(kReach)});
  BoxBytes codes(AroundKnown(grid_, reach), kFar);
  const CellBox& box = codes.box();
  BoxBytes to_not_free(box, kFar);
  for (int iy = box.min_y; iy <= box.max_y; ++iy) {
    for (int ix = box.min_x; ix <= box.max_x; ++ix) {
      const float occupancy = grid_.Occupancy(ix, iy);
      if (occupancy >= kOccupiedFrom) *codes.At(ix, iy) = 0;
      // Also where it is unknown.
      if (!(occupancy <= kFreeUpTo)) *to_not_free.At(ix, iy) = 0;
    }
  }
  codes.MeasureDistances(kFar);
  to_not_free.MeasureDistances(kFar);
  for (int iy = box.min_y; iy <= box.max_y; ++iy) {
    for (int ix = box.min_x; ix <= box.max_x; ++ix) {
      if (*to_not_free.At(ix, iy) > radius_) *codes.At(ix, iy) |= kFree;
    }
  }
  TakeTiles(&codes, reach);
}

void SubmapCells::TakeTiles(BoxBytes* const codes, const int reach) {
  const TileLayout& tiles = grid_.tiles();
  const CellBox& box = codes->box();
  begins_.reserve(tiles.size());
  std::array<uint8_t, TileLayout::kArea> tile_codes;
  for (size_t tile = 0; tile != tiles.size(); ++tile) {
    const CellBox cells = tiles.CellsOf(tile);
    const CellBox inside = cells.Intersection(box);
    // Of the cells beyond the box, if there are any.
    int nearest = inside == cells || box.empty()
                      ? kFar
                      : std::min<int>(kFar, reach + 1 + cells.Gap(box));
    tile_codes.fill(static_cast<uint8_t>(nearest));
    for (int iy = inside.min_y; iy <= inside.max_y; ++iy) {
      for (int ix = inside.min_x; ix <= inside.max_x; ++ix) {
        const uint8_t code = *codes->At(ix, iy);
        tile_codes[TileLayout::CellInTile(ix, iy)] = code;
        nearest = std::min(nearest, code & kFar);
      }
    }
    if (grid_.HasTile(tile) || nearest <= reach) {
      begins_.push_back(static_cast<int32_t>(codes_.size()));
      codes_.insert(codes_.end(), tile_codes.begin(), tile_codes.end());
    } else {
      begins_.push_back(-nearest);
    }
  }
  codes_.shrink_to_fit();
}

bool SubmapCells::NearOccupied(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d cell = Cell(point);
  return IsInside(cell) && (Code(cell) & kFar) <= radius_;
}

std::vector<int> SubmapCells::CountNearOccupied(
    const std::vector<Eigen::Vector2d>& points,
    const std::vector<Eigen::Vector2d>& shifts, const double tolerance) const {
  CHECK_LE(tolerance, kReach);
  std::vector<Eigen::Vector2d> cells;
  for (const Eigen::Vector2d& point : points) cells.push_back(Cell(point));
  const Eigen::Vector2d origin = Cell(Eigen::Vector2d::Zero());
  const double limit = tolerance / resolution();
  std::vector<int> counts;
  for (const Eigen::Vector2d& shift : shifts) {
    const Eigen::Vector2d moved = Cell(shift) - origin;
    int count = 0;
    for (const Eigen::Vector2d& cell : cells) {
      const Eigen::Vector2d there = cell + moved;
      count += IsInside(there) && (Code(there) & kFar) <= limit;
    }
    counts.push_back(count);
  }
  return counts;
}

double SubmapCells::Score(const std::vector<Eigen::Vector2d>& points,
                          const Pose2& local_from_node) const {
  if (points.empty()) return 0.;
  double sum = 0.;
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d cell = Cell(local_from_node * point);
    sum += IsInside(cell)
               ? RoundedProbability(grid_.Occupancy(static_cast<int>(cell.x()),
                                                    static_cast<int>(cell.y())))
               : kUnknownProbability;
  }
  return sum / static_cast<double>(points.size());
}

std::vector<Eigen::Vector2d> SubmapCells::OccupiedCells() const {
  std::vector<Eigen::Vector2d> result;
  for (int iy = 0; iy < grid_.num_y(); ++iy) {
    for (int ix = 0; ix < grid_.num_x(); ++ix) {
      if (Code(ix, iy) != 0) continue;
      result.emplace_back(max_corner().x() - (iy + 0.5) * resolution(),
                          max_corner().y() - (ix + 0.5) * resolution());
    }
  }
  return result;
}

// The small addition rounds half a cell up, whatever the rounding error.
int SubmapCells::InCells(const double metres) const {
  return static_cast<int>(
      std::lround(std::min(std::max(0., metres / resolution() + 1e-6),
                           static_cast<double>(kFar - 1))));
}

}  // namespace evaluation
}  // namespace cartographer_ext
