// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact Euclidean distance transform of a grid by the algorithm of Meijster,
// Roerdink and Hesselink (2000): for every cell the distance to the nearest
// occupied one, centre to centre, in time linear in the number of cells. All
// arithmetic is on integers, so the squared distances are exact.
//
// Two places measure distances in a grid for themselves, and with reason:
// OccupancyView needs squared distances up to 11 cells only, in one byte a
// cell, for every submap that is verified; SubmapCells tolerates a number of
// rows and columns, which is the chessboard metric.
#ifndef CARTOGRAPHER_EXT_COMMON_DISTANCE_TRANSFORM_H_
#define CARTOGRAPHER_EXT_COMMON_DISTANCE_TRANSFORM_H_

#include <cstdint>
#include <limits>
#include <vector>

namespace cartographer_ext {

// Squared distance of a grid without any occupied cell.
constexpr int32_t kNoOccupiedCell = std::numeric_limits<int32_t>::max();

// Squared distances in cells, row by row, of a grid of width * height bytes in
// which non-zero means occupied. Sides of at most 20000 cells.
std::vector<int32_t> SquaredDistanceTransform(
    const std::vector<uint8_t>& occupied, int width, int height);

// The same in metres; infinity without any occupied cell.
std::vector<float> DistanceTransform(const std::vector<uint8_t>& occupied,
                                     int width, int height, double resolution);

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_DISTANCE_TRANSFORM_H_
