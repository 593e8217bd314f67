// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/trajectory_connectivity_state.h"

#include <vector>

#include "cartographer/mapping/internal/connected_components.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

using Groups = std::vector<std::vector<int>>;

common::Time At(const int64 ticks) { return common::FromUniversal(ticks); }

TEST(ConnectedComponentsTest, JoinsComponents) {
  ConnectedComponents components;
  for (int i = 0; i < 10; ++i) components.Add(i);
  for (int i = 0; i <= 4; ++i) components.Connect(0, i);
  for (int i = 5; i < 10; ++i) components.Connect(9, i);
  EXPECT_EQ(components.Components(),
            (Groups{{0, 1, 2, 3, 4}, {5, 6, 7, 8, 9}}));
  EXPECT_TRUE(components.TransitivelyConnected(1, 4));
  EXPECT_FALSE(components.TransitivelyConnected(4, 5));
  components.Connect(7, 3);
  EXPECT_TRUE(components.TransitivelyConnected(4, 5));
  EXPECT_EQ(components.GetComponent(6).size(), 10);
}

TEST(ConnectedComponentsTest, UnknownTrajectories) {
  ConnectedComponents components;
  EXPECT_TRUE(components.TransitivelyConnected(3, 3));
  EXPECT_FALSE(components.TransitivelyConnected(3, 4));
  EXPECT_EQ(components.GetComponent(3), (std::vector<int>{3}));
  components.Connect(3, 4);
  EXPECT_TRUE(components.TransitivelyConnected(4, 3));
  EXPECT_FALSE(components.TransitivelyConnected(4, 5));
}

TEST(ConnectedComponentsTest, CountsDirectConnections) {
  ConnectedComponents components;
  components.Connect(1, 0);
  components.Connect(0, 1);
  components.Connect(1, 2);
  EXPECT_EQ(components.ConnectionCount(0, 1), 2);
  EXPECT_EQ(components.ConnectionCount(2, 1), 1);
  EXPECT_EQ(components.ConnectionCount(0, 2), 0);
}

TEST(TrajectoryConnectivityStateTest, NeverConnected) {
  TrajectoryConnectivityState state;
  state.Add(0);
  state.Add(1);
  EXPECT_FALSE(state.TransitivelyConnected(0, 1));
  EXPECT_EQ(state.LastConnectionTime(0, 1), At(0));
  EXPECT_EQ(state.Components(), (Groups{{0}, {1}}));
}

TEST(TrajectoryConnectivityStateTest, JoiningTellsEveryPairAcross) {
  TrajectoryConnectivityState state;
  for (int i = 0; i < 4; ++i) state.Add(i);
  state.Connect(0, 1, At(10));
  state.Connect(2, 3, At(20));
  EXPECT_EQ(state.LastConnectionTime(0, 2), At(0));
  state.Connect(1, 2, At(30));
  for (const int a : {0, 1}) {
    for (const int b : {2, 3}) {
      EXPECT_TRUE(state.TransitivelyConnected(a, b));
      EXPECT_EQ(state.LastConnectionTime(b, a), At(30));
    }
  }
  EXPECT_EQ(state.LastConnectionTime(0, 1), At(10));
}

TEST(TrajectoryConnectivityStateTest, TimesDoNotGoBack) {
  TrajectoryConnectivityState state;
  state.Connect(0, 1, At(10));
  state.Connect(0, 1, At(30));
  state.Connect(1, 0, At(20));
  EXPECT_EQ(state.LastConnectionTime(0, 1), At(30));
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
