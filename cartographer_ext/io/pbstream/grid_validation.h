// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the grid of one submap: its limits fit its cells, and these have 15
// bits. Submaps are checked one by one, so that only one is held at a time.
// What reads cells of a grid relies on these checks alone.
#ifndef CARTOGRAPHER_EXT_IO_PBSTREAM_GRID_VALIDATION_H_
#define CARTOGRAPHER_EXT_IO_PBSTREAM_GRID_VALIDATION_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer/mapping/proto/grid_2d.pb.h"

namespace cartographer_ext {
namespace io {

constexpr double kMaxCoordinate = 1e9;  // of a valid place, metres

// An error if the size does not fit the number of cells, or if cells, place or
// costs are no possible ones. What the cells hold is not looked at.
absl::Status CheckGridLayout(const cartographer::mapping::proto::Grid2D& grid);

// One sentence per problem of layout and cells, about `name`.
std::vector<std::string> FindGridProblems(
    const cartographer::mapping::proto::Grid2D& grid, const std::string& name);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_PBSTREAM_GRID_VALIDATION_H_
