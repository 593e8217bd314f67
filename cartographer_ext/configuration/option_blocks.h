// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Our blocks that this build supports, with their values in a configuration.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_OPTION_BLOCKS_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_OPTION_BLOCKS_H_

#include <vector>

#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/options/option_printing.h"

namespace cartographer_ext {
namespace evaluation {

// In the order of the data flow. Only blocks of swaps that the host library was
// built with.
std::vector<options::OptionBlock> OptionBlocks(
    const SlamConfiguration& configuration);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_OPTION_BLOCKS_H_
