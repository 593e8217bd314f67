// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/sensors/presets.h"

#include <cmath>
#include <string>

#include "cartographer_ext/simulation/simulation.h"
#include "cartographer_ext/simulation/world_parser.h"
#include "cartographer_ext/simulation/world_source.h"
#include "cartographer_ext/simulation/world_writer.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

using testing::HasSubstr;

World Corridor() {
  return *ParseWorld(
      "rectangle -2 -1 120 1\nodometry scale_left=0.1\nstart 0 0 0\n"
      "goto 100 0\n",
      "corridor");
}

class LaserPresetTest : public testing::TestWithParam<std::string> {};

// Beams and scans a second as the preset says, also after a world file.
TEST_P(LaserPresetTest, MeasuresAtItsRate) {
  World world = Corridor();
  const LaserSettings laser = *LaserPreset(GetParam());
  world.laser = laser;
  const auto read = ParseWorld(FormatWorld(world), "written");
  ASSERT_TRUE(read.ok()) << read.status();
  auto simulation = Simulation::Create(*read, SimulationOptions());
  ASSERT_TRUE(simulation.ok()) << simulation.status();
  const double duration = (*simulation)->drive().duration();
  WorldSource source(*std::move(simulation));
  io::SensorEvent event;
  int64_t scans = 0, beams = 0;
  while (*source.Next(&event)) {
    if (!absl::holds_alternative<io::LaserScan>(event)) continue;
    const auto& scan = absl::get<io::LaserScan>(event);
    ++scans;
    beams += scan.ranges.size();
    ASSERT_NEAR(scan.time_increment * (laser.beams - 1), laser.sweep, 1e-9);
  }
  EXPECT_NEAR(scans, duration * laser.rate, 2.);
  EXPECT_NEAR(beams, duration * laser.rate * laser.beams, 2. * laser.beams);
  EXPECT_LE(laser.sweep * laser.rate, 1.);
  EXPECT_LT(laser.min_range, laser.max_range);
}

INSTANTIATE_TEST_SUITE_P(All, LaserPresetTest,
                         testing::ValuesIn(LaserPresetNames()));

TEST(PresetsTest, FieldsOfViewAreThoseOfTheSheets) {
  const auto degrees = [](const std::string& name) {
    const LaserSettings laser = *LaserPreset(name);
    return RadToDeg(laser.angle_increment) * (laser.beams - 1);
  };
  EXPECT_NEAR(degrees("depth_camera"), 57., 1e-9);
  EXPECT_NEAR(degrees("rplidar_a1"), 359., 1e-9);
  EXPECT_NEAR(degrees("urg_04lx"), 240., 1e-9);
  EXPECT_NEAR(degrees("utm_30lx"), 270., 1e-9);
  EXPECT_NEAR(degrees("sick_lms"), 180., 1e-9);
  EXPECT_NEAR(LaserPreset("rplidar_a1")->sweep, 0.18, 0.003);
}

TEST(PresetsTest, GradesOfOdometry) {
  World world = Corridor();
  double before = 0.;
  for (const char* name : {"good", "fair", "poor"}) {
    ASSERT_TRUE(ApplyOdometryPreset(name, 1, &world).ok());
    EXPECT_GT(world.odometry.scale_sigma, before);
    EXPECT_EQ(world.odometry.scale_left, 0.);
    before = world.odometry.scale_sigma;
  }
  // 100 m at 0.7 m/s: two slips of at least ten seconds' distance.
  EXPECT_EQ(world.faults.size(), 2u);
  ASSERT_TRUE(ApplyOdometryPreset("none", 1, &world).ok());
  const auto read = ParseWorld(FormatWorld(world), "written");
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_TRUE((*Simulation::Create(*read, SimulationOptions()))
                  ->odometry()
                  .readings.empty());
}

// Wheels that roll sideways lose the robot sideways, and only there.
TEST(PresetsTest, MecanumDriftsSideways) {
  World world = Corridor();
  const auto mecanum = RobotPreset("mecanum");
  world.robot = mecanum->robot;
  world.odometry = mecanum->odometry;
  world.odometry.ticks_per_meter = 0.;
  double squares = 0.;
  for (uint64_t seed = 0; seed != 50; ++seed) {
    SimulationOptions options;
    options.seed = seed;
    const auto simulation = Simulation::Create(world, options);
    ASSERT_TRUE(simulation.ok()) << simulation.status();
    const Pose2 end = (*simulation)->odometry().readings.back().pose;
    EXPECT_NEAR(end.x, 100., 0.05);
    squares += end.y * end.y;
  }
  const double sigma = mecanum->odometry.lateral_noise * std::sqrt(100.);
  EXPECT_NEAR(std::sqrt(squares / 50.), sigma, 0.35 * sigma);
}

TEST(PresetsTest, ACarCannotTurnInPlace) {
  World world = *ParseWorld(
      "rectangle -2 -5 30 5\nstart 0 0 0\ngoto 10 0\nturn 90\n", "turning");
  world.robot = RobotPreset("car")->robot;
  EXPECT_THAT(
      Simulation::Create(world, SimulationOptions()).status().message(),
      HasSubstr("turning:4: the drive needs a turn in place, and the robot has "
                "a turning radius of 0.9 m"));
}

TEST(PresetsTest, UnknownNamesListTheKnown) {
  EXPECT_THAT(
      LaserPreset("lms").status().message(),
      HasSubstr("no laser 'lms', expected one of depth_camera, rplidar_a1"));
  EXPECT_THAT(RobotPreset("legs").status().message(),
              HasSubstr("differential, mecanum, car"));
  World world = Corridor();
  EXPECT_THAT(ApplyOdometryPreset("bad", 0, &world).message(),
              HasSubstr("good, fair, poor, none"));
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
