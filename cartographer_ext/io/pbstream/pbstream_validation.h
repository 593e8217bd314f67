// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the consistency of the records of a state: references exist, grids
// have the declared number of cells, poses are valid.
#ifndef CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_VALIDATION_H_
#define CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_VALIDATION_H_

#include <string>
#include <vector>

#include "cartographer_ext/io/pbstream/pbstream_reader.h"

namespace cartographer_ext {
namespace io {

// One sentence per problem, in the order of the records; empty if there are
// none. At most `max_problems`.
//
// Checked: as many trajectories as options; ids are unique and not negative,
// indices and stamps of a trajectory grow; every record belongs to a trajectory
// of the pose graph, every submap and node has a global pose, constraints refer
// to existing submaps and nodes; poses are finite with unit quaternions;
// weights are finite and not negative; grids have limits that fit their cells
// and cells of 15 bits; point clouds can be unpacked; readings of a sensor are
// in order of time; stamps are AreHostTicks (common/host_ticks.h), so that
// whoever adds and subtracts them need not ask.
std::vector<std::string> FindPbstreamProblems(const Pbstream& pbstream,
                                              size_t max_problems = 100);

// Without those of the grids (grid_validation.h).
std::vector<std::string> FindProblemsBesideGrids(const Pbstream& pbstream,
                                                 size_t max_problems = 100);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_VALIDATION_H_
