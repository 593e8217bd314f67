// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/sensors/laser_model.h"

#include <cmath>
#include <ctime>

#include "cartographer_ext/simulation/world_parser.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

struct Scene {
  World world;
  Drive drive;
  RayCaster plan;
  ObstacleMotion obstacles;

  static Scene Make(const std::string& text) {
    auto world = ParseWorld(text, "test.world");
    EXPECT_TRUE(world.ok()) << world.status();
    auto drive = Drive::Plan(*world, 0);
    EXPECT_TRUE(drive.ok()) << drive.status();
    return {*world, *std::move(drive), RayCaster(world->segments, world->discs),
            ObstacleMotion(world->obstacles, 0)};
  }
  LaserModel Laser(const uint64_t seed = 0) const {
    return LaserModel(world.laser, &plan, &obstacles, seed);
  }
};

constexpr char kRoom[] = "rectangle 0 0 10 6\nstart 4 2 0\n";

TEST(LaserModelTest, ExactRangesInARoom) {
  const Scene scene =
      Scene::Make(std::string(kRoom) + "laser beams=4 fov=360 noise=0");
  const io::LaserScan scan = scene.Laser().Scan(scene.drive, 0.);
  ASSERT_EQ(scan.ranges.size(), 4);
  EXPECT_DOUBLE_EQ(scan.angle_min, -kPi);
  EXPECT_DOUBLE_EQ(scan.angle_increment, kPi / 2.);
  EXPECT_FLOAT_EQ(scan.ranges[0], 4.);  // back
  EXPECT_FLOAT_EQ(scan.ranges[1], 2.);  // right
  EXPECT_FLOAT_EQ(scan.ranges[2], 6.);  // front
  EXPECT_FLOAT_EQ(scan.ranges[3], 4.);  // left
  EXPECT_EQ(scan.time_increment, 0.);
}

TEST(LaserModelTest, AHalfTurnHasBothEnds) {
  const Scene scene =
      Scene::Make(std::string(kRoom) + "laser beams=361 fov=180 noise=0");
  EXPECT_NEAR(scene.world.laser.angle_min, -kPi / 2., 1e-12);
  EXPECT_NEAR(scene.world.laser.angle_increment, DegToRad(0.5), 1e-12);
  const io::LaserScan scan = scene.Laser().Scan(scene.drive, 0.);
  EXPECT_FLOAT_EQ(scan.ranges.front(), 2.);
  EXPECT_FLOAT_EQ(scan.ranges[180], 6.);
  EXPECT_FLOAT_EQ(scan.ranges.back(), 4.);
}

TEST(LaserModelTest, MountingPose) {
  const Scene scene =
      Scene::Make(std::string(kRoom) +
                  "laser beams=4 fov=360 noise=0 x=0.5 y=0.25 theta=90");
  const io::LaserScan scan = scene.Laser().Scan(scene.drive, 0.);
  // At (4.5, 2.25), looking north: back is south.
  EXPECT_FLOAT_EQ(scan.ranges[0], 2.25);
  EXPECT_FLOAT_EQ(scan.ranges[1], 5.5);
  EXPECT_FLOAT_EQ(scan.ranges[2], 3.75);
  EXPECT_FLOAT_EQ(scan.ranges[3], 4.5);
  EXPECT_EQ(scan.laser_pose.x, 0.5);
}

TEST(LaserModelTest, RangeLimitsAndReflectivity) {
  const Scene scene = Scene::Make(
      "polyline 5 -1 5 1\npolyline -4 -1 -4 1 reflectivity=0.25\n"
      "pillar 0 0.5 0.1\npillar 0 -6 1\nstart 0 0 0\n"
      "laser beams=4 fov=360 noise=0 min_range=0.45 max_range=7 no_return=50");
  const io::LaserScan scan = scene.Laser().Scan(scene.drive, 0.);
  EXPECT_FLOAT_EQ(scan.ranges[2], 5.);
  // 4 m is beyond sqrt(0.25) * 7 m; the near pillar is nearer than min_range.
  EXPECT_FLOAT_EQ(scan.ranges[0], 50.);
  EXPECT_FLOAT_EQ(scan.ranges[3], 50.);
  EXPECT_FLOAT_EQ(scan.ranges[1], 5.);
}

TEST(LaserModelTest, NoiseStatistics) {
  const Scene scene = Scene::Make(
      std::string(kRoom) +
      "laser beams=1 fov=10 first=0 noise=0.02 proportional_noise=0.005");
  LaserModel laser = scene.Laser(4);
  double sum = 0., squares = 0.;
  const int kScans = 20000;
  for (int i = 0; i != kScans; ++i) {
    const double error = laser.Scan(scene.drive, 0.).ranges[0] - 6.;
    sum += error;
    squares += error * error;
  }
  const double expected = std::hypot(0.02, 0.005 * 6.);
  EXPECT_NEAR(sum / kScans, 0., 4. * expected / std::sqrt(kScans));
  EXPECT_NEAR(std::sqrt(squares / kScans), expected, 0.02 * expected);
}

