// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/online_localizer.h"

#include "gtest/gtest.h"
#include "tests/navigation/closed_loop/room_run.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(OnlineLocalizerTest, FollowsARecordingSensorBySensor) {
  const Room& room = Room::Get();
  auto localizer = OnlineLocalizer::Create(room.configuration,
                                           room.pbstream_filename, Pose2());
  ASSERT_TRUE(localizer.ok()) << localizer.status();
  EXPECT_FALSE((*localizer)->Latest().has_value());
  simulation::World world = room.world;
  world.begin = 10000.;
  simulation::SimulationOptions options;
  options.seed = 9;
  auto simulation = simulation::Simulation::Create(world, options);
  ASSERT_TRUE(simulation.ok());
  const std::shared_ptr<const simulation::Simulation> shared =
      *std::move(simulation);
  simulation::WorldSource source(shared);
  io::SensorEvent event;
  int matched = 0;
  while (*source.Next(&event)) {
    if (absl::holds_alternative<io::LaserScan>(event)) {
      (*localizer)->Add(absl::get<io::LaserScan>(event));
    } else if (absl::holds_alternative<io::OdometryReading>(event)) {
      (*localizer)->Add(absl::get<io::OdometryReading>(event));
    }
    const auto latest = (*localizer)->Latest();
    if (!latest.has_value()) continue;
    ++matched;
    // The map begins at (1, 1) of the world.
    const Pose2 truth =
        shared->drive().PoseAt(io::ToSeconds(latest->time) - world.begin);
    EXPECT_LT((latest->map_from_robot.translation() -
               Eigen::Vector2d(truth.x - 1., truth.y - 1.))
                  .norm(),
              0.15);
  }
  EXPECT_GT(matched, 300);
  EXPECT_EQ((*localizer)->timeouts(), 0);
}

TEST(OnlineLocalizerTest, SaysWhenThereIsNoMap) {
  const auto error = OnlineLocalizer::Create(Room::Get().configuration,
                                             "/no/such.pbstream", Pose2());
  ASSERT_FALSE(error.ok());
  EXPECT_NE(error.status().message().find("such.pbstream"),
            absl::string_view::npos);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
