// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads cells of the host's grids along rows.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_GRID_ROWS_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_GRID_ROWS_H_

#include <algorithm>
#include <cstdint>
#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace scan_matching {

constexpr int kFewCells = 4;

namespace internal {

constexpr int kCellsAtOnce = 64;
constexpr int kNumValues = 32768;

// The bundled host copies runs of cells at once; Cartographer does not.
template <typename Grid>
auto CopyCosts(const Grid& grid, const int x, const int y, const int count,
               float* const costs, int)
    -> decltype(grid.CopyCorrespondenceCosts(x, y, count, costs)) {
  grid.CopyCorrespondenceCosts(x, y, count, costs);
}
template <typename Grid>
void CopyCosts(const Grid& grid, const int x, const int y, const int count,
               float* const costs, long) {  // NOLINT
  for (int i = 0; i != count; ++i) {
    costs[i] = grid.GetCorrespondenceCost(Eigen::Array2i(x + i, y));
  }
}

// Of few cells inside the grid, where the call above costs more than the cells.
template <typename Grid>
auto CopyFewCosts(const Grid& grid, const int x, const int y, const int count,
                  float* const costs, int)
    -> decltype(grid.value_to_correspondence_cost(), void()) {
  uint16_t buffer[kFewCells];
  const auto* const cells = grid.CellRun(x, y, count, buffer);
  const float* const value_to_cost = grid.value_to_correspondence_cost();
  for (int i = 0; i != count; ++i) costs[i] = value_to_cost[cells[i]];
}
template <typename Grid>
void CopyFewCosts(const Grid& grid, const int x, const int y, const int count,
                  float* const costs, long) {  // NOLINT
  CopyCosts(grid, x, y, count, costs, 0L);
}

// One byte for each value of the grid, made anew when the range of costs is
// another: the same value then stands for another cost.
template <typename ToBytes>
const uint8_t* BytesOfValues(const float* const value_to_cost,
                             const float min_cost, const float max_cost,
                             const ToBytes& to_bytes) {
  struct Table {
    float min_cost, max_cost;
    std::vector<uint8_t> bytes;
  };
  static thread_local Table table;
  if (table.bytes.empty() || table.min_cost != min_cost ||
      table.max_cost != max_cost) {
    table.min_cost = min_cost;
    table.max_cost = max_cost;
    table.bytes.resize(kNumValues);
    to_bytes(value_to_cost, kNumValues, table.bytes.data());
  }
  return table.bytes.data();
}
template <typename Grid, typename ToBytes>
auto CopyBytes(const Grid& grid, const int x, const int y, const int count,
               const ToBytes& to_bytes, uint8_t* bytes, int)
    -> decltype(grid.value_to_correspondence_cost(), void()) {
  const uint8_t* const table = BytesOfValues(
      grid.value_to_correspondence_cost(), grid.GetMinCorrespondenceCost(),
      grid.GetMaxCorrespondenceCost(), to_bytes);
  uint16_t buffer[kCellsAtOnce];
  for (int begin = 0; begin < count; begin += kCellsAtOnce) {
    const int num_cells = std::min(kCellsAtOnce, count - begin);
    const auto* const cells = grid.CellRun(x + begin, y, num_cells, buffer);
    for (int i = 0; i != num_cells; ++i)
      *bytes++ = table[cells[i] & (kNumValues - 1)];
  }
}
template <typename Grid, typename ToBytes>
void CopyBytes(const Grid& grid, const int x, const int y, const int count,
               const ToBytes& to_bytes, uint8_t* const bytes,
               long) {  // NOLINT
  float costs[kCellsAtOnce];
  for (int begin = 0; begin < count; begin += kCellsAtOnce) {
    const int num_cells = std::min(kCellsAtOnce, count - begin);
    CopyCosts(grid, x + begin, y, num_cells, costs, 0L);
    to_bytes(costs, num_cells, bytes + begin);
  }
}

}  // namespace internal

// GetCorrespondenceCost of `count` cells from (x, y) on with x growing, inside
// the grid or not.
template <typename Grid>
void CopyCosts(const Grid& grid, const int x, const int y, const int count,
               float* const costs) {
  internal::CopyCosts(grid, x, y, count, costs, 0);
}

// The same for at most kFewCells cells, all inside the grid.
template <typename Grid>
void CopyFewCosts(const Grid& grid, const int x, const int y, const int count,
                  float* const costs) {
  internal::CopyFewCosts(grid, x, y, count, costs, 0);
}

// What `to_bytes(costs, count, bytes)` makes of the costs of `count` cells from
// (x, y) on with x growing, all inside the grid. `ToBytes` has no state: what it
// makes of a cost is remembered.
template <typename Grid, typename ToBytes>
void CopyBytes(const Grid& grid, const int x, const int y, const int count,
               const ToBytes& to_bytes, uint8_t* const bytes) {
  internal::CopyBytes(grid, x, y, count, to_bytes, bytes, 0);
}

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_GRID_ROWS_H_
