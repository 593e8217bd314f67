// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/truth_map.h"

#include <cmath>
#include <memory>
#include <string>

#include "cartographer_ext/simulation/world_parser.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

std::unique_ptr<const Simulation> Create(const std::string& text) {
  auto world = ParseWorld(text, "test.world");
  EXPECT_TRUE(world.ok()) << world.status();
  auto simulation = Simulation::Create(*std::move(world), SimulationOptions());
  EXPECT_TRUE(simulation.ok()) << simulation.status();
  return *std::move(simulation);
}

float At(const io::OccupancyMap& map, const double x, const double y) {
  return map.at(
      static_cast<int>(std::floor((x - map.origin.x) / map.resolution)),
      static_cast<int>(std::floor((y - map.origin.y) / map.resolution)));
}

TEST(TruthMapTest, ARoomWithABox) {
  // Walls in the middle of cells.
  const auto simulation = Create(
      "rectangle 0.05 0.05 8.05 5.05\nrectangle 3.05 2.05 4.05 3.05\n"
      "obstacle speed=0 path 6 4 6 4\n"
      "laser noise=0.5 dropout=0.5\nstart 1 1 0\ngoto 6 1\ngoto 7 4\n");
  const auto map = MakeTruthMap(*simulation, 0.1);
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->resolution, 0.1);
  EXPECT_NEAR(map->origin.x, -0.2, 1e-9);
  EXPECT_GE(map->width, 83);
  EXPECT_GE(map->height, 53);
  // Walls, the face of the box, free floor, the unseen inside of the box.
  EXPECT_EQ(At(*map, 8.05, 2.5), 1.f);
  EXPECT_EQ(At(*map, 4., 0.05), 1.f);
  EXPECT_EQ(At(*map, 3.5, 2.05), 1.f);
  EXPECT_EQ(At(*map, 2., 1.), 0.f);
  EXPECT_EQ(At(*map, 6., 4.), 0.f);  // the obstacle is no part of the map
  EXPECT_TRUE(std::isnan(At(*map, 3.5, 2.5)));
  EXPECT_TRUE(std::isnan(map->at(0, 0)));
}

TEST(TruthMapTest, OutOfRangeStaysUnknown) {
  const auto simulation =
      Create("rectangle 0 0 30 2\nlaser max_range=5\nstart 1 1 0\ngoto 3 1\n");
  const auto map = MakeTruthMap(*simulation, 0.1);
  ASSERT_TRUE(map.ok());
  EXPECT_EQ(At(*map, 4., 1.5), 0.f);
  EXPECT_TRUE(std::isnan(At(*map, 20., 1.)));
  EXPECT_TRUE(std::isnan(At(*map, 30., 1.)));
}

TEST(TruthMapTest, RefusesSillySizes) {
  const auto simulation = Create(
      "polyline -9000 0 9000 1\npolyline 0 -9000 1 9000\nstart 50 50 0\n");
  EXPECT_FALSE(MakeTruthMap(*simulation, 0.05).ok());
  EXPECT_FALSE(MakeTruthMap(*simulation, 0.).ok());
  EXPECT_FALSE(MakeTruthMap(*simulation, std::nan("")).ok());
  EXPECT_TRUE(MakeTruthMap(*Create("start 0 0 0"), 0.1).ok());
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
