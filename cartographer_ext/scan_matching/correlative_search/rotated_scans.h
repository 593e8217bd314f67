// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The poses that a correlative matcher evaluates, and the cells of a scan at
// each of them, with exactly the arithmetic of Cartographer's matchers:
//
//  * The angular step moves the farthest point by a little less than a cell,
//    0.999 acos(1 - resolution^2 / (2 range^2)) with range >= 3 resolution;
//    2 n + 1 rotations cover the angular window, n = ceil(window / step).
//  * The cloud is turned by the initial angle, then by each of the rotations,
//    then moved by the initial translation, all in single precision; cells are
//    found in double precision.
//  * Offsets of whole cells cover the linear window, without those that put the
//    whole scan outside the grid; the offset (0, 0) always stays in.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_ROTATED_SCANS_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_ROTATED_SCANS_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/correlative_search/search_kernels.h"

namespace cartographer_ext {
namespace scan_matching {

// Points in the frame of the sensor, metres. Points that are not finite count
// as points outside the grid.
struct PlanarCloud {
  std::vector<float> x;
  std::vector<float> y;

  size_t size() const { return x.size(); }
  bool empty() const { return x.empty(); }
};

// Position of a grid. The centre of cell (ix, iy) is at
//   x = max_x - resolution * (iy + 0.5),  y = max_y - resolution * (ix + 0.5).
struct GridGeometry {
  int num_x = 0;
  int num_y = 0;
  double resolution = 0.;  // metres per cell
  double max_x = 0.;       // metres
  double max_y = 0.;
};

// Range of offsets in cells, inclusive.
struct OffsetBounds {
  int min_x;
  int max_x;
  int min_y;
  int max_y;

  bool Contains(const int x, const int y) const {
    return min_x <= x && x <= max_x && min_y <= y && y <= max_y;
  }
};

// The scan in one rotation.
struct RotatedScan {
  const int32_t* x = nullptr;  // cells at offset (0, 0), one per point
  const int32_t* y = nullptr;
  OffsetBounds cells = {0, 0, 0, 0};  // that the points are in
  OffsetBounds offsets = {0, 0, 0, 0};
};

// The rotations of a scan with its cells, computed on demand. Not thread-safe.
class RotatedScans {
 public:
  // Points are reordered: every fourth point, starting with the first, then
  // with the second, the third and the fourth. These parts are representative
  // of the whole scan, so one of them shows whether a pose is promising.
  static constexpr int kNumParts = 4;

  // Half sizes in metres and radians; `initial` is (grid <- cloud). The cloud
  // must not be empty and its two vectors equally long.
  // Cartographer's real-time matcher measures ranges after turning the cloud to
  // the initial angle, the other one before.
  enum class RangeOf { kCloud, kTurnedCloud };
  RotatedScans(const PlanarCloud& cloud, const Pose2& initial, double linear,
               double angular, const GridGeometry& geometry,
               const SearchKernels& kernels,
               RangeOf range_of = RangeOf::kCloud);

  // False if the window is too large to be searched: more than 2^24 rotations,
  // or offsets of more than 10^8 cells, or 2^31 cells in total.
  bool valid() const { return valid_; }

  int num_points() const { return static_cast<int>(turned_x_.size()); }
  int num_rotations() const { return static_cast<int>(angles_.size()); }
  double angular_step() const { return angular_step_; }
  // Half width of the window in cells, before it is limited by the grid.
  int linear_cells() const { return linear_cells_; }

  // Part `part` consists of points PartBegin(part) to PartBegin(part + 1) - 1.
  int PartBegin(const int part) const { return part_begin_[part]; }

  // Index at which point i of the cloud is stored.
  int PlaceOf(const int i) const {
    return first_of_turn_[i % kNumParts] + i / kNumParts;
  }

  // Maximum displacement of the point from one rotation to the next, in cells.
  double CellsPerStep(int point) const;
  // Part of that displacement that is due to rounding.
  double RoundingCells() const;

  // Position of the initial pose, in fractions of cells.
  double SensorCellX() const {
    return (geometry_.max_y - initial_.y) / geometry_.resolution - 0.5;
  }
  double SensorCellY() const {
    return (geometry_.max_x - initial_.x) / geometry_.resolution - 0.5;
  }

  // Writes num_points() cells to each of `x` and `y`.
  void FindCells(int rotation, int32_t* x, int32_t* y) const;

  // The smallest rectangle of cells with all (finite) points.
  OffsetBounds CellBounds(const int32_t* x, const int32_t* y) const;

  // The same as FindCells with bounds; computed once.
  const RotatedScan& Get(int rotation);

  // The valid offsets for points in these cells.
  OffsetBounds BoundsFor(const OffsetBounds& cells) const;

  // (grid <- cloud); the angle is not wrapped.
  Pose2 PoseOf(int rotation, int offset_x, int offset_y) const;

 private:
  void FindRanges();

  bool valid_ = false;
  bool all_finite_ = true;
  const Pose2 initial_;
  const GridGeometry geometry_;
  const SearchKernels& kernels_;
  double angular_step_ = 0.;
  int linear_cells_ = 0;
  double largest_range_ = 0.;
  int part_begin_[kNumParts + 1];
  int first_of_turn_[kNumParts];
  std::vector<float> turned_x_;
  std::vector<float> turned_y_;
  std::vector<float> ranges_;
  std::vector<float> angles_;
  std::vector<RotatedScan> scans_;
  std::vector<std::unique_ptr<int32_t[]>> storage_;
  size_t storage_left_ = 0;
  int32_t* next_storage_ = nullptr;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_ROTATED_SCANS_H_
