// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/trajectory_states.h"

#include <vector>

#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

using State = TrajectoryStates::State;

TEST(TrajectoryStatesTest, UnknownTrajectoriesMayBegin) {
  const TrajectoryStates states;
  EXPECT_TRUE(states.AcceptsData(3));
  EXPECT_FALSE(states.Contains(3));
  EXPECT_FALSE(states.Is(3, State::ACTIVE));
}

TEST(TrajectoryStatesTest, AddingAgainChangesNothing) {
  TrajectoryStates states;
  states.Add(0);
  EXPECT_TRUE(states.Is(0, State::ACTIVE));
  states.Set(0, State::FROZEN);
  states.Add(0);
  EXPECT_TRUE(states.Is(0, State::FROZEN));
  EXPECT_TRUE(states.AcceptsData(0));
  EXPECT_EQ(states.all().size(), 1u);
}

TEST(TrajectoryStatesTest, FinishedOnesTakeNoData) {
  TrajectoryStates states;
  states.Set(0, State::FINISHED);
  states.Set(1, State::DELETED);
  EXPECT_FALSE(states.AcceptsData(0));
  EXPECT_FALSE(states.AcceptsData(1));
}

TEST(TrajectoryStatesTest, DeletionNeedsACompleteOrFrozenTrajectory) {
  TrajectoryStates states;
  states.Add(0);
  states.Set(1, State::FINISHED);
  states.Set(2, State::FROZEN);
  states.Set(3, State::DELETED);
  EXPECT_FALSE(states.ConfirmDeletion(0));
  EXPECT_TRUE(states.ConfirmDeletion(2));
  EXPECT_TRUE(states.ConfirmDeletion(1));
  EXPECT_FALSE(states.ConfirmDeletion(3));
  EXPECT_FALSE(states.ConfirmDeletion(4));
  EXPECT_EQ(states.ConfirmedDeletions(), (std::vector<int>{1, 2}));
  EXPECT_FALSE(states.AcceptsData(2));
  EXPECT_TRUE(states.Is(2, State::FROZEN));
  states.Set(2, State::DELETED);
  EXPECT_EQ(states.ConfirmedDeletions(), std::vector<int>{1});
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
