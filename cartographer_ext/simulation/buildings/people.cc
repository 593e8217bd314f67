// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/buildings/people.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer_ext/simulation/obstacle_motion.h"

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr double kStep = 0.1;      // seconds between the checks of a walk
constexpr double kPersonal = 0.1;  // metres between person and robot or wall
constexpr int kPhases = 6;         // tried for each walk
constexpr int kWalksPerPerson = 6;

// A piece of a lane, moved sideways. False where it is too short.
bool DrawWalk(const FloorPlan& plan, Random* random, MovingObstacle* person) {
  const int from =
      static_cast<int>(random->UniformInt(0, plan.nodes.size() - 1));
  const LaneNode& node = plan.nodes[from];
  const double choice = random->Uniform();
  const double begin = random->Uniform(0., 0.4);
  const double end = random->Uniform(0.6, 1.);
  const double aside =
      random->Uniform(plan.walk_offset_min, plan.walk_offset_max) *
      (random->Uniform() < 0.5 ? 1. : -1.);
  person->radius = random->Uniform(0.17, 0.25);
  person->speed = random->Uniform(0.4, 1.2);
  if (node.neighbours.empty()) return false;
  const int to =
      node.neighbours[static_cast<size_t>(choice * node.neighbours.size())];
  const Eigen::Vector2d step = plan.nodes[to].position - node.position;
  const double length = step.norm();
  if (length < 3.) return false;
  const Eigen::Vector2d left(-step.y() / length, step.x() / length);
  person->path = {node.position + begin * step + aside * left,
                  node.position + end * step + aside * left};
  return true;
}

bool ClearOfWalls(const MovingObstacle& person, const RayCaster& walls) {
  const Eigen::Vector2d step = person.path[1] - person.path[0];
  const int pieces = static_cast<int>(std::ceil(step.norm() / 0.1)) + 1;
  const double needed = person.radius + kPersonal;
  for (int i = 0; i <= pieces; ++i) {
    const Eigen::Vector2d point =
        person.path[0] + (static_cast<double>(i) / pieces) * step;
    if (walls.Clearance(point, needed) < needed) return false;
  }
  return true;
}

bool ClearOfRobot(const MovingObstacle& person,
                  const std::vector<Eigen::Vector2d>& robot,
                  const double needed) {
  const ObstacleMotion motion({person}, 0);
  for (size_t i = 0; i != robot.size(); ++i) {
    if ((motion.Position(0, i * kStep) - robot[i]).norm() < needed) {
      return false;
    }
  }
  return true;
}

}  // namespace

void AddPeople(const FloorPlan& plan, const RayCaster& walls,
               const Drive& drive, Random* random, World* world) {
  std::vector<Eigen::Vector2d> robot;
  for (double time = 0.; time <= drive.duration(); time += kStep) {
    robot.push_back(drive.PoseAt(time).translation());
  }
  // The distance kept includes what both may move between two checks.
  const double between = 0.5 * kStep * (world->robot.speed + 1.2);
  for (int attempt = 0; attempt != kWalksPerPerson * plan.people; ++attempt) {
    if (static_cast<int>(world->obstacles.size()) >= plan.people) break;
    MovingObstacle person;
    if (!DrawWalk(plan, random, &person) || !ClearOfWalls(person, walls)) {
      continue;
    }
    const double needed =
        world->robot.radius + person.radius + kPersonal + between;
    for (int i = 0; i != kPhases; ++i) {
      person.phase = random->Uniform();
      if (!ClearOfRobot(person, robot, needed)) continue;
      world->obstacles.push_back(person);
      break;
    }
  }
}

}  // namespace simulation
}  // namespace cartographer_ext
