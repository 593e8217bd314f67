// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// People who walk back and forth beside the lanes; only those whose walk never
// touches the robot on its drive are kept.
#ifndef CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_PEOPLE_H_
#define CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_PEOPLE_H_

#include "cartographer_ext/common/random.h"
#include "cartographer_ext/simulation/buildings/floor_plan.h"
#include "cartographer_ext/simulation/drive.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

// Adds up to `plan.people` obstacles to the world whose plan and drive these are.
void AddPeople(const FloorPlan& plan, const RayCaster& walls,
               const Drive& drive, Random* random, World* world);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_PEOPLE_H_
