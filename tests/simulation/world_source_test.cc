// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/world_source.h"

#include <cstring>
#include <string>
#include <vector>

#include "cartographer_ext/simulation/world_parser.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr char kWorld[] = R"(
rectangle 0 0 12 6
laser     beams=90 noise=0.01 dropout=0.01 rate=10
odometry  rate=20 phase=0.02 noise=0.01 scale_sigma=0.02
imu       rate=50 gyro_noise=1e-3
obstacle  phase=random path 3 5 9 5
robot     jitter=0.05
start     2 3 0
goto      9 3
wait      1
)";

absl::StatusOr<std::unique_ptr<const Simulation>> Create(
    const std::string& text, const SimulationOptions& options) {
  auto world = ParseWorld(text, "test.world");
  EXPECT_TRUE(world.ok()) << world.status();
  return Simulation::Create(*std::move(world), options);
}

// Everything a run says, as bytes.
std::string Record(const std::string& text, const SimulationOptions& options) {
  auto simulation = Create(text, options);
  EXPECT_TRUE(simulation.ok()) << simulation.status();
  WorldSource source(*std::move(simulation));
  std::string record;
  const auto append = [&record](const void* data, const size_t size) {
    record.append(static_cast<const char*>(data), size);
  };
  io::SensorEvent event;
  while (true) {
    const auto more = source.Next(&event);
    EXPECT_TRUE(more.ok());
    if (!*more) return record;
    const io::TimeNs time = io::EventTime(event);
    append(&time, sizeof(time));
    if (const auto* scan = absl::get_if<io::LaserScan>(&event)) {
      append(scan->ranges.data(), scan->ranges.size() * sizeof(float));
    } else if (const auto* odometry =
                   absl::get_if<io::OdometryReading>(&event)) {
      append(&odometry->pose.x, sizeof(double));
      append(&odometry->pose.y, sizeof(double));
      append(&odometry->pose.theta, sizeof(double));
    } else {
      const auto& imu = absl::get<io::ImuReading>(event);
      append(imu.angular_velocity.data(), 3 * sizeof(double));
      append(imu.linear_acceleration.data(), 3 * sizeof(double));
    }
  }
}

TEST(WorldSourceTest, EventsComeInOrderAndAsAnnounced) {
  auto simulation = Create(kWorld, SimulationOptions());
  ASSERT_TRUE(simulation.ok()) << simulation.status();
  WorldSource source(*std::move(simulation));
  const io::SensorSourceInfo info = source.info();
  EXPECT_EQ(info.format, "world");
  EXPECT_EQ(info.begin, 100000000000);
  int64_t scans = 0, odometry = 0, imu = 0;
  io::TimeNs last = 0;
  size_t last_kind = 0;
  io::SensorEvent event;
  while (true) {
    const auto more = source.Next(&event);
    ASSERT_TRUE(more.ok());
    if (!*more) break;
    const io::TimeNs time = io::EventTime(event);
    ASSERT_GE(time, last);
    ASSERT_LE(time, info.end + 1);
    if (time == last && absl::holds_alternative<io::OdometryReading>(event)) {
      ASSERT_NE(last_kind, 0) << "odometry must come before a scan";
    }
    last = time;
    last_kind = event.index();
    scans += absl::holds_alternative<io::LaserScan>(event);
    odometry += absl::holds_alternative<io::OdometryReading>(event);
    imu += absl::holds_alternative<io::ImuReading>(event);
  }
  EXPECT_EQ(scans, info.num_scans);
  EXPECT_EQ(odometry, info.num_odometry);
  EXPECT_EQ(imu, info.num_imu);
  const double duration = source.simulation().drive().duration();
  EXPECT_NEAR(scans, 10. * duration, 1.01);
  EXPECT_NEAR(odometry, 20. * duration, 1.01);
  EXPECT_NEAR(imu, 50. * duration, 1.01);
}

TEST(WorldSourceTest, SameSeedSameBytes) {
  SimulationOptions options;
  options.seed = 7;
  options.odometry_faults = "offset:0.05";
  const std::string once = Record(kWorld, options);
  EXPECT_GT(once.size(), 10000);
  EXPECT_EQ(once, Record(kWorld, options));
  options.seed = 8;
  EXPECT_NE(once, Record(kWorld, options));
}

