// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/simulation_output.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/simulation/truth.h"
#include "cartographer_ext/simulation/world_parser.h"
#include "cartographer_ext/simulation/world_picture.h"
#include "cartographer_ext/simulation/world_source.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr char kWorld[] = R"(
world     hall
rectangle 0 0 12 8
rectangle 4 3.5 8 4.5
laser     beams=181 fov=180 noise=0.01 dropout=0.02 x=0.1
odometry  rate=20 phase=0.02 noise=0.005
imu       rate=50 gyro_noise=1e-3
robot     speed=0.6
fault     stale start=20 duration=0.6
start     2 2 0
goto      10 2
goto      10 6
goto      2 6
goto      2 2
goto      10 2
goto      10 4
revisit   p 6 2
key_distance k 0 2 12 2
)";

class SimulationOutputTest : public testing::Test {
 protected:
  void SetUp() override {
    auto world = ParseWorld(kWorld, "hall.world");
    ASSERT_TRUE(world.ok()) << world.status();
    auto simulation =
        Simulation::Create(*std::move(world), SimulationOptions());
    ASSERT_TRUE(simulation.ok()) << simulation.status();
    simulation_ = *std::move(simulation);
    options_.filestem = stem_.path();
    options_.map_resolution = 0.1;
  }
  void TearDown() override {
    for (const std::string& file : summary_.files) std::remove(file.c_str());
  }
  std::vector<std::string> Lines(const std::string& extension) const {
    return absl::StrSplit(test::ReadBytes(stem_.path() + extension), '\n',
                          absl::SkipEmpty());
  }

  test::TemporaryFile stem_{""};
  std::shared_ptr<const Simulation> simulation_;
  SimulationOutputOptions options_;
  SimulationSummary summary_;
};

TEST_F(SimulationOutputTest, LogReadsBackAsTheWorldItself) {
  int64_t told = 0;
  options_.progress = [&told](const int64_t scans) { told = scans; };
  ASSERT_TRUE(WriteSimulation(simulation_, options_, &summary_).ok());
  EXPECT_EQ(summary_.scans, simulation_->num_scans());
  EXPECT_EQ(told, summary_.scans);
  EXPECT_EQ(summary_.imu_readings, simulation_->num_imu());
  EXPECT_EQ(summary_.beams, 181 * summary_.scans);

  auto log =
      io::OpenSensorSource(stem_.path() + ".clf", io::SensorSourceOptions());
  ASSERT_TRUE(log.ok()) << log.status();
  WorldSource source(simulation_);
  int64_t scans = 0, odometry = 0;
  io::SensorEvent from_log, from_world;
  while (true) {
    const auto more = source.Next(&from_world);
    ASSERT_TRUE(more.ok());
    if (!*more) break;
    if (absl::holds_alternative<io::ImuReading>(from_world)) continue;
    const auto read = (*log)->Next(&from_log);
    ASSERT_TRUE(read.ok() && *read) << read.status();
    ASSERT_EQ(from_log.index(), from_world.index());
    ASSERT_NEAR(io::EventTime(from_log), io::EventTime(from_world), 1000);
    if (const auto* scan = absl::get_if<io::LaserScan>(&from_world)) {
      ++scans;
      const auto& other = absl::get<io::LaserScan>(from_log);
      ASSERT_EQ(other.ranges.size(), scan->ranges.size());
      ASSERT_NEAR(other.angle_min, scan->angle_min, 1e-5);
      ASSERT_NEAR(other.angle_increment, scan->angle_increment, 1e-6);
      ASSERT_NEAR(other.laser_pose.x, 0.1, 1e-5);
      for (size_t i = 0; i != scan->ranges.size(); ++i) {
        if (scan->ranges[i] > scan->range_max) {
          ASSERT_GT(other.ranges[i], 24.9);
        } else {
          ASSERT_NEAR(other.ranges[i], scan->ranges[i], 6e-4);
        }
      }
    } else {
      ++odometry;
      const auto& pose = absl::get<io::OdometryReading>(from_world).pose;
      const auto& other = absl::get<io::OdometryReading>(from_log).pose;
      ASSERT_NEAR(other.x, pose.x, 1e-5);
      ASSERT_NEAR(other.y, pose.y, 1e-5);
      ASSERT_NEAR(NormalizeAngle(other.theta - pose.theta), 0., 1e-5);
    }
  }
  EXPECT_EQ(scans, summary_.scans);
  EXPECT_EQ(odometry, summary_.odometry_readings);
}

