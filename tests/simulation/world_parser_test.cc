// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/world_parser.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "gtest/gtest.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace simulation {
namespace {

World Parse(const std::string& text) {
  auto world = ParseWorld(text, "test.world");
  EXPECT_TRUE(world.ok()) << world.status();
  return world.ok() ? *world : World();
}

double TotalLength(const World& world) {
  double length = 0.;
  for (const Segment& segment : world.segments) {
    length += (segment.b - segment.a).norm();
  }
  return length;
}

constexpr char kStart[] = "start 0 0 0\n";

TEST(WorldParserTest, ReadsEveryStatement) {
  const World world = Parse(R"(
world     test_world   # with a comment
describe  Two words,
describe  and more.
begin     250.5
polygon   0 0 4 0 4 3
polyline  10 0 11 0 11 1 reflectivity=0.4
rectangle 20 0 22 1
circle    30 0 1.5
pillar    31 0 0.1 reflectivity=0.2
laser     beams=180 fov=180 increment=1 first=-90 min_range=0.2 max_range=30 noise=0.02 proportional_noise=0.001 dropout=0.02 outlier=0.03 rate=5 resolution=0.01 sweep=0.1 no_return=99 x=0.1 y=-0.2 theta=45
odometry  rate=50 encoder_rate=200 phase=0.01 wheel_base=0.6 ticks_per_metre=1000 scale_left=0.01 scale_right=-0.01 scale_sigma=0.02 mismatch_sigma=0.003 wheel_base_error=0.04 wheel_base_sigma=0.05 noise=0.006
imu       rate=200 gyro_noise=1 gyro_bias_sigma=2 gyro_bias_walk=3 accel_noise=4 accel_bias_sigma=5 accel_bias_walk=6 gravity=9.8
obstacle  radius=0.3 speed=0.4 phase=0.25 path 1 2 3 4 5 6
obstacle  phase=random path 1 2 3 4
robot     radius=0.4 speed=0.9 acceleration=0.6 turn_rate=1 turn_acceleration=2 lookahead=0.8 jitter=0.1
start     1 2 90
goto      3 4 speed=0.5
wait      7
turn      -90
reverse   1 1
fault     slip start=5 duration=2 left=0.5 right=0.4 spin_left=0.1 spin_right=0.2
fault     slip x=3 y=4 radius=2 left=1
fault     stale start=9 duration=0.8
fault     jump start=10 distance=0.6 angle=90
fault     reverse start=11 duration=12
fault     offset seconds=0.12
key_distance a 0 0 4 0
revisit   p1 3 4 radius=2
)");
  EXPECT_EQ(world.name, "test_world");
  EXPECT_EQ(world.description, "Two words, and more.");
  EXPECT_EQ(world.begin, 250.5);
  ASSERT_EQ(world.segments.size(), 3 + 2 + 4);
  EXPECT_NEAR(TotalLength(world), 12. + 2. + 6., 1e-12);
  EXPECT_EQ(world.segments[3].reflectivity, 0.4);
  ASSERT_EQ(world.discs.size(), 2);
  EXPECT_EQ(world.discs[0].radius, 1.5);
  EXPECT_EQ(world.discs[1].reflectivity, 0.2);
  EXPECT_EQ(world.laser.beams, 180);
  EXPECT_DOUBLE_EQ(world.laser.angle_increment, DegToRad(1.));
  EXPECT_DOUBLE_EQ(world.laser.angle_min, -kPi / 2.);
  EXPECT_EQ(world.laser.no_return, 99.);
  EXPECT_EQ(world.laser.sweep, 0.1);
  EXPECT_DOUBLE_EQ(world.laser.mounting.theta, kPi / 4.);
  EXPECT_EQ(world.odometry.ticks_per_meter, 1000.);
  EXPECT_EQ(world.odometry.scale_right, -0.01);
  EXPECT_EQ(world.odometry.wheel_base_sigma, 0.05);
  EXPECT_TRUE(world.imu.present);
  EXPECT_EQ(world.imu.accel_bias_walk, 6.);
  EXPECT_EQ(world.imu.gravity, 9.8);
  ASSERT_EQ(world.obstacles.size(), 2);
  EXPECT_EQ(world.obstacles[0].path.size(), 3);
  EXPECT_EQ(world.obstacles[0].phase, 0.25);
  EXPECT_FALSE(world.obstacles[0].random_phase);
  EXPECT_TRUE(world.obstacles[1].random_phase);
  EXPECT_EQ(world.robot.lookahead, 0.8);
  EXPECT_DOUBLE_EQ(world.start.theta, kPi / 2.);
  ASSERT_EQ(world.drive.size(), 4);
  EXPECT_EQ(world.drive[0].speed, 0.5);
  EXPECT_EQ(world.drive[1].seconds, 7.);
  EXPECT_DOUBLE_EQ(world.drive[2].heading, -kPi / 2.);
  EXPECT_EQ(world.drive[3].kind, DriveCommand::Kind::kReverse);
  ASSERT_EQ(world.faults.size(), 6);
  EXPECT_FALSE(world.faults[0].in_place);
  EXPECT_EQ(world.faults[0].spin_right, 0.2);
  EXPECT_TRUE(world.faults[1].in_place);
  EXPECT_EQ(world.faults[2].duration, 0.8);
  EXPECT_DOUBLE_EQ(world.faults[3].angle, kPi / 2.);
  EXPECT_EQ(world.faults[5].seconds, 0.12);
  ASSERT_EQ(world.key_distances.size(), 1);
  EXPECT_EQ(world.key_distances[0].b.x(), 4.);
  ASSERT_EQ(world.places.size(), 1);
  EXPECT_EQ(world.places[0].radius, 2.);
}

TEST(WorldParserTest, NameComesFromTheFileOtherwise) {
  const auto world = ParseWorld(kStart, "/some/where/my_hall.world");
  ASSERT_TRUE(world.ok());
  EXPECT_EQ(world->name, "my_hall");
}

TEST(WorldParserTest, AByteOrderMarkIsSkipped) {
  EXPECT_TRUE(ParseWorld(std::string("\xef\xbb\xbf") + kStart, "a.world").ok());
}

TEST(WorldParserTest, WallWithRecesses) {
  // A recess adds twice its depth; the left of +x is +y.
  const World world =
      Parse(std::string(kStart) + "wall 0 0 10 0 recess=2,1,0.5 recess=6,2,-1");
  EXPECT_NEAR(TotalLength(world), 10. + 2. * 0.5 + 2. * 1., 1e-12);
  const RayCaster plan(world.segments, world.discs);
  const Eigen::Vector2d down(0., -1.);
  EXPECT_NEAR(plan.Cast({1., 3.}, down, 10.).range, 3., 1e-12);
  EXPECT_NEAR(plan.Cast({2.5, 3.}, down, 10.).range, 2.5, 1e-12);
  EXPECT_NEAR(plan.Cast({7., 3.}, down, 10.).range, 4., 1e-12);
}

TEST(WorldParserTest, WallRecessAtBothEnds) {
  const World world =
      Parse(std::string(kStart) + "wall 0 0 4 0 recess=3,1,0.5 recess=0,1,0.5");
  EXPECT_NEAR(TotalLength(world), 6., 1e-12);
}

TEST(WorldParserTest, BlocksArePlacedTurnedAndMirrored) {
  const World world = Parse(std::string(kStart) + R"(
block part
polyline 0 0 1 0
pillar 2 1 0.1
end
block pair
place part 0 0
place part 0 5 mirror=1
end
place pair 10 20 90
)");
  ASSERT_EQ(world.segments.size(), 2);
  ASSERT_EQ(world.discs.size(), 2);
  EXPECT_NEAR(world.segments[0].b.x(), 10., 1e-12);
  EXPECT_NEAR(world.segments[0].b.y(), 21., 1e-12);
  // (2, 1) turned by 90 degrees is (-1, 2).
  EXPECT_NEAR(world.discs[0].center.x(), 9., 1e-12);
  EXPECT_NEAR(world.discs[0].center.y(), 22., 1e-12);
  // Mirrored and moved: (2, 5 - 1), turned (-4, 2).
  EXPECT_NEAR(world.discs[1].center.x(), 6., 1e-12);
  EXPECT_NEAR(world.discs[1].center.y(), 22., 1e-12);
}

struct BadLine {
  std::string text;
  std::string message;
};

TEST(WorldParserTest, ErrorsNameFileLineAndCause) {
  const std::vector<BadLine> bad_lines = {
      {"wal 0 0 1 0", "unknown statement, did you mean 'wall'?"},
      {"Rectangle 0 0 1 1", "did you mean 'rectangle'?"},
      {"zzz 0 0 1 0", "unknown statement"},
      {"circle 1 2", "radius is missing"},
      {"circle 1 2 -3", "outside"},
      {"circle 1 2 x", "'x' is not a number"},
      {"circle 1 2 nan", "not a number"},
      {"circle 1e9 2 3", "outside"},
      {"circle 1 2 3 4", "unexpected value '4'"},
      {"circle 1 2 3 reflectivty=1",
       "unknown option 'reflectivty', did you mean 'reflectivity'?"},
      {"circle 1 2 3 reflectivity=2", "option reflectivity 2 is outside"},
      {"circle 1 2 3 reflectivity=1 reflectivity=1", "twice"},
      {"polygon 0 0 1 1", "at least 3 points"},
      {"polyline 0 0 1", "y is missing"},
      {"wall 0 0 0 0", "no length"},
      {"wall 0 0 5 0 recess=4,2,1", "leaves the wall"},
      {"wall 0 0 5 0 recess=1,2,1 recess=2,1,1", "overlaps"},
      {"wall 0 0 5 0 recess=1,2", "needs 3 comma separated"},
      {"wall 0 0 5 0 recess=1,-2,1", "overlaps"},
      {"end", "no open block"},
      {"place nothing 0 0", "no finished block 'nothing'"},
      {"laser beams=0", "outside"},
      {"laser min_range=5 max_range=4", "min_range must be below"},
      {"laser max_range=50 no_return=40", "no_return"},
      {"laser rate=10 sweep=0.2", "sweep"},
      {"obstacle radius=1 route 1 2 3 4", "expected: path"},
      {"obstacle path 1 2", "at least 2 points"},
      {"obstacle phase=often path 1 2 3 4", "not a number"},
      {"turn", "heading is missing"},
      {"wait -1", "outside"},
      {"fault melt", "kinds are"},
      {"key_distance a 1 1 1 1", "same point"},
      {"key_distance a/b 1 1 2 1", "letters"},
      {"revisit", "name is missing"},
      {"world", "name is missing"},
      {"start 0 0 0", "second time"},
  };
  for (const BadLine& bad : bad_lines) {
    const auto world = ParseWorld(kStart + bad.text, "bad.world");
    ASSERT_FALSE(world.ok()) << bad.text;
    const std::string message(world.status().message());
    EXPECT_EQ(message.find("bad.world:2: "), 0) << message;
    EXPECT_NE(message.find(bad.message), std::string::npos) << message;
  }
}

TEST(WorldParserTest, FileLevelErrors) {
  EXPECT_NE(ParseWorld("circle 0 0 1", "x").status().message().find("no start"),
            std::string::npos);
  const auto open = ParseWorld("start 0 0 0\nblock b\ncircle 0 0 1", "x");
  EXPECT_NE(open.status().message().find("x:2: block 'b' has no end"),
            std::string::npos);
  const auto nested = ParseWorld("block a\nblock b", "x");
  EXPECT_NE(nested.status().message().find("opened at x:1"), std::string::npos);
  EXPECT_FALSE(ParseWorld("block a\nplace a 0 0\nend\nstart 0 0 0", "x").ok());
  EXPECT_FALSE(ParseWorld("", "x").ok());
  EXPECT_FALSE(LoadWorld("/nowhere/at/all.world").ok());
  EXPECT_FALSE(LoadWorld(testing::TempDir()).ok());
}

TEST(WorldParserTest, BlocksCannotExplode) {
  std::string text = "start 0 0 0\nblock b0\npillar 0 0 1\nend\n";
  for (int i = 1; i != 40; ++i) {
    const std::string number = std::to_string(i), last = std::to_string(i - 1);
    text += "block b" + number + "\nplace b" + last + " 0 0\nplace b" + last +
            " 1 0\nend\n";
  }
  const auto world = ParseWorld(text, "bomb.world");
  ASSERT_FALSE(world.ok());
  EXPECT_NE(world.status().message().find("shapes"), std::string::npos);
}

// Whatever is in the file, parsing returns.
TEST(WorldParserTest, SurvivesDamage) {
  for (const char* name :
       {"ri_corridor", "factory_shelves", "office", "circular_room"}) {
    const std::string sample = test::ReadBytes(
        std::string("configuration_files/worlds/") + name + ".world");
    ASSERT_FALSE(sample.empty());
    int accepted = 0;
    test::ForEachMutation(sample, [&accepted](const std::string& damaged) {
      const auto world = ParseWorld(damaged, "damaged.world");
      if (world.ok()) {
        ++accepted;
        for (const Segment& segment : world->segments) {
          ASSERT_TRUE(segment.a.allFinite() && segment.b.allFinite());
        }
      } else {
        ASSERT_EQ(world.status().message().find("damaged.world"), 0);
      }
    });
    EXPECT_LT(accepted, test::FuzzIterations());
  }
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
