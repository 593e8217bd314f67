// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes the options in a stored map. They come from untrusted files, so
// nothing here aborts.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_STORED_OPTIONS_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_STORED_OPTIONS_H_

#include <string>
#include <vector>

#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"

namespace cartographer_ext {
namespace evaluation {

// The blocks of cartographer_ext, one per line: the part of the options that
// has one, and its values; unknown blocks and those that cannot be decoded are
// listed with their size. Empty if there are none.
std::vector<std::string> DescribeBlocks(
    const cartographer::mapping::proto::TrajectoryBuilderOptions& options);

// Keys that differ between the options of the same trajectories, one per line,
// such as "trajectory 0, trajectory_builder_2d_options.max_range: 30 -> 25".
// Trajectories in only one of them are listed as well. At most `max_lines`.
std::vector<std::string> DescribeOptionDifferences(
    const cartographer::mapping::proto::AllTrajectoryBuilderOptions& first,
    const cartographer::mapping::proto::AllTrajectoryBuilderOptions& second,
    size_t max_lines);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_STORED_OPTIONS_H_
