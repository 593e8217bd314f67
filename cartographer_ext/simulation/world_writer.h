// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A world as the text of a world file.
#ifndef CARTOGRAPHER_EXT_SIMULATION_WORLD_WRITER_H_
#define CARTOGRAPHER_EXT_SIMULATION_WORLD_WRITER_H_

#include <string>

#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

// Reading it back gives the same world with numbers of nine digits; writing
// that once more gives the same text. Blocks are written as their shapes.
std::string FormatWorld(const World& world);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_WORLD_WRITER_H_
