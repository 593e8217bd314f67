// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/slam_runner.h"

#include <vector>

#include "cartographer_ext/map/host_map.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/metrics/trajectory_metrics.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/slam/room_source.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

SlamConfiguration Stock() {
  auto configuration =
      LoadSlamConfiguration({"configuration_files"}, "stock.lua");
  CHECK(configuration.ok()) << configuration.status();
  return *configuration;
}

// Events that a test has put together.
class ListSource : public io::SensorSource {
 public:
  explicit ListSource(std::vector<io::SensorEvent> events)
      : events_(std::move(events)) {
    for (const io::SensorEvent& event : events_) {
      if (absl::holds_alternative<io::LaserScan>(event)) ++info_.num_scans;
      if (absl::holds_alternative<io::OdometryReading>(event)) {
        ++info_.num_odometry;
      }
      if (absl::holds_alternative<io::ImuReading>(event)) ++info_.num_imu;
    }
  }
  const io::SensorSourceInfo& info() const override { return info_; }
  absl::StatusOr<bool> Next(io::SensorEvent* event) override {
    if (next_ == error_at_) return absl::DataLossError("line 7 is torn");
    if (next_ == events_.size()) return false;
    *event = events_[next_++];
    return true;
  }
  void FailAt(size_t index) { error_at_ = index; }

 private:
  const std::vector<io::SensorEvent> events_;
  io::SensorSourceInfo info_;
  size_t next_ = 0;
  size_t error_at_ = static_cast<size_t>(-1);
};

io::LaserScan RoomScan(int index) {
  return test::RoomSource::Scan(
      test::RoomSource::kStart + index * test::RoomSource::kStep,
      test::RoomSource::TruePose(index));
}

TEST(SlamRunnerTest, FollowsTheRobotRoundTheRoom) {
  constexpr int kNumScans = 450;
  test::RoomSource source(kNumScans);
  int64_t last_scan = 0;
  bool optimized = false;
  SlamRunOptions options;
  options.on_progress = [&](const SlamProgress& progress) {
    EXPECT_EQ(progress.total_scans, kNumScans);
    EXPECT_GE(progress.scans, last_scan);
    last_scan = progress.scans;
    optimized = progress.stage == SlamProgress::Stage::kOptimizing;
  };
  const auto run = RunSlam(Stock(), &source, options);
  ASSERT_TRUE(run.ok()) << run.status();
  EXPECT_EQ(run->scans, kNumScans);
  EXPECT_EQ(run->odometry_readings, kNumScans);
  EXPECT_EQ(run->imu_readings, 0);
  EXPECT_EQ(run->skipped_scans, 0);
  EXPECT_NEAR(run->sensor_seconds, 44.9, 1e-9);
  EXPECT_EQ(last_scan, kNumScans);
  EXPECT_TRUE(optimized);
  EXPECT_GT(run->nodes, 100);
  EXPECT_GE(run->submaps, 2);
  EXPECT_GE(run->intra_constraints, run->nodes);
  EXPECT_GT(run->wall_seconds, 0.);
  EXPECT_GT(run->cpu_seconds, 0.);
  EXPECT_GT(run->front_end_cpu_seconds, 0.);
  EXPECT_GT(run->peak_memory_bytes, 1 << 20);
  EXPECT_LE(run->loops_found, run->loop_searches);
  EXPECT_EQ(run->inter_constraints, run->loops_found);
  EXPECT_TRUE(run->warnings.empty());

  // A pose at every scan, local and global, and right.
  ASSERT_GE(run->local_scan_poses.size(), kNumScans - 1u);
  ASSERT_EQ(run->global_scan_poses.size(), run->local_scan_poses.size());
  std::vector<StampedPose> truth;
  for (int i = 0; i < kNumScans; ++i) {
    truth.push_back({test::RoomSource::kStart + i * test::RoomSource::kStep,
                     ToIsometry(test::RoomSource::TruePose(i))});
  }
  const auto errors =
      ComputeTrajectoryErrors(Trajectory(run->global_scan_poses),
                              Trajectory(truth), TrajectoryMetricsOptions());
  ASSERT_TRUE(errors.ok());
  EXPECT_EQ(errors->num_pairs,
            static_cast<int64_t>(run->global_scan_poses.size()));
  EXPECT_LT(errors->ate.max, 0.1);
  EXPECT_LT(errors->ate_rotation_degrees.max, 2.);
}

