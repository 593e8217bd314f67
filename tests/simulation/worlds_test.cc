// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Every world that is shipped: it loads, the robot drives it without touching
// anything for many seeds, and its corridors have the lengths they are known
// by.
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "cartographer_ext/simulation/simulation.h"
#include "cartographer_ext/simulation/truth.h"
#include "cartographer_ext/simulation/world_parser.h"
#include "cartographer_ext/simulation/world_source.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

std::string Path(const std::string& name) {
  return "configuration_files/worlds/" + name + ".world";
}

std::unique_ptr<const Simulation> RunWorld(const std::string& name,
                                           const uint64_t seed) {
  auto world = LoadWorld(Path(name));
  EXPECT_TRUE(world.ok()) << world.status();
  if (!world.ok()) return nullptr;
  SimulationOptions options;
  options.seed = seed;
  auto simulation = Simulation::Create(*std::move(world), options);
  EXPECT_TRUE(simulation.ok()) << simulation.status();
  if (!simulation.ok()) return nullptr;
  return *std::move(simulation);
}

class WorldsTest : public testing::TestWithParam<std::string> {};

TEST_P(WorldsTest, DrivesWithoutTouchingAnything) {
  for (uint64_t seed = 0; seed != 20; ++seed) {
    const auto simulation = RunWorld(GetParam(), seed);
    ASSERT_NE(simulation, nullptr) << seed;
    EXPECT_EQ(simulation->world().name, GetParam());
    EXPECT_FALSE(simulation->world().description.empty());
    EXPECT_GT(simulation->drive().length(), 20.);
    EXPECT_GT(simulation->drive().duration(), 60.);
    EXPECT_LT(simulation->drive().duration(), 12. * 60.);
    EXPECT_TRUE(simulation->world().imu.present);
  }
}

TEST_P(WorldsTest, KeepsItsLimits) {
  const auto simulation = RunWorld(GetParam(), 1);
  ASSERT_NE(simulation, nullptr);
  const RobotSettings& robot = simulation->world().robot;
  const Drive& drive = simulation->drive();
  for (double time = 0.; time < drive.duration(); time += 0.037) {
    const MotionState motion = drive.At(time);
    ASSERT_LE(std::abs(motion.speed), robot.speed + 1e-9);
    ASSERT_LE(std::abs(motion.turn_rate), robot.turn_rate + 1e-9);
    ASSERT_LE(std::abs(motion.acceleration), robot.acceleration + 1e-9);
    ASSERT_LE(std::abs(motion.turn_acceleration),
              robot.turn_acceleration + 1e-9);
  }
}

TEST_P(WorldsTest, ObstaclesStayClearOfWalls) {
  const auto simulation = RunWorld(GetParam(), 1);
  ASSERT_NE(simulation, nullptr);
  for (double time = 0.; time < 200.; time += 0.5) {
    for (const Disc& disc : simulation->obstacles().At(time)) {
      ASSERT_GE(simulation->plan().Clearance(disc.center, 1.), disc.radius)
          << disc.center.transpose();
    }
  }
}

// From the middle of a key distance the laser finds a wall at both ends.
TEST_P(WorldsTest, KeyDistancesReachFromWallToWall) {
  const auto simulation = RunWorld(GetParam(), 1);
  ASSERT_NE(simulation, nullptr);
  for (const KeyDistance& distance : simulation->world().key_distances) {
    for (const Eigen::Vector2d& end : {distance.a, distance.b}) {
      EXPECT_LT(simulation->plan().Clearance(end, 1.), 1e-6)
          << distance.name << " " << end.transpose();
    }
  }
  for (const KeyDistanceView& view :
       KeyDistanceViews(*simulation, TrueTrajectory(*simulation))) {
    EXPECT_TRUE(view.seen) << view.distance.name;
  }
}

TEST_P(WorldsTest, PlacesAreRevisited) {
  const auto simulation = RunWorld(GetParam(), 1);
  ASSERT_NE(simulation, nullptr);
  std::map<std::string, int> visits;
  for (const PlaceVisit& visit :
       PlaceVisits(*simulation, TrueTrajectory(*simulation))) {
    visits[visit.place] = visit.visit;
  }
  for (const RevisitPlace& place : simulation->world().places) {
    EXPECT_GE(visits[place.name], 2) << place.name;
  }
}

