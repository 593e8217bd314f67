// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/buildings/building.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/simulation/buildings/people.h"
#include "cartographer_ext/simulation/buildings/plans.h"
#include "cartographer_ext/simulation/buildings/route.h"
#include "cartographer_ext/simulation/drive.h"
#include "cartographer_ext/simulation/seeds.h"

namespace cartographer_ext {
namespace simulation {
namespace {

// Plans are drawn until the robot fits through everywhere, at most this often.
constexpr int kAttempts = 8;
constexpr double kWait = 3.;        // seconds at the start and at the end
constexpr double kLookStep = 0.05;  // seconds between collision checks
constexpr double kSpare = 0.02;     // metres beyond the robot's radius
constexpr int kMaxMarkedPlaces = 6;

Random MakePlanRandom(const BuildingOptions& options, const int attempt) {
  const uint64_t kind = static_cast<uint64_t>(options.kind) + 1;
  return MakeRandom(MixBits(options.seed) + (kind << 8) + attempt,
                    RandomStream::kBuilding);
}

void DrawPlan(const BuildingKind kind, Random* random, FloorPlan* plan) {
  switch (kind) {
    case BuildingKind::kOffice:
      return PlanOffice(random, plan);
    case BuildingKind::kHotel:
      return PlanHotel(random, plan);
    case BuildingKind::kWarehouse:
      return PlanWarehouse(random, plan);
    case BuildingKind::kHall:
      return PlanHall(random, plan);
    case BuildingKind::kStreet:
      return PlanStreet(random, plan);
    case BuildingKind::kCampus:
      return PlanCampus(random, plan);
  }
}

void SetDrive(const std::vector<Eigen::Vector2d>& points, World* world) {
  const Eigen::Vector2d first = points[1] - points[0];
  world->start =
      Pose2(points[0].x(), points[0].y(), std::atan2(first.y(), first.x()));
  DriveCommand wait;
  wait.kind = DriveCommand::Kind::kWait;
  wait.seconds = kWait;
  wait.where = world->name;
  world->drive = {wait};
  for (size_t i = 1; i != points.size(); ++i) {
    DriveCommand command;
    command.target = points[i];
    command.where = absl::StrCat(world->name, ", waypoint ", i);
    world->drive.push_back(command);
  }
  world->drive.push_back(wait);
}

// The first nodes that are passed at least twice, some metres apart.
void MarkPlaces(const FloorPlan& plan, const std::vector<int>& route,
                World* world) {
  constexpr double kApart = 8.;
  std::map<int, int> passes;
  for (const int node : route) ++passes[node];
  for (const int node : route) {
    const Eigen::Vector2d& position = plan.nodes[node].position;
    bool is_new = passes[node] >= 2;
    for (const RevisitPlace& place : world->places) {
      is_new = is_new && (place.position - position).norm() > kApart;
    }
    if (!is_new) continue;
    RevisitPlace place;
    place.name = absl::StrCat("place", world->places.size() + 1);
    place.position = position;
    world->places.push_back(place);
    if (world->places.size() == kMaxMarkedPlaces) break;
  }
}

absl::Status CheckClearance(const World& world, const RayCaster& walls,
                            const Drive& drive) {
  const double needed = world.robot.radius + kSpare;
  for (double time = 0.; time <= drive.duration(); time += kLookStep) {
    const Eigen::Vector2d position = drive.PoseAt(time).translation();
    if (walls.Clearance(position, needed) < needed) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "a robot of radius %g m does not pass at (%.2f, %.2f)",
          world.robot.radius, position.x(), position.y()));
    }
  }
  return absl::OkStatus();
}

absl::Status Attempt(const BuildingOptions& options, const int attempt,
                     Building* building) {
  Random random = MakePlanRandom(options, attempt);
  FloorPlan& plan = building->plan;
  World& world = building->world;
  DrawPlan(options.kind, &random, &plan);
  const std::string& kind = BuildingNames()[static_cast<size_t>(options.kind)];
  world.name = absl::StrCat(kind, "_", options.seed);
  world.robot = options.robot;
  world.robot.jitter = 0.;  // people avoid the path of one drive
  world.segments = plan.segments;
  world.discs = plan.discs;
  RouteOptions route_options;
  route_options.laps = options.laps;
  route_options.turns_back = options.robot.turn_radius == 0.;
  building->route = RouteNodes(plan, route_options);
  if (building->route.size() < 2) {
    return absl::InvalidArgumentError(
        "a robot that cannot turn in place finds no path through");
  }
  // The number of laps must not change the random numbers of people, and vice
  // versa.
  Random slack(random.NextBits());
  SetDrive(Waypoints(plan, building->route, &slack), &world);
  MarkPlaces(plan, building->route, &world);
  const RayCaster walls(plan.segments, plan.discs);
  const absl::StatusOr<Drive> drive = Drive::Plan(world, options.seed);
  if (!drive.ok()) return drive.status();
  const absl::Status status = CheckClearance(world, walls, *drive);
  if (!status.ok()) return status;
  AddPeople(plan, walls, *drive, &random, &world);
  world.description = absl::StrFormat(
      "A generated %s, seed %d, %d lap%s: %d rooms, %.0f m of drive, %d "
      "people.",
      kind, options.seed, options.laps, options.laps == 1 ? "" : "s",
      plan.rooms.size(), drive->length(), world.obstacles.size());
  return absl::OkStatus();
}

}  // namespace

const std::vector<std::string>& BuildingNames() {
  static const auto* const names = new std::vector<std::string>{
      "office", "hotel", "warehouse", "hall", "street", "campus"};
  return *names;
}

absl::StatusOr<BuildingKind> BuildingKindByName(const std::string& name) {
  const std::vector<std::string>& names = BuildingNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) {
    return static_cast<BuildingKind>(found - names.begin());
  }
  return absl::InvalidArgumentError(absl::StrCat("unknown kind of building '",
                                                 name, "', expected one of ",
                                                 absl::StrJoin(names, ", ")));
}

absl::StatusOr<Building> GenerateBuilding(const BuildingOptions& options) {
  if (options.laps < 1 || options.laps > kMaxLaps) {
    return absl::InvalidArgumentError(
        absl::StrCat(options.laps, " laps are outside [1, ", kMaxLaps, "]"));
  }
  absl::Status status;
  for (int attempt = 0; attempt != kAttempts; ++attempt) {
    Building building;
    status = Attempt(options, attempt, &building);
    if (status.ok()) return building;
  }
  return absl::Status(
      status.code(),
      absl::StrCat(BuildingNames()[static_cast<size_t>(options.kind)],
                   ", seed ", options.seed, ": ", status.message()));
}

}  // namespace simulation
}  // namespace cartographer_ext