TEST(SlamRunnerTest, TheMapInAFileIsTheOneInMemory) {
  test::RoomSource source(200);
  const auto run = RunSlam(Stock(), &source, SlamRunOptions());
  ASSERT_TRUE(run.ok()) << run.status();
  const MapGraph graph = MakeMapGraph(*run->map_builder->pose_graph());
  EXPECT_EQ(static_cast<int64_t>(graph.nodes.size()), run->nodes);
  EXPECT_EQ(static_cast<int64_t>(graph.submaps.size()), run->submaps);
  EXPECT_EQ(graph.num_loops(), run->inter_constraints);
  const std::string filename = testing::TempDir() + "slam_runner.pbstream";
  ASSERT_TRUE(WritePbstream(run->map_builder.get(), filename).ok());
  const auto pbstream = io::ReadPbstream(filename);
  ASSERT_TRUE(pbstream.ok()) << pbstream.status();
  const MapGraph stored = MakeMapGraph(*pbstream);
  ASSERT_EQ(stored.nodes.size(), graph.nodes.size());
  for (const auto& entry : graph.nodes) {
    const GraphNode& other = stored.nodes.at(entry.first);
    EXPECT_EQ(other.time, entry.second.time);
    const Pose2 difference =
        Between(entry.second.global_pose, other.global_pose);
    EXPECT_LT(difference.translation().norm(), 1e-9);
    EXPECT_LT(std::abs(difference.theta), 1e-9);
  }
  // Constraints of inserted nodes are the local poses in both.
  for (const MapGraph* one : {&graph, &stored}) {
    for (const GraphConstraint& constraint : one->constraints) {
      if (constraint.is_loop) continue;
      const Pose2 difference =
          Between(constraint.relative_pose,
                  Between(one->submaps.at(constraint.submap_id).local_pose,
                          one->nodes.at(constraint.node_id).local_pose));
      EXPECT_LT(difference.translation().norm(), 1e-6);
      EXPECT_LT(std::abs(difference.theta), 1e-6);
    }
  }
  const auto painted = PaintHostMap(*run->map_builder->pose_graph(), 0.05);
  const auto painted_again = PaintPbstreamMap(*pbstream, 0.05);
  ASSERT_TRUE(painted.ok() && painted_again.ok());
  EXPECT_EQ(painted->width, painted_again->width);
  EXPECT_EQ(painted->height, painted_again->height);
  // The room is eight by six metres.
  EXPECT_NEAR(painted->width * 0.05, 8., 2.5);
  EXPECT_NEAR(painted->height * 0.05, 8., 2.5);
}

TEST(SlamRunnerTest, LeavesOutWhatTheHostWouldNotStand) {
  std::vector<io::SensorEvent> events;
  for (int i = 0; i < 10; ++i) {
    io::OdometryReading reading;
    reading.time = test::RoomSource::kStart + i * test::RoomSource::kStep;
    reading.pose = test::RoomSource::TruePose(i);
    events.push_back(reading);
    events.push_back(reading);  // twice
    events.push_back(RoomScan(i));
  }
  events.push_back(RoomScan(9));  // twice
  io::LaserScan blind = RoomScan(10);
  blind.ranges.assign(180, 100.f);
  events.push_back(blind);
  events.push_back(RoomScan(11));
  ListSource source(events);
  const auto run = RunSlam(Stock(), &source, SlamRunOptions());
  ASSERT_TRUE(run.ok()) << run.status();
  EXPECT_EQ(run->scans, 11);
  EXPECT_EQ(run->skipped_scans, 2);
  EXPECT_EQ(run->odometry_readings, 10);
  EXPECT_EQ(run->skipped_readings, 10);
  EXPECT_EQ(run->warnings.size(), 2u);
}

