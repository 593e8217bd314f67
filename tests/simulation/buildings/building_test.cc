// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What holds for every generated building, whatever its seed.
#include "cartographer_ext/simulation/buildings/building.h"

#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cartographer_ext/simulation/drive.h"
#include "cartographer_ext/simulation/obstacle_motion.h"
#include "cartographer_ext/simulation/sensors/presets.h"
#include "cartographer_ext/simulation/simulation.h"
#include "cartographer_ext/simulation/truth.h"
#include "cartographer_ext/simulation/world_parser.h"
#include "cartographer_ext/simulation/world_writer.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

using Eigen::Vector2d;
using testing::HasSubstr;

constexpr uint64_t kSeeds = 200;

BuildingOptions Options(const BuildingKind kind, const uint64_t seed) {
  BuildingOptions options;
  options.kind = kind;
  options.seed = seed;
  options.robot = RobotPreset("differential")->robot;
  return options;
}

// All walls as a beam sees them that glass stops.
RayCaster Opaque(const World& world) {
  std::vector<Segment> segments = world.segments;
  for (Segment& segment : segments) segment.echo_angle = kAnyAngle;
  return RayCaster(segments, world.discs);
}

bool LaneIsClear(const RayCaster& walls, const Vector2d& a, const Vector2d& b,
                 const double radius) {
  const int pieces = static_cast<int>((b - a).norm() / 0.05) + 1;
  for (int i = 0; i <= pieces; ++i) {
    const Vector2d point = a + (static_cast<double>(i) / pieces) * (b - a);
    if (walls.Clearance(point, radius) < radius) return false;
  }
  return true;
}

// Nodes that a robot of that radius reaches on clear lanes.
std::set<int> Reachable(const FloorPlan& plan, const RayCaster& walls,
                        const double radius) {
  std::set<int> reached = {plan.round.front()};
  std::vector<int> open = {plan.round.front()};
  while (!open.empty()) {
    const int here = open.back();
    open.pop_back();
    for (const int next : plan.nodes[here].neighbours) {
      if (reached.count(next) != 0 ||
          !LaneIsClear(walls, plan.nodes[here].position,
                       plan.nodes[next].position, radius)) {
        continue;
      }
      reached.insert(next);
      open.push_back(next);
    }
  }
  return reached;
}

// Whether a place is passed again in the same direction after a minute.
bool HasRevisit(const Drive& drive) {
  std::vector<Pose2> poses;
  for (double time = 0.; time < drive.duration(); time += 1.) {
    poses.push_back(drive.PoseAt(time));
  }
  for (size_t i = 0; i != poses.size(); ++i) {
    for (size_t j = i + 60; j < poses.size(); ++j) {
      const Pose2 step = Between(poses[i], poses[j]);
      if (step.translation().norm() < 1. && std::abs(step.theta) < 0.5) {
        return true;
      }
    }
  }
  return false;
}

class BuildingTest : public testing::TestWithParam<std::string> {
 protected:
  BuildingKind kind() const { return *BuildingKindByName(GetParam()); }
  bool outdoors() const {
    return kind() == BuildingKind::kStreet || kind() == BuildingKind::kCampus;
  }
};

TEST_P(BuildingTest, HoldsWhatItPromises) {
  for (uint64_t seed = 0; seed != kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const auto building = GenerateBuilding(Options(kind(), seed));
    ASSERT_TRUE(building.ok()) << building.status();
    const World& world = building->world;
    const RayCaster walls = Opaque(world);
    const auto drive = Drive::Plan(world, seed + 1);
    ASSERT_TRUE(drive.ok()) << drive.status();
    EXPECT_GT(drive->length(), 90.);
    EXPECT_LT(drive->length(), outdoors() ? 900. : 500.);
    EXPECT_TRUE(HasRevisit(*drive));
    for (double time = 0.; time < drive->duration(); time += 0.07) {
      const Vector2d position = drive->PoseAt(time).translation();
      ASSERT_GE(walls.Clearance(position, 1.), world.robot.radius)
          << position.transpose();
    }
    EXPECT_EQ(building->plan.outline.empty(), outdoors());
    for (double time = 0.; !outdoors() && time < drive->duration();
         time += 15.) {
      const Vector2d position = drive->PoseAt(time).translation();
      for (int degrees = 0; degrees < 360; degrees += 7) {
        const double angle = DegToRad(degrees + 0.5);
        ASSERT_LT(walls.Cast(position, {std::cos(angle), std::sin(angle)}, 300.)
                      .range,
                  300.)
            << position.transpose();
      }
    }
    const std::set<int> reached =
        Reachable(building->plan, walls, world.robot.radius);
    EXPECT_EQ(reached.size(), building->plan.nodes.size());
    for (const Room& room : building->plan.rooms) {
      EXPECT_EQ(reached.count(room.stop), 1u);
      EXPECT_TRUE(room.box.contains(building->plan.nodes[room.stop].position));
    }
    const ObstacleMotion people(world.obstacles, seed);
    for (double time = 0.; time < 60.; time += 1.) {
      for (const Disc& disc : people.At(time)) {
        ASSERT_GE(walls.Clearance(disc.center, 1.), disc.radius);
      }
    }
  }
}

