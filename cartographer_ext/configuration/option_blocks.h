// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The blocks of ours that this build understands, with the values that a
// configuration gives them.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_OPTION_BLOCKS_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_OPTION_BLOCKS_H_

#include <vector>

#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/options/option_printing.h"

namespace cartographer_ext {
namespace evaluation {

// In the order in which data passes through them. Only blocks of swaps that the
// host library was built with.
std::vector<options::OptionBlock> OptionBlocks(
    const SlamConfiguration& configuration);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_OPTION_BLOCKS_H_
