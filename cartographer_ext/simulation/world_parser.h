// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads a world file. One statement a line, `#` starts a comment, lengths in
// metres, angles in degrees:
//
//   world     corridor
//   rectangle 0 0 20 2.4
//   pillar    5 0.4 0.2 reflectivity=0.5
//   laser     beams=360 fov=360 max_range=25 noise=0.01
//   odometry  rate=20 wheel_base=0.4 noise=0.01 mismatch_sigma=0.005
//   obstacle  radius=0.25 speed=0.6 path 4 1.9 16 1.9
//   start     1 1.2 0
//   goto      19 1.2
//   wait      3
//
// All statements and their options: docs/world_format.md.
#ifndef CARTOGRAPHER_EXT_SIMULATION_WORLD_PARSER_H_
#define CARTOGRAPHER_EXT_SIMULATION_WORLD_PARSER_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

// Errors read "file:line: 'keyword': what is wrong". `filename` is used for
// them only.
absl::StatusOr<World> ParseWorld(absl::string_view text,
                                 const std::string& filename);

absl::StatusOr<World> LoadWorld(const std::string& filename);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_WORLD_PARSER_H_