TEST_P(BuildingTest, RunsAndReadsBack) {
  for (uint64_t seed = 0; seed < kSeeds; seed += 23) {
    SCOPED_TRACE(seed);
    const auto building = GenerateBuilding(Options(kind(), seed));
    ASSERT_TRUE(building.ok()) << building.status();
    const auto again = GenerateBuilding(Options(kind(), seed));
    const std::string text = FormatWorld(building->world);
    EXPECT_EQ(text, FormatWorld(again->world));
    const auto read = ParseWorld(text, "generated");
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_EQ(FormatWorld(*read), text);
    SimulationOptions options;
    options.seed = seed + 1000;
    const auto simulation = Simulation::Create(*read, options);
    ASSERT_TRUE(simulation.ok()) << simulation.status();
    EXPECT_FALSE(
        LoopRelations(**simulation, TrueTrajectory(**simulation)).empty());
  }
}

TEST_P(BuildingTest, LapsRepeatTheRound) {
  BuildingOptions options = Options(kind(), 5);
  const auto once = GenerateBuilding(options);
  options.laps = 3;
  const auto thrice = GenerateBuilding(options);
  ASSERT_TRUE(once.ok() && thrice.ok());
  EXPECT_EQ(once->world.segments.size(), thrice->world.segments.size());
  const double one = Drive::Plan(once->world, 0)->length();
  const double three = Drive::Plan(thrice->world, 0)->length();
  EXPECT_NEAR(three, 3. * one - 2. * once->plan.overlap, 0.35 * one);
}

TEST_P(BuildingTest, SeedsDiffer) {
  std::set<std::string> texts;
  for (uint64_t seed = 0; seed != 10; ++seed) {
    const auto building = GenerateBuilding(Options(kind(), seed));
    ASSERT_TRUE(building.ok());
    World world = building->world;
    world.name.clear();
    world.description.clear();
    texts.insert(FormatWorld(world));
  }
  EXPECT_EQ(texts.size(), 10u);
}

TEST_P(BuildingTest, ACarDrivesWhereItFindsAWay) {
  const bool rooms =
      kind() == BuildingKind::kOffice || kind() == BuildingKind::kHotel;
  for (uint64_t seed = 0; seed != 10; ++seed) {
    BuildingOptions options = Options(kind(), seed);
    options.robot = RobotPreset("car")->robot;
    const auto building = GenerateBuilding(options);
    ASSERT_EQ(building.ok(), !rooms) << seed << " " << building.status();
    if (rooms) continue;
    const auto drive = Drive::Plan(building->world, 0);
    ASSERT_TRUE(drive.ok());
    for (double time = 0.; time < drive->duration(); time += 0.1) {
      const MotionState motion = drive->At(time);
      // Nothing turns tighter but for the lag of the turn acceleration.
      ASSERT_LE(std::abs(motion.turn_rate),
                std::abs(motion.speed) / options.robot.turn_radius + 0.1)
          << seed << " " << time;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, BuildingTest, testing::ValuesIn(BuildingNames()));

TEST(BuildingOptionsTest, SaysWhatIsWrong) {
  EXPECT_THAT(BuildingKindByName("castle").status().message(),
              HasSubstr("'castle', expected one of office, hotel"));
  BuildingOptions options = Options(BuildingKind::kHotel, 1);
  options.laps = 0;
  EXPECT_THAT(GenerateBuilding(options).status().message(),
              HasSubstr("0 laps are outside [1, 20]"));
  options.laps = 1;
  options.robot.radius = 1.;
  EXPECT_THAT(GenerateBuilding(options).status().message(),
              HasSubstr("a robot of radius 1 m does not pass"));
}

// Hotels are there to look alike: rooms that can be entered are furnished the
// same way, relative to their corner.
TEST(BuildingOptionsTest, HotelRoomsAreTwins) {
  const auto hotel = GenerateBuilding(Options(BuildingKind::kHotel, 6));
  ASSERT_TRUE(hotel.ok());
  std::vector<std::vector<double>> rooms;
  for (const Room& room : hotel->plan.rooms) {
    std::vector<double> things;
    for (const Disc& disc : hotel->plan.discs) {
      if (room.box.contains(disc.center)) things.push_back(disc.radius);
    }
    rooms.push_back(things);
  }
  ASSERT_GE(rooms.size(), 2u);
  for (const auto& room : rooms) EXPECT_EQ(room, rooms.front());
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
