// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The options that a stored map keeps, in words. They come from files that
// nobody vouches for, so nothing here ends the program.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_STORED_OPTIONS_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_STORED_OPTIONS_H_

#include <string>
#include <vector>

#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"

namespace cartographer_ext {
namespace evaluation {

// The blocks of cartographer_ext, a line each: the part of the options that has
// one, and its values; blocks of unknown kind or that do not decode are named
// with their size. Empty where there are none.
std::vector<std::string> DescribeBlocks(
    const cartographer::mapping::proto::TrajectoryBuilderOptions& options);

// Keys that differ between the options of the same trajectories, a line each,
// such as "trajectory 0, trajectory_builder_2d_options.max_range: 30 -> 25".
// Trajectories that only one has are named, too. At most `max_lines`.
std::vector<std::string> DescribeOptionDifferences(
    const cartographer::mapping::proto::AllTrajectoryBuilderOptions& first,
    const cartographer::mapping::proto::AllTrajectoryBuilderOptions& second,
    size_t max_lines);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_STORED_OPTIONS_H_
