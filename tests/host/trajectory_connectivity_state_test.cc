// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/trajectory_connectivity_state.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

using Groups = std::vector<std::vector<int>>;

common::Time At(const int64 ticks) { return common::FromUniversal(ticks); }

TEST(TrajectoryConnectivityStateTest, KnownTrajectoriesAreGroupsOfOne) {
  TrajectoryConnectivityState state;
  EXPECT_TRUE(state.Components().empty());
  state.Add(7);
  state.Add(2);
  state.Add(7);
  EXPECT_EQ(state.Components(), (Groups{{2}, {7}}));
  EXPECT_FALSE(state.TransitivelyConnected(2, 7));
  EXPECT_EQ(state.LastConnectionTime(2, 7), At(0));
}

TEST(TrajectoryConnectivityStateTest, UnknownTrajectoriesKnowThemselvesOnly) {
  TrajectoryConnectivityState state;
  EXPECT_TRUE(state.TransitivelyConnected(3, 3));
  EXPECT_FALSE(state.TransitivelyConnected(3, 4));
  EXPECT_TRUE(state.Components().empty());
  state.Connect(4, 3, At(1));
  EXPECT_EQ(state.Components(), (Groups{{3, 4}}));
  EXPECT_FALSE(state.TransitivelyConnected(4, 5));
}

TEST(TrajectoryConnectivityStateTest, JoiningCountsForEveryPairAcross) {
  TrajectoryConnectivityState state;
  state.Connect(0, 1, At(10));
  state.Connect(2, 3, At(20));
  state.Add(4);
  EXPECT_EQ(state.LastConnectionTime(0, 2), At(0));
  state.Connect(1, 2, At(30));
  for (const int a : {0, 1}) {
    for (const int b : {2, 3}) {
      EXPECT_TRUE(state.TransitivelyConnected(a, b));
      EXPECT_EQ(state.LastConnectionTime(b, a), At(30));
    }
  }
  EXPECT_EQ(state.LastConnectionTime(0, 1), At(10));
  EXPECT_EQ(state.LastConnectionTime(0, 4), At(0));
  EXPECT_EQ(state.Components(), (Groups{{0, 1, 2, 3}, {4}}));
}

TEST(TrajectoryConnectivityStateTest, TimesDoNotGoBack) {
  TrajectoryConnectivityState state;
  state.Connect(0, 1, At(10));
  state.Connect(0, 1, At(30));
  state.Connect(1, 0, At(20));
  EXPECT_EQ(state.LastConnectionTime(0, 1), At(30));
}

// Against reachability by flooding, on random graphs.
TEST(TrajectoryConnectivityStateTest, AgreesWithReachability) {
  constexpr int kNumTrajectories = 9;
  std::mt19937 random(4);
  for (int round = 0; round < 50; ++round) {
    TrajectoryConnectivityState state;
    std::vector<std::set<int>> neighbours(kNumTrajectories);
    for (int id = 0; id < kNumTrajectories; ++id) state.Add(id);
    for (int edge = 0; edge < 6; ++edge) {
      const int a = random() % kNumTrajectories;
      const int b = random() % kNumTrajectories;
      state.Connect(a, b, At(edge));
      neighbours[a].insert(b);
      neighbours[b].insert(a);
    }
    size_t num_members = 0;
    for (const std::vector<int>& group : state.Components()) {
      EXPECT_TRUE(std::is_sorted(group.begin(), group.end()));
      num_members += group.size();
    }
    EXPECT_EQ(num_members, kNumTrajectories);
    for (int start = 0; start < kNumTrajectories; ++start) {
      std::set<int> reached = {start};
      for (std::vector<int> front = {start}; !front.empty();) {
        const int id = front.back();
        front.pop_back();
        for (const int next : neighbours[id]) {
          if (reached.insert(next).second) front.push_back(next);
        }
      }
      for (int id = 0; id < kNumTrajectories; ++id) {
        EXPECT_EQ(state.TransitivelyConnected(start, id),
                  reached.count(id) == 1);
      }
    }
  }
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
