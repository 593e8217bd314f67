// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/obstacle_layer.h"

#include <cmath>

#include "gtest/gtest.h"
#include "tests/navigation/test_maps.h"

namespace cartographer_ext {
namespace navigation {
namespace {

class ObstacleLayerTest : public testing::Test {
 protected:
  ObstacleLayerTest() : costmap_(MakeCostmap(RoomMap(10., 6.))) {}

  Cell At(const double x, const double y) const {
    return costmap_.geometry().CellAt({x, y});
  }
  ScanInMap Scan(const double time,
                 const std::vector<Eigen::Vector2d>& echoes) const {
    ScanInMap scan;
    scan.time = time;
    scan.laser = Eigen::Vector2d(2., 3.);
    scan.echoes = echoes;
    return scan;
  }

  const Costmap costmap_;
};

TEST_F(ObstacleLayerTest, MarksWhatTheMapDoesNotHave) {
  ObstacleLayer layer(&costmap_, ObstacleLayerOptions());
  layer.Update(Scan(0., {{5., 3.}, {9.95, 3.5}, {9.8, 3.2}}));
  EXPECT_TRUE(layer.IsMarked(At(5., 3.)));
  // At the wall, and beyond the range of the layer.
  EXPECT_FALSE(layer.IsMarked(At(9.95, 3.5)));
  EXPECT_EQ(layer.marks().size(), 1u);
}

TEST_F(ObstacleLayerTest, BeamsClearWhatTheyPass) {
  ObstacleLayer layer(&costmap_, ObstacleLayerOptions());
  layer.Update(Scan(0., {{4., 3.}, {4., 4.}}));
  layer.Update(Scan(0.1, {{9.95, 3.}}));
  EXPECT_FALSE(layer.IsMarked(At(4., 3.)));
  EXPECT_TRUE(layer.IsMarked(At(4., 4.)));
  ScanInMap scan = Scan(0.2, {});
  scan.free_ends.push_back({6., 5.});
  layer.Update(scan);
  EXPECT_TRUE(layer.marks().empty());
}

TEST_F(ObstacleLayerTest, ForgetsAfterAWhile) {
  ObstacleLayerOptions options;
  options.memory_seconds = 10.;
  ObstacleLayer layer(&costmap_, options);
  layer.Update(Scan(-1., {{4., 3.}}));
  layer.Update(Scan(0., {{4., 3.}, {3., 2.}}));
  layer.Update(Scan(2., {}));
  EXPECT_TRUE(layer.IsMarked(At(4., 3.)));
  EXPECT_FALSE(layer.IsMarked(At(3., 2.)));  // was there for an instant
  layer.Update(Scan(9., {{3., 4.5}}));
  EXPECT_TRUE(layer.IsMarked(At(4., 3.)));
  layer.Update(Scan(10.4, {}));
  EXPECT_FALSE(layer.IsMarked(At(4., 3.)));
  EXPECT_TRUE(layer.IsMarked(At(3., 4.5)));
  layer.Clear({3., 4.}, 1., 10.);
  EXPECT_TRUE(layer.marks().empty());
}

TEST_F(ObstacleLayerTest, KeepsWhatItIsToldTo) {
  ObstacleLayerOptions options;
  options.memory_seconds = 10.;
  ObstacleLayer layer(&costmap_, options);
  const std::vector<Eigen::Vector2d> echoes = {{4., 3.}, {4., 4.5}, {8., 1.}};
  layer.Update(Scan(-1.2, echoes));
  layer.Update(Scan(0., echoes));
  layer.Keep({4., 3.}, 2., 40.);
  layer.Update(Scan(30., {}));
  EXPECT_TRUE(layer.IsMarked(At(4., 3.)));
  EXPECT_TRUE(layer.IsMarked(At(4., 4.5)));
  EXPECT_FALSE(layer.IsMarked(At(8., 1.)));  // too far away
  // Beams clear it all the same.
  layer.Update(Scan(31., {{6., 3.}}));
  EXPECT_FALSE(layer.IsMarked(At(4., 3.)));
  EXPECT_TRUE(layer.IsMarked(At(4., 4.5)));
  layer.LetGo();
  layer.Update(Scan(32., {}));
  EXPECT_FALSE(layer.IsMarked(At(4., 4.5)));
  // Until then and no longer.
  layer.Update(Scan(33., {{4., 4.5}}));
  layer.Update(Scan(34.2, {{4., 4.5}}));
  layer.Keep({4., 4.}, 2., 50.);
  layer.Update(Scan(49.9, {}));
  EXPECT_TRUE(layer.IsMarked(At(4., 4.5)));
  layer.Update(Scan(50.1, {}));
  EXPECT_FALSE(layer.IsMarked(At(4., 4.5)));
}

TEST_F(ObstacleLayerTest, NoPathIsPlannedAroundWhatPassesBy) {
  ObstacleLayer layer(&costmap_, ObstacleLayerOptions());
  for (int i = 0; i != 20; ++i) {
    // Somebody walks across, something else stays.
    layer.Update(Scan(0.1 * i, {{5.02, 1.02 + 0.1 * i}, {4., 4.5}}));
  }
  EXPECT_TRUE(layer.IsMarked(At(5.02, 2.92)));
  EXPECT_FALSE(layer.IsSettled(At(5.02, 2.92)));
  EXPECT_TRUE(layer.IsSettled(At(4., 4.5)));
  WeightGrid weights;
  layer.ApplyTo(&weights);
  EXPECT_EQ(weights.at(At(5.02, 2.92)), costmap_.weights().at(At(5.02, 2.92)));
  EXPECT_EQ(weights.at(At(4., 4.5)), kBlocked);
}

TEST_F(ObstacleLayerTest, BeamsThatGrazeAnObstacleDoNotMakeItNew) {
  // In every scan one beam ends in the cell and another passes through it.
  ObstacleLayer layer(&costmap_, ObstacleLayerOptions());
  for (int i = 0; i <= 12; ++i) {
    layer.Update(Scan(0.1 * i, {{5.01, 3.01}, {9.95, 3.03}}));
  }
  EXPECT_TRUE(layer.IsSettled(At(5.01, 3.01)));
  // Away for longer, it is new.
  layer.Update(Scan(1.3, {{9.95, 3.03}}));
  layer.Update(Scan(2.5, {{5.01, 3.01}}));
  EXPECT_TRUE(layer.IsMarked(At(5.01, 3.01)));
  EXPECT_FALSE(layer.IsSettled(At(5.01, 3.01)));
}

TEST_F(ObstacleLayerTest, ClearsOnlyWhatWasNotSeenAgain) {
  ObstacleLayer layer(&costmap_, ObstacleLayerOptions());
  layer.Update(Scan(0., {{4., 3.}, {4., 4.}}));
  layer.Update(Scan(1., {{4., 4.}}));
  layer.Clear({4., 3.5}, 3., 0.5);
  EXPECT_FALSE(layer.IsMarked(At(4., 3.)));
  EXPECT_TRUE(layer.IsMarked(At(4., 4.)));
}

TEST_F(ObstacleLayerTest, KnowsTheAgeOfMarks) {
  ObstacleLayer layer(&costmap_, ObstacleLayerOptions());
  EXPECT_EQ(layer.MarkAge({4., 3.}, 0.), 0.);
  layer.Update(Scan(1., {{4.02, 3.02}}));
  layer.Update(Scan(2., {{4.02, 3.02}}));
  EXPECT_NEAR(layer.MarkAge({4.02, 3.02}, 2.5), 1.5, 1e-5);
  EXPECT_NEAR(layer.MarkAge({4.07, 3.07}, 2.5), 1.5, 1e-5);
  EXPECT_EQ(layer.MarkAge({4.2, 3.02}, 2.5), 0.);
}

TEST_F(ObstacleLayerTest, IsBounded) {
  ObstacleLayerOptions options;
  options.max_marks = 5;
  ObstacleLayer layer(&costmap_, options);
  std::vector<Eigen::Vector2d> echoes;
  for (int i = 0; i != 20; ++i)
    echoes.emplace_back(3. + 0.1 * i, 4. + 0.05 * i);
  layer.Update(Scan(0., echoes));
  EXPECT_EQ(layer.marks().size(), 5u);
  EXPECT_TRUE(layer.IsMarked(At(4.9, 4.95)));
  EXPECT_FALSE(layer.IsMarked(At(3., 4.)));
}

TEST_F(ObstacleLayerTest, IgnoresWhatIsNotANumber) {
  ObstacleLayer layer(&costmap_, ObstacleLayerOptions());
  const double nan = std::nan("");
  ScanInMap scan = Scan(0., {{nan, 3.}, {3., INFINITY}, {5., 3.}});
  scan.free_ends.push_back({nan, nan});
  layer.Update(scan);
  EXPECT_EQ(layer.marks().size(), 1u);
  scan.laser.x() = nan;
  layer.Update(scan);
  EXPECT_EQ(layer.marks().size(), 1u);
}

TEST_F(ObstacleLayerTest, InflatesMarksLikeTheMap) {
  // The weights around a mark are those of a map with a wall there.
  ObstacleLayer layer(&costmap_, ObstacleLayerOptions());
  layer.Update(Scan(0., {{5., 3.}, {5.6, 3.3}}));
  layer.Update(Scan(1., {{5., 3.}, {5.6, 3.3}}));
  WeightGrid weights;
  layer.ApplyTo(&weights);
  io::OccupancyMap map = RoomMap(10., 6.);
  for (const Cell& cell : {At(5., 3.), At(5.6, 3.3)}) {
    map.at(cell.x, cell.y) = 1.f;
  }
  const Costmap expected = MakeCostmap(map);
  EXPECT_EQ(weights.weights, expected.weights().weights);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
