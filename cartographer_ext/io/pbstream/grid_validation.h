// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the grid of one submap: its limits fit its cells, and these have 15
// bits. Submaps are checked one by one, so that only one is held at a time.
#ifndef CARTOGRAPHER_EXT_IO_PBSTREAM_GRID_VALIDATION_H_
#define CARTOGRAPHER_EXT_IO_PBSTREAM_GRID_VALIDATION_H_

#include <string>
#include <vector>

#include "cartographer/mapping/proto/grid_2d.pb.h"

namespace cartographer_ext {
namespace io {

constexpr double kMaxCoordinate = 1e9;  // of a valid place, metres

// One sentence per problem, about `name`.
std::vector<std::string> FindGridProblems(
    const cartographer::mapping::proto::Grid2D& grid, const std::string& name);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_PBSTREAM_GRID_VALIDATION_H_
