// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Furniture and other objects in a plan, as seen by a horizontal laser ten
// centimetres above the floor.
#ifndef CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_FURNITURE_H_
#define CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_FURNITURE_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/simulation/buildings/floor_plan.h"

namespace cartographer_ext {
namespace simulation {

// In its own frame, from (0, 0) to `size`; its back is at y = 0.
struct Piece {
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
  std::vector<Segment> segments;
  std::vector<Disc> discs;
};

Piece Desk();                                // four legs and a chair
Piece Cupboard(double width, double depth);  // a closed box
Piece Table(int chairs);                     // a central foot, chairs round it
Piece Bed();
Piece RoundThing(double radius);  // a bin, a plant, a column, a tree
Piece ParkedCar();                // the body between the wheels' tops
// Posts at the corners of each bay, pallets in a share of the places.
Piece Rack(int bays, double depth, double filled, Random* random);

// Sides of a box, in this order: below, right, above, left.
enum Side { kBelow = 0, kRight = 1, kAbove = 2, kLeft = 3 };

// Turns the piece by quarter turns so that its back is towards `side`, and puts
// its lower left corner to `corner`. False, and nothing is drawn, where it would
// come nearer than `keep` to a lane or `gap` to another piece.
struct Placement {
  Side back = kBelow;
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();
  double keep = 0.55;
  double gap = 0.1;
};
bool Place(const Piece& piece, const Placement& placement, FloorPlan* plan);

// Puts the piece with its back to a random side of the room. False where it
// found no place.
bool PlaceAtWall(const Piece& piece, const Box& room, Random* random,
                 FloorPlan* plan);
// The same anywhere in the room.
bool PlaceInside(const Piece& piece, const Box& room, Random* random,
                 FloorPlan* plan);

// Furnishes a room, more or less densely (0 to 1).
void FurnishOffice(const Box& room, double density, Random* random,
                   FloorPlan* plan);
void FurnishHotelRoom(const Box& room, Random* random, FloorPlan* plan);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_FURNITURE_H_