TEST_F(SimulationOutputTest, TruthFiles) {
  options_.carmen = false;
  ASSERT_TRUE(WriteSimulation(simulation_, options_, &summary_).ok());
  EXPECT_FALSE(test::Exists(stem_.path() + ".clf"));
  const auto trajectory = io::ReadTumTrajectory(stem_.path() + ".tum");
  ASSERT_TRUE(trajectory.ok()) << trajectory.status();
  ASSERT_EQ(trajectory->size(), simulation_->num_scans());
  const double time = simulation_->ScanTime(77);
  const Pose2 truth = simulation_->drive().PoseAt(time);
  EXPECT_EQ((*trajectory)[77].time, simulation_->Stamp(time));
  EXPECT_NEAR((*trajectory)[77].pose.translation().x(), truth.x, 1e-6);
  EXPECT_NEAR((*trajectory)[77].pose.translation().y(), truth.y, 1e-6);

  const auto relations = io::ReadRelations(stem_.path() + ".relations");
  ASSERT_TRUE(relations.ok()) << relations.status();
  EXPECT_EQ(relations->size(),
            summary_.sequential_relations + summary_.loop_relations);
  // Relations and trajectory tell the same motion.
  const auto pose_at = [&](const io::TimeNs stamp) {
    return simulation_->drive().PoseAt(io::ToSeconds(stamp) -
                                       simulation_->world().begin);
  };
  for (const io::StampedRelation& relation : *relations) {
    const Pose2 expected =
        Between(pose_at(relation.time1), pose_at(relation.time2));
    ASSERT_NEAR(relation.relative.translation().x(), expected.x, 1e-5);
    ASSERT_NEAR(relation.relative.translation().y(), expected.y, 1e-5);
  }

  const auto faults = Lines(".faults.csv");
  ASSERT_EQ(faults.size(), 2);
  EXPECT_EQ(faults[0], "kind,start,end,distance,angle");
  EXPECT_TRUE(absl::StartsWith(faults[1], "stale,"));
  const auto places = Lines(".places.csv");
  ASSERT_EQ(places.size(), 3);
  EXPECT_TRUE(absl::StartsWith(places[1], "p,1,"));
  EXPECT_TRUE(absl::StartsWith(places[2], "p,2,"));
  const auto distances = Lines(".distances.csv");
  ASSERT_EQ(distances.size(), 2);
  EXPECT_TRUE(absl::StartsWith(distances[1], "k,12.000000,"));
  EXPECT_EQ(Lines(".truth.loops.csv").size(), 1 + summary_.loop_relations);
  EXPECT_TRUE(test::Exists(stem_.path() + ".truth.pgm"));
  EXPECT_TRUE(test::Exists(stem_.path() + ".truth.yaml"));
}

TEST_F(SimulationOutputTest, Repeats) {
  ASSERT_TRUE(WriteSimulation(simulation_, options_, &summary_).ok());
  const std::string log = test::ReadBytes(stem_.path() + ".clf");
  const std::string map = test::ReadBytes(stem_.path() + ".truth.pgm");
  ASSERT_TRUE(WriteSimulation(simulation_, options_, &summary_).ok());
  EXPECT_EQ(log, test::ReadBytes(stem_.path() + ".clf"));
  EXPECT_EQ(map, test::ReadBytes(stem_.path() + ".truth.pgm"));
}

TEST_F(SimulationOutputTest, BagWhereCompiledIn) {
  options_.bag = true;
  options_.carmen = false;
  const absl::Status status = WriteSimulation(simulation_, options_, &summary_);
#ifdef CARTOGRAPHER_EXT_HAS_ROSBAG
  ASSERT_TRUE(status.ok()) << status;
  auto bag =
      io::OpenSensorSource(stem_.path() + ".bag", io::SensorSourceOptions());
  ASSERT_TRUE(bag.ok()) << bag.status();
  EXPECT_EQ((*bag)->info().num_scans, summary_.scans);
  EXPECT_EQ((*bag)->info().num_imu, summary_.imu_readings);
#else
  EXPECT_FALSE(status.ok());
#endif
}

TEST_F(SimulationOutputTest, UnwritableFolderIsAnError) {
  options_.filestem = "/nowhere/at/all/stem";
  const absl::Status status = WriteSimulation(simulation_, options_, &summary_);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.message().find("/nowhere/at/all"), std::string::npos);
}

TEST_F(SimulationOutputTest, Picture) {
  const test::TemporaryFile file(".png");
  ASSERT_TRUE(WriteWorldPicture(*simulation_, 300, file.path()).ok());
  const std::string png = test::ReadBytes(file.path());
  ASSERT_GT(png.size(), 1000);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_FALSE(WriteWorldPicture(*simulation_, 10, file.path()).ok());
  EXPECT_FALSE(WriteWorldPicture(*simulation_, 300, "/nowhere/p.png").ok());
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