TEST(LaserModelTest, DropoutsAndOutliers) {
  const Scene scene = Scene::Make(
      std::string(kRoom) +
      "laser beams=100 fov=10 noise=0 dropout=0.1 outlier=0.05 min_range=0.1");
  LaserModel laser = scene.Laser(9);
  int dropouts = 0, outliers = 0, beams = 0;
  for (int i = 0; i != 300; ++i) {
    const io::LaserScan scan = laser.Scan(scene.drive, 0.);
    for (const float range : scan.ranges) {
      ++beams;
      dropouts += range > scan.range_max;
      outliers += range < 5.99;
      ASSERT_GE(range, 0.1);
    }
  }
  EXPECT_NEAR(dropouts / double(beams), 0.1, 0.006);
  EXPECT_NEAR(outliers / double(beams), 0.9 * 0.05, 0.005);
}

TEST(LaserModelTest, Resolution) {
  const Scene scene = Scene::Make(
      std::string(kRoom) + "laser beams=90 fov=360 noise=0.03 resolution=0.25");
  for (const float range : scene.Laser().Scan(scene.drive, 0.).ranges) {
    EXPECT_FLOAT_EQ(range * 4.f, std::round(range * 4.f));
  }
}

TEST(LaserModelTest, SeesMovingObstacles) {
  const Scene scene = Scene::Make(
      std::string(kRoom) +
      "obstacle radius=0.5 speed=1 path 6 2 9 2\nlaser beams=4 noise=0");
  LaserModel laser = scene.Laser();
  EXPECT_FLOAT_EQ(laser.Scan(scene.drive, 0.).ranges[2], 1.5);
  EXPECT_FLOAT_EQ(laser.Scan(scene.drive, 2.).ranges[2], 3.5);
  EXPECT_FLOAT_EQ(laser.Scan(scene.drive, 4.).ranges[2], 3.5);  // coming back
}

// Driving at 0.5 m/s towards the wall, beams of one sweep shorten as it nears.
TEST(LaserModelTest, RollingScanMovesWithTheRobot) {
  const Scene scene = Scene::Make(
      "polyline 10 -50 10 50\nstart 0 0 0\ngoto 8 0\nrobot speed=0.5\n"
      "laser beams=5 fov=1e-3 first=0 increment=1e-4 noise=0 sweep=0.08");
  const io::LaserScan scan = scene.Laser().Scan(scene.drive, 5.);
  EXPECT_NEAR(scan.time_increment, 0.02, 1e-12);
  const double at_end = 10. - scene.drive.PoseAt(5.).x;
  EXPECT_NEAR(scan.ranges[4], at_end, 1e-5);
  EXPECT_NEAR(scan.ranges[0], at_end + 0.5 * 0.08, 1e-5);
}

TEST(LaserModelTest, OneBeamDoesNotShiftTheOthers) {
  // The same seed with and without a pillar: beams that miss it are identical.
  const std::string laser = "laser beams=360 noise=0.02 dropout=0.05\n";
  const Scene with = Scene::Make(kRoom + laser + "pillar 6 2 0.3");
  const Scene without = Scene::Make(kRoom + laser);
  const io::LaserScan a = with.Laser(2).Scan(with.drive, 0.);
  const io::LaserScan b = without.Laser(2).Scan(without.drive, 0.);
  int different = 0;
  for (size_t i = 0; i != a.ranges.size(); ++i) {
    different += a.ranges[i] != b.ranges[i];
  }
  EXPECT_GT(different, 5);
  EXPECT_LT(different, 25);
}

TEST(LaserModelTest, IsFast) {
  auto world = LoadWorld("configuration_files/worlds/factory_shelves.world");
  ASSERT_TRUE(world.ok()) << world.status();
  const auto drive = Drive::Plan(*world, 0);
  const RayCaster plan(world->segments, world->discs);
  const ObstacleMotion obstacles(world->obstacles, 0);
  LaserModel laser(world->laser, &plan, &obstacles, 0);
  const std::clock_t begin = std::clock();
  int64_t beams = 0;
  for (int i = 0; i != 600; ++i) {
    beams += laser.Scan(*drive, 0.5 * i).ranges.size();
  }
  const double seconds =
      static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  RecordProperty("beams_per_second", static_cast<int>(beams / seconds));
  std::cout << beams / seconds / 1e6 << " million beams a CPU second\n";
  // Far below what an optimised build reaches, so that a debug build passes.
  EXPECT_GT(beams / seconds, 2e4);
}

TEST(LaserModelTest, ASnapshotIsAScanOfTheSameInstant) {
  const Scene scene =
      Scene::Make(std::string(kRoom) + "laser beams=90 fov=360 noise=0.02");
  LaserModel laser = scene.Laser(3), same = scene.Laser(3);
  EXPECT_EQ(laser.Snapshot(scene.drive.PoseAt(0.), {}).ranges,
            same.Scan(scene.drive, 0.).ranges);
  // Obstacles are those that are given.
  Disc disc;
  disc.center = Eigen::Vector2d(5., 2.);
  disc.radius = 0.3;
  EXPECT_NEAR(laser.Snapshot(Pose2(4., 2., 0.), {disc}).ranges[45], 0.7, 0.1);
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
