// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/replay_ids.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

TEST(ReplayIdsTest, TranslatesBothWays) {
  // Trajectory 1 has lost its first node and a submap in between.
  ReplayPlan plan;
  plan.steps.resize(3);
  plan.steps[0].node_id = {0, 0};
  plan.steps[1].node_id = {1, 4};
  plan.steps[2].node_id = {1, 6};
  plan.submaps.resize(4);
  plan.submaps[0].trajectory_id = 0;
  plan.submaps[0].stored_index = 0;
  plan.submaps[1].trajectory_id = 1;
  plan.submaps[1].stored_index = 3;
  plan.submaps[2].trajectory_id = 1;  // a placeholder
  plan.submaps[3].trajectory_id = 1;
  plan.submaps[3].stored_index = 5;
  const ReplayIds ids(plan);
  EXPECT_EQ(ids.NodeOfStep(0), (GraphId{0, 0}));
  EXPECT_EQ(ids.NodeOfStep(2), (GraphId{1, 1}));
  EXPECT_EQ(ids.StoredNode({1, 1}), (GraphId{1, 6}));
  EXPECT_EQ(ids.SubmapAt(0), (GraphId{0, 0}));
  EXPECT_EQ(ids.SubmapAt(3), (GraphId{1, 2}));
  EXPECT_EQ(ids.StoredSubmap({1, 0}), (GraphId{1, 3}));
  EXPECT_EQ(ids.StoredSubmap({1, 1}).index, -1);
  EXPECT_EQ(ids.StoredSubmap({1, 2}), (GraphId{1, 5}));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
