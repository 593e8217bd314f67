// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/disturbances.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "cartographer_ext/navigation/closed_loop/true_plan.h"
#include "cartographer_ext/simulation/seeds.h"

namespace cartographer_ext {
namespace navigation {
namespace {

using simulation::Disc;
using simulation::RayCaster;

constexpr uint64_t kStream = 102;
constexpr int kAttempts = 4000;
// Drawing starts again up to this often, because the first disturbances may
// leave no room for the others.
constexpr int kDraws = 10;
constexpr double kFromGoals = 1.5;  // metres kept free around goals
constexpr double kApart = 2.;       // metres between two disturbances
constexpr double kPersonRadius = 0.2;
constexpr double kDoorSpacing = 0.08;  // metres between discs of a door
constexpr double kWidest = 3.;         // metres, of a door
// A leg may become longer by at most this many metres where the robot passes an
// obstacle on its other side. A longer leg is another route.
constexpr double kRoundObstacle = 1.;

// A place on one of the legs and the direction of the path there.
struct PathPlace {
  Eigen::Vector2d point;
  Eigen::Vector2d direction;
};

double Length(const std::vector<Eigen::Vector2d>& path) {
  double length = 0.;
  for (size_t i = 1; i < path.size(); ++i) {
    length += (path[i] - path[i - 1]).norm();
  }
  return length;
}

PathPlace DrawPlace(const std::vector<std::vector<Eigen::Vector2d>>& legs,
                    Random* const random) {
  double total = 0.;
  for (const auto& leg : legs) total += Length(leg);
  double rest = random->Uniform(0., total);
  PathPlace place{legs[0][0], Eigen::Vector2d::UnitX()};
  for (const auto& leg : legs) {
    for (size_t i = 1; i < leg.size(); ++i) {
      const Eigen::Vector2d piece = leg[i] - leg[i - 1];
      const double length = piece.norm();
      if (length == 0.) continue;
      place = {leg[i - 1] + std::min(1., rest / length) * piece,
               piece / length};
      if (rest <= length) return place;
      rest -= length;
    }
  }
  return place;
}

// How far a disc can go from a place before it touches something.
double FreeWay(const RayCaster& plan, const Eigen::Vector2d& from,
               const Eigen::Vector2d& direction, const double radius,
               const double limit) {
  double distance = 0.;
  while (distance + 0.05 <= limit &&
         plan.Clearance(from + (distance + 0.05) * direction, radius + 0.1) >=
             radius) {
    distance += 0.05;
  }
  return distance;
}

Eigen::Vector2d Left(const Eigen::Vector2d& direction) {
  return Eigen::Vector2d(-direction.y(), direction.x());
}

Disturbance DrawObstacle(const PathPlace& place, Random* const random) {
  Disturbance obstacle;
  obstacle.kind = Disturbance::Kind::kObstacle;
  Disc disc;
  disc.radius = random->Uniform(0.15, 0.3);
  disc.center =
      place.point + random->Uniform(-0.25, 0.25) * Left(place.direction);
  obstacle.discs.push_back(disc);
  obstacle.trigger = random->Uniform(2.5, 4.);
  return obstacle;
}

// Empty if there is no room to walk.
bool DrawCrossing(const RayCaster& plan, const PathPlace& place,
                  Random* const random, Disturbance* const crossing) {
  const double side = random->Uniform() < 0.5 ? 1. : -1.;
  const Eigen::Vector2d across = side * Left(place.direction);
  const double there = FreeWay(plan, place.point, across, kPersonRadius, 1.5);
  const double away = FreeWay(plan, place.point, -across, kPersonRadius, 1.5);
  crossing->kind = Disturbance::Kind::kCrossing;
  crossing->speed = random->Uniform(0.7, 1.3);
  crossing->trigger = random->Uniform(1.8, 3.);
  Disc disc;
  disc.radius = kPersonRadius;
  disc.center = place.point + there * across;
  crossing->discs.push_back(disc);
  crossing->end = place.point - away * across;
  return there > 0.6 && away > 0.4;
}

bool DrawDoor(const RayCaster& plan, const PathPlace& place,
              Random* const random, Disturbance* const door) {
  const Eigen::Vector2d across = Left(place.direction);
  const double left = plan.Cast(place.point, across, kWidest).range;
  const double right = plan.Cast(place.point, -across, kWidest).range;
  door->kind = Disturbance::Kind::kDoor;
  door->trigger = random->Uniform(3., 4.);
  if (!(left + right <= kWidest)) return false;
  for (double at = -right; at <= left; at += kDoorSpacing) {
    Disc disc;
    disc.center = place.point + at * across;
    disc.radius = 0.05;
    door->discs.push_back(disc);
  }
  return true;
}

bool IsNear(const PathPlace& place, const std::vector<Eigen::Vector2d>& taken,
            const double distance) {
  for (const Eigen::Vector2d& point : taken) {
    if ((point - place.point).norm() < distance) return true;
  }
  return false;
}

// Whether every leg can still be driven with some room to spare, on the route
// that a robot of this radius would take without the discs. Where an obstacle
// leaves a gap in a door that hardly holds the robot, a leg may be free by
// another door only, which does not count.
bool LegsAreFree(const RayCaster& plan, const std::vector<Disc>& stationary,
                 const std::vector<std::vector<Eigen::Vector2d>>& legs,
                 const DisturbanceOptions& options) {
  std::vector<Disc> discs = plan.discs();
  discs.insert(discs.end(), stationary.begin(), stationary.end());
  const double wide = options.robot_radius + 0.5 * options.spare_width;
  for (const auto& leg : legs) {
    const auto path =
        ShortestPath(plan.segments(), discs, wide, leg.front(), leg.back());
    if (!path.ok() || !path->found()) return false;
    const auto tight = ShortestPath(
        plan.segments(), discs, options.robot_radius, leg.front(), leg.back());
    if (!tight.ok() || path->length > tight->length + kRoundObstacle) {
      return false;
    }
  }
  return true;
}

}  // namespace

const char* ToString(const Disturbance::Kind kind) {
  switch (kind) {
    case Disturbance::Kind::kObstacle:
      return "obstacle";
    case Disturbance::Kind::kCrossing:
      return "crossing";
    case Disturbance::Kind::kDoor:
      return "door";
  }
  return "";
}

absl::StatusOr<Disturbances> Disturbances::Create(
    const RayCaster& plan,
    const std::vector<std::vector<Eigen::Vector2d>>& legs,
    const DisturbanceOptions& options, const uint64_t seed) {
  Random random(simulation::MixBits(simulation::MixBits(seed) ^ kStream));
  auto result = Draw(plan, legs, options, &random);
  for (int i = 1; i < kDraws && !result.ok(); ++i) {
    result = Draw(plan, legs, options, &random);
  }
  return result;
}

absl::StatusOr<Disturbances> Disturbances::Draw(
    const RayCaster& plan,
    const std::vector<std::vector<Eigen::Vector2d>>& legs,
    const DisturbanceOptions& options, Random* const random) {
  Disturbances result;
  result.min_distance_ = options.min_distance;
  const int wanted = options.obstacles + options.crossings + options.doors;
  if (wanted == 0) return result;
  std::vector<Eigen::Vector2d> goals, taken;
  for (const auto& leg : legs) {
    goals.push_back(leg.front());
    goals.push_back(leg.back());
  }
  std::vector<Disc> stationary;
  int obstacles = 0, crossings = 0, doors = 0;
  for (int attempt = 0; attempt != kAttempts; ++attempt) {
    const int count = static_cast<int>(result.disturbances_.size());
    if (count == wanted) break;
    const PathPlace place = DrawPlace(legs, random);
    Disturbance drawn;
    bool fits =
        !IsNear(place, goals, kFromGoals) && !IsNear(place, taken, kApart);
    if (doors < options.doors) {
      fits = DrawDoor(plan, place, random, &drawn) && fits;
    } else if (obstacles < options.obstacles) {
      drawn = DrawObstacle(place, random);
    } else {
      fits = DrawCrossing(plan, place, random, &drawn) && fits;
    }
    if (!fits) continue;
    if (drawn.kind != Disturbance::Kind::kCrossing) {
      std::vector<Disc> more = stationary;
      more.insert(more.end(), drawn.discs.begin(), drawn.discs.end());
      if (!LegsAreFree(plan, more, legs, options)) continue;
      stationary = more;
    }
    doors += drawn.kind == Disturbance::Kind::kDoor;
    obstacles += drawn.kind == Disturbance::Kind::kObstacle;
    crossings += drawn.kind == Disturbance::Kind::kCrossing;
    taken.push_back(place.point);
    result.disturbances_.push_back(drawn);
  }
  if (static_cast<int>(result.disturbances_.size()) != wanted) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "there is room for %d obstacles, %d crossings and %d doors only on "
        "the paths between these goals",
        obstacles, crossings, doors));
  }
  return result;
}

void Disturbances::Update(const double time, const Eigen::Vector2d& robot) {
  stationary_.clear();
  moving_.clear();
  for (Disturbance& disturbance : disturbances_) {
    if (disturbance.over) continue;
    if (!disturbance.present) {
      double distance = disturbance.trigger + 1.;
      for (const Disc& disc : disturbance.discs) {
        distance =
            std::min(distance, (disc.center - robot).norm() - disc.radius);
      }
      if (distance > disturbance.trigger || distance < min_distance_) continue;
      disturbance.present = true;
      disturbance.begin = time;
    }
    if (disturbance.kind != Disturbance::Kind::kCrossing) {
      stationary_.insert(stationary_.end(), disturbance.discs.begin(),
                         disturbance.discs.end());
      continue;
    }
    Disc disc = disturbance.discs.front();
    const Eigen::Vector2d path = disturbance.end - disc.center;
    const double walked = disturbance.speed * (time - disturbance.begin);
    if (walked >= path.norm()) {
      disturbance.over = true;
      continue;
    }
    disc.center += walked * path.normalized();
    moving_.push_back(disc);
  }
}

}  // namespace navigation
}  // namespace cartographer_ext
