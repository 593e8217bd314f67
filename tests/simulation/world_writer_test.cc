// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/world_writer.h"

#include <fstream>
#include <memory>
#include <string>

#include "cartographer_ext/simulation/simulation.h"
#include "cartographer_ext/simulation/world_parser.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

class WorldWriterTest : public testing::TestWithParam<std::string> {};

// Every shipped world is the same after a round trip: it drives the same way,
// and its text stays.
TEST_P(WorldWriterTest, ReadsBack) {
  const auto world =
      LoadWorld("configuration_files/worlds/" + GetParam() + ".world");
  ASSERT_TRUE(world.ok()) << world.status();
  const std::string text = FormatWorld(*world);
  const auto read = ParseWorld(text, "written");
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(FormatWorld(*read), text);
  EXPECT_EQ(read->segments.size(), world->segments.size());
  EXPECT_EQ(read->discs.size(), world->discs.size());
  SimulationOptions options;
  options.seed = 3;
  const auto before = Simulation::Create(*world, options);
  const auto after = Simulation::Create(*read, options);
  ASSERT_TRUE(before.ok() && after.ok()) << after.status();
  EXPECT_NEAR((*before)->drive().length(), (*after)->drive().length(), 1e-4);
  const auto& readings = (*after)->odometry().readings;
  ASSERT_EQ((*before)->odometry().readings.size(), readings.size());
  const Pose2 step =
      Between((*before)->odometry().readings.back().pose, readings.back().pose);
  EXPECT_LT(step.translation().norm(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(
    All, WorldWriterTest,
    testing::Values("ri_corridor", "factory_shelves", "four_corridor_building",
                    "featureless_corridor", "corridor_one_door", "office",
                    "l_corner", "circular_room", "hall_and_corridor"));

// Statements that no shipped world has.
TEST(WorldWriterTest, EveryStatement) {
  const std::string text =
      "world     all\n"
      "describe  Every statement.\n"
      "begin     100\n\n"
      "polyline  0 0 5 0 5 5 reflectivity=0.5 echo_angle=20\n"
      "polyline  5 5 0 5\n"
      "circle    2 2 0.3 reflectivity=0.25\n\n"
      "laser     beams=90 first=-45 increment=1 min_range=0.2 max_range=8 "
      "noise=0.01 proportional_noise=0.01 dropout=0.1 outlier=0.2 rate=5 "
      "resolution=0.01 sweep=0.1 no_return=0 x=0.1 y=0.2 theta=30\n"
      "odometry  none rate=10 encoder_rate=50 phase=0.1 wheel_base=0.5 "
      "ticks_per_metre=100 scale_left=0.1 scale_right=0.2 scale_sigma=0.01 "
      "mismatch_sigma=0.02 wheel_base_error=0.03 wheel_base_sigma=0.04 "
      "noise=0.05 lateral_noise=0.06\n"
      "imu       rate=50 gyro_noise=1 gyro_bias_sigma=2 gyro_bias_walk=3 "
      "accel_noise=4 accel_bias_sigma=5 accel_bias_walk=6 gravity=9\n"
      "robot     radius=0.1 speed=1 acceleration=2 turn_rate=3 "
      "turn_acceleration=4 lookahead=0.5 jitter=0.1 turn_radius=0.7\n"
      "obstacle  radius=0.2 speed=0.5 phase=0.25 path 1 1 2 1\n"
      "obstacle  radius=0.2 speed=0.5 phase=random path 1 1 2 1\n\n"
      "start     1 1 90\n"
      "goto      1 2 speed=0.3\n"
      "reverse   1 1\n"
      "turn      45\n"
      "wait      2\n\n"
      "fault     slip start=1 duration=2 left=0.1 right=0.2 spin_left=0.3 "
      "spin_right=0.4\n"
      "fault     slip start=0 duration=0 left=0.1 x=1 y=2 radius=3\n"
      "fault     stale start=1 duration=0.5\n"
      "fault     jump start=2 distance=0.7 angle=10\n"
      "fault     reverse start=3 duration=4\n"
      "fault     offset start=4 duration=5 seconds=0.1\n"
      "fault     stall start=6 duration=0.4\n"
      "key_distance width 0 1 5 1\n"
      "revisit   here 1 1 radius=0.5\n";
  const auto world = ParseWorld(text, "all");
  ASSERT_TRUE(world.ok()) << world.status();
  EXPECT_EQ(FormatWorld(*world), text);
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
