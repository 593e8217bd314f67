// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/id.h"

#include <iterator>
#include <sstream>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

struct Stamped {
  common::Time time;
};

common::Time At(const int64 ticks) { return common::FromUniversal(ticks); }

std::vector<NodeId> Ids(const MapById<NodeId, char>& map) {
  std::vector<NodeId> ids;
  for (const auto& entry : map) ids.push_back(entry.id);
  return ids;
}

TEST(IdTest, OrderAndText) {
  EXPECT_TRUE(NodeId(0, 5) < NodeId(1, 0));
  EXPECT_TRUE(NodeId(1, 0) < NodeId(1, 1));
  EXPECT_FALSE(NodeId(1, 1) < NodeId(1, 1));
  EXPECT_EQ(SubmapId(2, 3), SubmapId(2, 3));
  EXPECT_NE(SubmapId(2, 3), SubmapId(3, 2));
  std::ostringstream text;
  text << NodeId(4, 7) << SubmapId(0, 1);
  EXPECT_EQ(text.str(), "(4, 7)(0, 1)");
  proto::NodeId proto;
  NodeId(4, 7).ToProto(&proto);
  EXPECT_EQ(proto.trajectory_id(), 4);
  EXPECT_EQ(proto.node_index(), 7);
}

TEST(MapByIdTest, EmptyMap) {
  MapById<NodeId, char> map;
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.size(), 0);
  EXPECT_TRUE(map.begin() == map.end());
  EXPECT_TRUE(map.BeginOfTrajectory(3) == map.EndOfTrajectory(3));
  EXPECT_EQ(map.SizeOfTrajectoryOrZero(3), 0);
  EXPECT_FALSE(map.Contains(NodeId{0, 0}));
  EXPECT_TRUE(map.find(NodeId{0, 0}) == map.end());
}

TEST(MapByIdTest, AppendNumbersEveryTrajectory) {
  MapById<NodeId, char> map;
  EXPECT_EQ(map.Append(42, 'a'), NodeId(42, 0));
  EXPECT_EQ(map.Append(7, 'b'), NodeId(7, 0));
  EXPECT_EQ(map.Append(42, 'c'), NodeId(42, 1));
  EXPECT_EQ(map.size(), 3);
  EXPECT_EQ(map.SizeOfTrajectoryOrZero(42), 2);
  EXPECT_EQ(map.at(NodeId(42, 1)), 'c');
  map.at(NodeId(42, 1)) = 'd';
  EXPECT_EQ((*map.find(NodeId(42, 1))).data, 'd');
  EXPECT_EQ(Ids(map),
            (std::vector<NodeId>{NodeId(7, 0), NodeId(42, 0), NodeId(42, 1)}));
}

TEST(MapByIdTest, IterationOverPartsAndBackwards) {
  MapById<NodeId, char> map;
  map.Append(0, 'a');
  map.Append(0, 'b');
  map.Append(3, 'c');
  std::string text;
  for (const auto& entry : map.trajectory(0)) text += entry.data;
  EXPECT_EQ(text, "ab");
  text.clear();
  for (const auto& entry : map.trajectory(2)) text += entry.data;
  EXPECT_EQ(text, "");
  std::vector<int> trajectories;
  for (const int id : map.trajectory_ids()) trajectories.push_back(id);
  EXPECT_EQ(trajectories, (std::vector<int>{0, 3}));
  EXPECT_EQ(std::prev(map.EndOfTrajectory(0))->data, 'b');
  EXPECT_EQ(std::prev(map.end())->id, NodeId(3, 0));
  EXPECT_TRUE(map.EndOfTrajectory(0) == map.BeginOfTrajectory(3));
}

TEST(MapByIdTest, InsertAndTrim) {
  MapById<SubmapId, char> map;
  map.Insert(SubmapId(1, 5), 'a');
  map.Insert(SubmapId(1, 2), 'b');
  EXPECT_EQ(map.begin()->id, SubmapId(1, 2));
  map.Trim(SubmapId(1, 2));
  EXPECT_FALSE(map.Contains(SubmapId(1, 2)));
  EXPECT_EQ(map.SizeOfTrajectoryOrZero(1), 1);
  map.Trim(SubmapId(1, 5));
  EXPECT_TRUE(map.empty());
  EXPECT_TRUE(map.trajectory_ids().begin() == map.trajectory_ids().end());
}

TEST(MapByIdTest, TrimInTheMiddleLeavesTheNumberingAlone) {
  MapById<NodeId, char> map;
  map.Append(0, 'a');
  map.Append(0, 'b');
  map.Trim(NodeId(0, 0));
  EXPECT_EQ(map.Append(0, 'c'), NodeId(0, 2));
}

TEST(MapByIdDeathTest, AppendNeedsASafeNumber) {
  MapById<NodeId, char> inserted;
  inserted.Insert(NodeId(0, 3), 'a');
  EXPECT_DEATH(inserted.Append(0, 'b'), "numbering");
  MapById<NodeId, char> trimmed;
  trimmed.Append(0, 'a');
  trimmed.Append(0, 'b');
  trimmed.Trim(NodeId(0, 1));
  EXPECT_DEATH(trimmed.Append(0, 'c'), "numbering");
  EXPECT_DEATH(trimmed.Insert(NodeId(0, 0), 'c'), "exists");
  EXPECT_DEATH(trimmed.Trim(NodeId(0, 9)), "does not exist");
}

TEST(MapByIdTest, LowerBound) {
  MapById<NodeId, Stamped> map;
  map.Append(0, Stamped{At(1)});
  map.Append(1, Stamped{At(10)});
  map.Append(1, Stamped{At(20)});
  map.Append(1, Stamped{At(20)});
  map.Append(1, Stamped{At(30)});
  EXPECT_EQ(map.lower_bound(1, At(5))->id, NodeId(1, 0));
  EXPECT_EQ(map.lower_bound(1, At(10))->id, NodeId(1, 0));
  EXPECT_EQ(map.lower_bound(1, At(11))->id, NodeId(1, 1));
  EXPECT_EQ(map.lower_bound(1, At(20))->id, NodeId(1, 1));
  EXPECT_EQ(map.lower_bound(1, At(30))->id, NodeId(1, 3));
  EXPECT_TRUE(map.lower_bound(1, At(31)) == map.EndOfTrajectory(1));
  EXPECT_TRUE(map.lower_bound(5, At(0)) == map.EndOfTrajectory(5));
}

// Against a plain search, with every pattern of gaps among six entries.
TEST(MapByIdTest, LowerBoundWithGaps) {
  for (int pattern = 1; pattern < 64; ++pattern) {
    MapById<NodeId, Stamped> map;
    for (int i = 0; i < 6; ++i) {
      if (pattern & (1 << i)) map.Insert(NodeId(2, i), Stamped{At(10 * i)});
    }
    for (int time = -5; time <= 55; time += 5) {
      auto expected = map.BeginOfTrajectory(2);
      while (expected != map.EndOfTrajectory(2) &&
             (*expected).data.time < At(time)) {
        ++expected;
      }
      EXPECT_TRUE(map.lower_bound(2, At(time)) == expected)
          << "pattern " << pattern << " time " << time;
    }
  }
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