TEST(SlamRunnerTest, WorksWithoutOdometry) {
  test::RoomSource source(60, false);
  const auto run = RunSlam(Stock(), &source, SlamRunOptions());
  ASSERT_TRUE(run.ok()) << run.status();
  EXPECT_EQ(run->odometry_readings, 0);
  EXPECT_GE(run->global_scan_poses.size(), 59u);

  test::RoomSource with_odometry(60);
  SlamConfiguration configuration = Stock();
  configuration.sensors.use_odometry = false;
  const auto ignored = RunSlam(configuration, &with_odometry, SlamRunOptions());
  ASSERT_TRUE(ignored.ok()) << ignored.status();
  EXPECT_EQ(ignored->odometry_readings, 0);
}

TEST(SlamRunnerTest, UsesTheImuWhenAskedTo) {
  std::vector<io::SensorEvent> events;
  for (int i = 0; i < 30; ++i) {
    io::ImuReading reading;
    reading.time = test::RoomSource::kStart + i * test::RoomSource::kStep;
    reading.linear_acceleration = Eigen::Vector3d(0., 0., 9.81);
    reading.angular_velocity = Eigen::Vector3d(0., 0., 2. * kPi / 40.);
    events.push_back(reading);
    events.push_back(RoomScan(i));
  }
  SlamConfiguration configuration = Stock();
  configuration.trajectory_builder_options
      .mutable_trajectory_builder_2d_options()
      ->set_use_imu_data(true);
  ListSource source(events);
  const auto run = RunSlam(configuration, &source, SlamRunOptions());
  ASSERT_TRUE(run.ok()) << run.status();
  EXPECT_EQ(run->imu_readings, 30);
  EXPECT_GT(run->nodes, 5);

  test::RoomSource without(10);
  const auto refused = RunSlam(configuration, &without, SlamRunOptions());
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(std::string(refused.status().message()),
              testing::HasSubstr("use_imu_data"));
}

TEST(SlamRunnerTest, UsesTheImuOfARecordingThatHasOne) {
  std::vector<io::SensorEvent> events;
  for (int i = 0; i < 30; ++i) {
    io::ImuReading reading;  // upside down
    reading.time = test::RoomSource::kStart + i * test::RoomSource::kStep;
    reading.linear_acceleration = Eigen::Vector3d(0., 0., -9.81);
    reading.angular_velocity = Eigen::Vector3d(0., 0., -2. * kPi / 40.);
    events.push_back(reading);
    events.push_back(RoomScan(i));
  }
  SlamConfiguration configuration = Stock();
  configuration.trajectory_builder_options
      .mutable_trajectory_builder_2d_options()
      ->set_use_imu_data(false);
  ListSource unused(events);
  const auto plain = RunSlam(configuration, &unused, SlamRunOptions());
  ASSERT_TRUE(plain.ok()) << plain.status();
  EXPECT_EQ(plain->imu_readings, 0);

  configuration.sensors.use_recorded_imu = true;
  ListSource source(events);
  const auto run = RunSlam(configuration, &source, SlamRunOptions());
  ASSERT_TRUE(run.ok()) << run.status();
  EXPECT_EQ(run->imu_readings, 30);
  EXPECT_GT(run->nodes, 5);

  test::RoomSource without(10);
  const auto run_without = RunSlam(configuration, &without, SlamRunOptions());
  ASSERT_TRUE(run_without.ok()) << run_without.status();
  EXPECT_EQ(run_without->imu_readings, 0);
}

TEST(SlamRunnerTest, PassesErrorsOfTheSourceOn) {
  ListSource torn({RoomScan(0), RoomScan(1)});
  torn.FailAt(1);
  const auto run = RunSlam(Stock(), &torn, SlamRunOptions());
  ASSERT_FALSE(run.ok());
  EXPECT_THAT(std::string(run.status().message()),
              testing::HasSubstr("line 7 is torn"));
  ListSource empty({});
  EXPECT_FALSE(RunSlam(Stock(), &empty, SlamRunOptions()).ok());
  io::LaserScan blind = RoomScan(0);
  blind.ranges.assign(180, 100.f);
  ListSource only_blind({blind});
  EXPECT_FALSE(RunSlam(Stock(), &only_blind, SlamRunOptions()).ok());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
