// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes a world out of nothing but a kind and a seed: a floor plan with rooms,
// furniture, glass and people, and a drive through it that comes back to where
// it was.
//
//   BuildingOptions options;
//   options.kind = BuildingKind::kHotel;
//   options.seed = 17;
//   const absl::StatusOr<Building> hotel = GenerateBuilding(options);
//
// The plan depends on kind and seed alone, the drive also on the robot and the
// number of laps. Sensors are left as they are by default; sensors/presets.h
// chooses them.
#ifndef CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_BUILDING_H_
#define CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_BUILDING_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/simulation/buildings/floor_plan.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

enum class BuildingKind {
  kOffice,
  kHotel,
  kWarehouse,
  kHall,
  kStreet,
  kCampus
};

constexpr int kMaxLaps = 20;

// "office", "hotel" ... in the order of the kinds.
const std::vector<std::string>& BuildingNames();
// An error lists the names there are.
absl::StatusOr<BuildingKind> BuildingKindByName(const std::string& name);

struct BuildingOptions {
  BuildingKind kind = BuildingKind::kOffice;
  uint64_t seed = 0;
  int laps = 1;
  RobotSettings robot;
};

struct Building {
  World world;
  FloorPlan plan;
  // The nodes of the plan in the order they are driven.
  std::vector<int> route;
};

// An error says that the robot is too large or cannot turn where it would have
// to, or that `laps` is outside [1, kMaxLaps].
absl::StatusOr<Building> GenerateBuilding(const BuildingOptions& options);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_BUILDING_H_
