// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A submap's grid as needed by loop verification: one byte per cell for free,
// occupied or unknown and the distance to the nearest occupied cell. It is a
// copy, so it is independent of the lifetime of the submap and of the host's
// grids.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_OCCUPANCY_VIEW_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_OCCUPANCY_VIEW_H_

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "Eigen/Core"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {

// State of a cell.
enum class CellState : uint8_t { kUnknown = 0, kFree = 1, kOccupied = 2 };

// A grid of cell states with distances, see above.
class OccupancyView {
 public:
  // Cell (i, j) covers the square from `origin` + resolution * (i, j) to
  // `origin` + resolution * (i + 1, j + 1); metres, in the frame of the view.
  // All cells are unknown.
  OccupancyView(const Eigen::Vector2d& origin, double resolution, int num_x,
                int num_y)
      : origin_(origin),
        resolution_(resolution),
        num_x_(num_x),
        num_y_(num_y),
        cells_(static_cast<size_t>(num_x) * static_cast<size_t>(num_y), kFar) {
    CHECK_GT(resolution, 0.);
    CHECK_GE(num_x, 0);
    CHECK_GE(num_y, 0);
  }

  const Eigen::Vector2d& origin() const { return origin_; }
  double resolution() const { return resolution_; }
  int num_x() const { return num_x_; }
  int num_y() const { return num_y_; }

  bool Contains(int i, int j) const {
    return i >= 0 && j >= 0 && i < num_x_ && j < num_y_;
  }
  // Cells outside are unknown.
  CellState At(int i, int j) const {
    if (!Contains(i, j)) return CellState::kUnknown;
    const uint8_t cell = cells_[Offset(i, j)];
    if ((cell & kKnown) == 0) return CellState::kUnknown;
    return cell == kKnown ? CellState::kOccupied : CellState::kFree;
  }
  // Invalidates the distances.
  void Set(int i, int j, CellState state) {
    CHECK(Contains(i, j));
    cells_[Offset(i, j)] = state == CellState::kUnknown ? kFar
                           : state == CellState::kFree  ? kKnown | kFar
                                                        : kKnown;
  }

  // Largest distance that a cell can store, in cells.
  static constexpr int kMaxReach = 11;
  // Squared distance of cells without an occupied cell within the reach.
  static constexpr uint8_t kFar = 127;
  // Finds the distances from every cell, known or not, to the nearest occupied
  // one, exactly within `reach` cells (at most kMaxReach).
  void FindDistances(int reach);
  // In squared cells, between the centres of the cells; kFar if no occupied
  // cell is within the reach, outside the view, and before `FindDistances`.
  uint8_t SquaredDistance(int i, int j) const {
    return Contains(i, j) ? cells_[Offset(i, j)] & kFar : kFar;
  }

  size_t memory_bytes() const { return cells_.size(); }

 private:
  // The lower bits of a cell are its squared distance, 0 if it is occupied.
  static constexpr uint8_t kKnown = 128;

  size_t Offset(int i, int j) const {
    return static_cast<size_t>(j) * static_cast<size_t>(num_x_) +
           static_cast<size_t>(i);
  }

  Eigen::Vector2d origin_;
  double resolution_;
  int num_x_;
  int num_y_;
  std::vector<uint8_t> cells_;
};

// Limits of a cast ray.
struct RayOptions {
  double max_range = 10.;  // metres, > 0
  // A ray that crosses more unknown space than this has no result.
  double max_unknown = 0.15;  // metres, >= 0
};

// Distance in metres from `start` along `angle` (radians, frame of the view) to
// where the ray enters the first occupied cell; `max_range` when everything up
// to there is free; NaN if it crosses too much unknown space, if the start is
// not in free space, or for arguments that are not finite.
double CastRay(const OccupancyView& view, const Eigen::Vector2d& start,
               double angle, const RayOptions& options);
// The same along a direction of length one.
double CastRay(const OccupancyView& view, const Eigen::Vector2d& start,
               const Eigen::Vector2d& direction, const RayOptions& options);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_OCCUPANCY_VIEW_H_
