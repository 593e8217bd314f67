// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The six kinds of plans. Each draws its sizes and its furniture from `random`
// and leaves walls, lanes, rooms and one round in the plan.
#ifndef CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_PLANS_H_
#define CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_PLANS_H_

#include "cartographer_ext/common/random.h"
#include "cartographer_ext/simulation/buildings/floor_plan.h"

namespace cartographer_ext {
namespace simulation {

// Rooms of all sizes along one corridor, or round a core between two.
void PlanOffice(Random* random, FloorPlan* plan);
// The same with long wings of equal rooms behind closed doors.
void PlanHotel(Random* random, FloorPlan* plan);
// Equal aisles between racks.
void PlanWarehouse(Random* random, FloorPlan* plan);
// A large hall with columns and booths.
void PlanHall(Random* random, FloorPlan* plan);
// Houses in rows on both sides of streets round one or two blocks, with parked
// cars and trees.
void PlanStreet(Random* random, FloorPlan* plan);
// Buildings far apart on a green, with trees and hedges.
void PlanCampus(Random* random, FloorPlan* plan);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_PLANS_H_