TEST_P(WorldsTest, FirstScansSeeTheWalls) {
  auto source = OpenWorld(Path(GetParam()), 1);
  ASSERT_TRUE(source.ok()) << source.status();
  io::SensorEvent event;
  int scans = 0;
  while (scans != 5) {
    const auto more = (*source)->Next(&event);
    ASSERT_TRUE(more.ok() && *more);
    if (!absl::holds_alternative<io::LaserScan>(event)) continue;
    ++scans;
    const auto& scan = absl::get<io::LaserScan>(event);
    int echoes = 0;
    for (const float range : scan.ranges) {
      echoes += range >= scan.range_min && range <= scan.range_max;
    }
    EXPECT_GT(echoes, 0.8 * scan.ranges.size());
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, WorldsTest,
    testing::Values("ri_corridor", "factory_shelves", "four_corridor_building",
                    "featureless_corridor", "corridor_one_door", "office",
                    "l_corner", "circular_room", "hall_and_corridor"));

double Measure(const Simulation& simulation, const std::string& name) {
  for (const KeyDistance& distance : simulation.world().key_distances) {
    if (distance.name != name) continue;
    const Eigen::Vector2d middle = 0.5 * (distance.a + distance.b);
    const Eigen::Vector2d along = (distance.b - distance.a).normalized();
    return simulation.plan().Cast(middle, along, 200.).range +
           simulation.plan().Cast(middle, -along, 200.).range;
  }
  ADD_FAILURE() << "no key distance " << name;
  return 0.;
}

TEST(WorldLengthsTest, RiCorridor) {
  const auto simulation = RunWorld("ri_corridor", 1);
  ASSERT_NE(simulation, nullptr);
  EXPECT_NEAR(Measure(*simulation, "a"), 63.25, 1e-6);
  EXPECT_NEAR(Measure(*simulation, "c"), 63.25, 1e-6);
  EXPECT_NEAR(Measure(*simulation, "b"), 42.37, 1e-6);
  EXPECT_NEAR(Measure(*simulation, "d"), 42.37, 1e-6);
  EXPECT_EQ(simulation->obstacles().size(), 7);
  EXPECT_EQ(simulation->world().places.size(), 8);
}

TEST(WorldLengthsTest, FourCorridorBuilding) {
  const auto simulation = RunWorld("four_corridor_building", 1);
  ASSERT_NE(simulation, nullptr);
  EXPECT_NEAR(Measure(*simulation, "a"), 67.42, 1e-6);
  EXPECT_NEAR(Measure(*simulation, "b"), 70.52, 1e-6);
  EXPECT_NEAR(Measure(*simulation, "c"), 54.92, 1e-6);
  EXPECT_NEAR(Measure(*simulation, "d"), 49.47, 1e-6);
}

TEST(WorldLengthsTest, FeaturelessCorridorHidesItsEnds) {
  const auto simulation = RunWorld("featureless_corridor", 1);
  ASSERT_NE(simulation, nullptr);
  EXPECT_NEAR(Measure(*simulation, "length"), 100., 1e-6);
  // How often the laser sees an end wall.
  const double range = simulation->world().laser.max_range;
  int seen = 0, scans = 0;
  for (const TruePose& here : TrueTrajectory(*simulation)) {
    ++scans;
    seen += here.pose.x < range || here.pose.x > 100. - range;
  }
  EXPECT_LT(seen, 0.35 * scans);
}

TEST(WorldLengthsTest, HallAndCorridor) {
  const auto simulation = RunWorld("hall_and_corridor", 1);
  ASSERT_NE(simulation, nullptr);
  EXPECT_NEAR(
      simulation->plan().Cast(Eigen::Vector2d(20., 4.), {1., 0.}, 200.).range,
      92., 1e-6);
  // The end is never in range.
  for (const TruePose& here : TrueTrajectory(*simulation)) {
    EXPECT_LT(here.pose.x, 112. - simulation->world().laser.max_range);
  }
}

TEST(WorldLengthsTest, Shelves) {
  const auto simulation = RunWorld("factory_shelves", 1);
  ASSERT_NE(simulation, nullptr);
  EXPECT_EQ(simulation->obstacles().size(), 4);
  // The same place of two neighbouring aisles looks the same sideways.
  const Eigen::Vector2d aisle(10.3, 8.4), next(10.3, 12.);
  for (int degrees = 45; degrees <= 135; ++degrees) {
    const Eigen::Vector2d up(std::cos(DegToRad(degrees)),
                             std::sin(DegToRad(degrees)));
    EXPECT_NEAR(simulation->plan().Cast(aisle, up, 25.).range,
                simulation->plan().Cast(next, up, 25.).range, 1e-9);
  }
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
