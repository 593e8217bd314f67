// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/submap_cells.h"

#include <algorithm>
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

enum class CellKind : uint8_t { kNotSeen, kFree, kOccupied, kNeither };

CellKind CellKindOf(const float occupancy) {
  return occupancy >= kOccupiedFrom ? CellKind::kOccupied
         : occupancy <= kFreeUpTo   ? CellKind::kFree
                                    : CellKind::kNeither;
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
    const ptrdiff_t width = box_.max_x - box_.min_x + 1;
    // From the row before, which a machine does for many cells at once, then
    // along the row.
    const auto lower = [far, width](uint8_t* const row,
                                    const uint8_t* const before) {
      for (ptrdiff_t i = 0; i < width; ++i) {
        const uint8_t nearest =
            std::min(before[i], std::min(before[i - 1], before[i + 1]));
        row[i] =
            std::min(std::min(row[i], far), static_cast<uint8_t>(nearest + 1));
      }
    };
    for (int iy = box_.min_y; iy <= box_.max_y; ++iy) {
      uint8_t* const row = At(box_.min_x, iy);
      lower(row, row - stride_);
      for (ptrdiff_t i = 0; i < width; ++i) {
        row[i] = std::min(row[i], static_cast<uint8_t>(row[i - 1] + 1));
      }
    }
    for (int iy = box_.max_y; iy >= box_.min_y; --iy) {
      uint8_t* const row = At(box_.min_x, iy);
      lower(row, row + stride_);
      for (ptrdiff_t i = width; i-- > 0;) {
        row[i] = std::min(row[i], static_cast<uint8_t>(row[i + 1] + 1));
      }
    }
  }

  // Makes each cell the least of those at most `radius` away.
  void TakeLeastWithin(const int radius) {
    std::vector<uint8_t> before;
    for (const ptrdiff_t step : {ptrdiff_t{1}, stride_}) {
      for (int k = 0; k < radius; ++k) {
        before = bytes_;
        for (int iy = box_.min_y; iy <= box_.max_y; ++iy) {
          uint8_t* const row = At(box_.min_x, iy);
          const uint8_t* const from = before.data() + (row - bytes_.data());
          for (ptrdiff_t i = 0; i <= box_.max_x - box_.min_x; ++i) {
            row[i] =
                std::min(from[i], std::min(from[i - step], from[i + step]));
          }
        }
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
constexpr double SubmapCells::kRounding;

SubmapCells::SubmapCells(SubmapGrid grid, const double margin)
    : grid_(std::move(grid)), radius_(InCells(margin)) {
  const int reach = std::max({1, radius_, InCells(kReach)});
  BoxBytes codes(AroundKnown(grid_, reach), kFar);
  const CellBox& box = codes.box();
  BoxBytes free(box, 1);  // and 0 where it is not, or unknown
  std::vector<CellKind> kinds(SubmapGrid::kNumValues, CellKind::kNotSeen);
  const TileLayout& tiles = grid_.tiles();
  for (int iy = box.min_y; iy <= box.max_y; ++iy) {
    for (int ix = box.min_x; ix <= box.max_x; ++ix) {
      // Cells of a tile where nothing is known are passed over.
      if (!grid_.HasTile(tiles.TileOf(ix, iy))) {
        const int end = std::min(box.max_x, ix | (TileLayout::kSide - 1)) + 1;
        std::fill_n(free.At(ix, iy), end - ix, uint8_t{0});
        ix = end - 1;
        continue;
      }
      const int value = grid_.Value(ix, iy);
      CellKind& kind = kinds[value];
      if (kind == CellKind::kNotSeen)
        kind = CellKindOf(grid_.OccupancyOf(value));
      if (kind == CellKind::kOccupied) *codes.At(ix, iy) = 0;
      if (kind != CellKind::kFree) *free.At(ix, iy) = 0;
    }
  }
  codes.MeasureDistances(kFar);
  free.TakeLeastWithin(radius_);
  for (int iy = box.min_y; iy <= box.max_y; ++iy) {
    uint8_t* const row = codes.At(box.min_x, iy);
    const uint8_t* const is_free = free.At(box.min_x, iy);
    for (int i = 0; i <= box.max_x - box.min_x; ++i) {
      if (is_free[i] != 0) row[i] |= kFree;
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
  codes_.insert(codes_.end(), 4, kFar);
  codes_.shrink_to_fit();
}

std::vector<int> SubmapCells::CountNearOccupied(
    const std::vector<Eigen::Vector2d>& points,
    const std::vector<Eigen::Vector2d>& shifts, const double tolerance) const {
  CHECK_LE(tolerance, kReach);
  const size_t num = shifts.size();
  const Eigen::Vector2d origin = Cell(Eigen::Vector2d::Zero());
  std::vector<Eigen::Vector2d> moves;  // in cells
  double farthest = 0.;                // of them, along an axis
  for (const Eigen::Vector2d& shift : shifts) {
    moves.push_back(Cell(shift) - origin);
    farthest = std::max(farthest, moves.back().cwiseAbs().maxCoeff());
  }
  const double limit = tolerance / resolution();
  const int most = static_cast<int>(std::floor(limit));
  std::vector<double> x(num + 3, 0.), y(num + 3, 0.);
  std::vector<int32_t> codes(num + 3);
  std::vector<int> counts(num, 0);
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d cell = Cell(point);
    if (ViewOfCell(cell).reach > farthest + limit) continue;
    for (size_t i = 0; i != num; ++i) {
      x[i] = cell.x() + moves[i].x();
      y[i] = cell.y() + moves[i].y();
    }
    FindCodes(x, y, num, &codes);
    for (size_t i = 0; i != num; ++i) counts[i] += (codes[i] & kFar) <= most;
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
