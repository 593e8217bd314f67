// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/map_by_time.h"

#include <vector>

#include "gtest/gtest.h"

namespace cartographer {
namespace sensor {
namespace {

struct Reading {
  common::Time time;
  int value;
};

struct Node {
  common::Time time;
};

common::Time At(const int64 ticks) { return common::FromUniversal(ticks); }

std::vector<int> Values(const MapByTime<Reading>& map, const int trajectory) {
  std::vector<int> values;
  if (!map.HasTrajectory(trajectory)) return values;
  for (const Reading& reading : map.trajectory(trajectory)) {
    values.push_back(reading.value);
  }
  return values;
}

// Readings at 0, 10, .. 90 whose values are their times.
MapByTime<Reading> Tens() {
  MapByTime<Reading> map;
  for (int i = 0; i != 10; ++i) map.Append(0, Reading{At(10 * i), 10 * i});
  return map;
}

mapping::MapById<mapping::NodeId, Node> Nodes(const std::vector<int>& times) {
  mapping::MapById<mapping::NodeId, Node> nodes;
  for (const int time : times) nodes.Append(0, Node{At(time)});
  return nodes;
}

TEST(MapByTimeTest, AppendAndLookUp) {
  MapByTime<Reading> map = Tens();
  map.Append(42, Reading{At(5), 1});
  EXPECT_TRUE(map.HasTrajectory(42));
  EXPECT_FALSE(map.HasTrajectory(1));
  EXPECT_EQ(map.lower_bound(0, At(20))->value, 20);
  EXPECT_EQ(map.lower_bound(0, At(21))->value, 30);
  EXPECT_TRUE(map.lower_bound(0, At(91)) == map.EndOfTrajectory(0));
  auto last = map.EndOfTrajectory(0);
  --last;
  EXPECT_EQ((*last).value, 90);
  std::vector<int> ids;
  for (const int id : map.trajectory_ids()) ids.push_back(id);
  EXPECT_EQ(ids, (std::vector<int>{0, 42}));
}

TEST(MapByTimeTest, TrimInTheMiddleKeepsWhatInterpolationNeeds) {
  MapByTime<Reading> map = Tens();
  map.Trim(Nodes({5, 35, 65}), mapping::NodeId{0, 1});
  // 10 is the first after the node at 5, 60 the last before the one at 65.
  EXPECT_EQ(Values(map, 0), (std::vector<int>{0, 10, 60, 70, 80, 90}));
}

TEST(MapByTimeTest, TrimAtExactTimes) {
  MapByTime<Reading> map = Tens();
  map.Trim(Nodes({20, 35, 50}), mapping::NodeId{0, 1});
  EXPECT_EQ(Values(map, 0), (std::vector<int>{0, 10, 20, 50, 60, 70, 80, 90}));
}

TEST(MapByTimeTest, TrimAtTheEnds) {
  MapByTime<Reading> map = Tens();
  map.Trim(Nodes({35, 65}), mapping::NodeId{0, 0});
  EXPECT_EQ(Values(map, 0), (std::vector<int>{60, 70, 80, 90}));
  map = Tens();
  map.Trim(Nodes({35, 65}), mapping::NodeId{0, 1});
  EXPECT_EQ(Values(map, 0), (std::vector<int>{0, 10, 20, 30, 40}));
}

TEST(MapByTimeTest, TrimTheOnlyNode) {
  MapByTime<Reading> map = Tens();
  map.Trim(Nodes({35}), mapping::NodeId{0, 0});
  EXPECT_FALSE(map.HasTrajectory(0));
}

TEST(MapByTimeTest, TrimWithFewReadings) {
  MapByTime<Reading> map;
  map.Append(0, Reading{At(30), 30});
  map.Trim(Nodes({5, 35, 65}), mapping::NodeId{0, 1});
  EXPECT_EQ(Values(map, 0), (std::vector<int>{30}));
  map.Append(0, Reading{At(40), 40});
  map.Trim(Nodes({5, 35, 65}), mapping::NodeId{0, 1});
  EXPECT_EQ(Values(map, 0), (std::vector<int>{30, 40}));
  // Outside the gap nothing happens, nor for other trajectories.
  map.Trim(Nodes({50, 55, 60}), mapping::NodeId{0, 1});
  EXPECT_EQ(Values(map, 0), (std::vector<int>{30, 40}));
  mapping::MapById<mapping::NodeId, Node> nodes;
  nodes.Append(3, Node{At(0)});
  map.Trim(nodes, mapping::NodeId{3, 0});
  EXPECT_EQ(Values(map, 0), (std::vector<int>{30, 40}));
}

TEST(MapByTimeDeathTest, TimeMustGrow) {
  MapByTime<Reading> map = Tens();
  EXPECT_DEATH(map.Append(0, Reading{At(90), 0}), "out of order");
  EXPECT_DEATH(map.Append(-1, Reading{At(100), 0}), "");
}

}  // namespace
}  // namespace sensor
}  // namespace cartographer