TEST(WorldSourceTest, OneSensorDoesNotDisturbAnother) {
  // Without the IMU and with another laser, odometry stays what it was.
  std::string other = kWorld;
  other.replace(other.find("imu "), 3, "#  ");
  other.replace(other.find("beams=90"), 8, "beams=45");
  auto a = Create(kWorld, SimulationOptions());
  auto b = Create(other, SimulationOptions());
  ASSERT_TRUE(a.ok() && b.ok());
  ASSERT_EQ((*b)->num_imu(), 0);
  const auto& left = (*a)->odometry().readings;
  const auto& right = (*b)->odometry().readings;
  ASSERT_EQ(left.size(), right.size());
  for (size_t i = 0; i != left.size(); ++i) {
    ASSERT_EQ(left[i].pose.x, right[i].pose.x);
    ASSERT_EQ(left[i].pose.theta, right[i].pose.theta);
  }
}

// The scan is the first one of the stall, its stamp that of the last.
TEST(WorldSourceTest, AStallHoldsAScanBack) {
  auto plain = Create(kWorld, SimulationOptions());
  auto stalled =
      Create(std::string(kWorld) + "fault stall start=0.95 duration=0.6\n",
             SimulationOptions());
  ASSERT_TRUE(plain.ok() && stalled.ok());
  // 1.0 to 1.5 s after the start, one scan instead of six.
  EXPECT_EQ((*stalled)->num_scans(), (*plain)->num_scans() - 5);
  for (const int64_t i : {9, 11, 20}) {
    const double time = (*stalled)->ScanTime(i);
    EXPECT_DOUBLE_EQ((*stalled)->MeasuredTime(i), time);
    EXPECT_DOUBLE_EQ((*plain)->ScanTime(i < 10 ? i : i + 5), time);
  }
  EXPECT_DOUBLE_EQ((*stalled)->MeasuredTime(10), (*plain)->ScanTime(10));
  EXPECT_DOUBLE_EQ((*stalled)->ScanTime(10), (*plain)->ScanTime(15));
  SimulationOptions options;
  options.scan_stalls = 99;
  EXPECT_FALSE(Create(kWorld, options).ok());
  options.perfect = true;
  EXPECT_TRUE(Create(kWorld, options).ok());
}

TEST(WorldSourceTest, PerfectHasNoErrors) {
  SimulationOptions options;
  options.perfect = true;
  options.odometry_faults = "offset:0.05";
  auto simulation = Create(kWorld, options);
  ASSERT_TRUE(simulation.ok());
  EXPECT_TRUE((*simulation)->odometry().labels.empty());
  const Pose2 end = (*simulation)->odometry().readings.back().pose;
  EXPECT_NEAR(end.x, (*simulation)->drive().PoseAt(1e3).x - 2., 1e-4);
}

// Whatever a damaged file asks for, planning and simulating it returns.
TEST(WorldSourceTest, SurvivesDamage) {
  test::ForEachMutation(
      kWorld,
      [](const std::string& damaged) {
        auto world = ParseWorld(damaged, "damaged.world");
        if (!world.ok()) return;
        auto simulation =
            Simulation::Create(*std::move(world), SimulationOptions());
        if (!simulation.ok()) return;
        WorldSource source(*std::move(simulation));
        io::SensorEvent event;
        for (int i = 0; i != 100; ++i) {
          const auto more = source.Next(&event);
          ASSERT_TRUE(more.ok());
          if (!*more) break;
        }
      },
      200);
}

TEST(WorldSourceTest, CollisionsAreErrors) {
  const auto wall =
      Create("polyline 3 -1 3 1\nstart 0 0 0\ngoto 5 0", SimulationOptions());
  ASSERT_FALSE(wall.ok());
  EXPECT_NE(wall.status().message().find("touches a wall at (2."),
            std::string::npos)
      << wall.status();
  const auto person =
      Create("obstacle speed=0 path 3 0 3 0\nstart 0 0 0\ngoto 5 0",
             SimulationOptions());
  ASSERT_FALSE(person.ok());
  EXPECT_NE(person.status().message().find("touches obstacle 1"),
            std::string::npos);
  EXPECT_TRUE(Create("robot radius=0\npolyline 3 -1 3 1\nstart 0 0 0\ngoto 5 0",
                     SimulationOptions())
                  .ok());
}

TEST(WorldSourceTest, OpenWorldTellsWhatIsWrong) {
  EXPECT_FALSE(OpenWorld("/nowhere.world", 0).ok());
  test::TemporaryFile file(".world");
  test::WriteBytes(file.path(), "start 0 0 0\nflor 1 2\n");
  const auto bad = OpenWorld(file.path(), 0);
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.status().message().find(file.path() + ":2: "), 0);
  test::WriteBytes(file.path(), kWorld);
  EXPECT_TRUE(OpenWorld(file.path(), 0).ok());
  SimulationOptions options;
  options.odometry_faults = "stale:99";
  const auto faults = OpenWorldWithOptions(file.path(), options);
  ASSERT_FALSE(faults.ok());
  EXPECT_EQ(faults.status().message().find(file.path()), 0);
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
