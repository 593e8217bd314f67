// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/switched_constraints.h"

#include "gmock/gmock.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using ::testing::ElementsAre;

TEST(SwitchedConstraintsTest, MarksTheLoopsAndNothingElse) {
  MapGraph map;
  map.constraints.resize(4);
  map.constraints[0].submap_id = {0, 3};
  map.constraints[0].node_id = {0, 40};
  for (int i : {1, 2, 3}) map.constraints[i] = map.constraints[0];
  map.constraints[1].is_loop = true;
  map.constraints[2].is_loop = true;
  map.constraints[2].node_id = {1, 40};
  map.constraints[3].is_loop = true;
  map.constraints[3].switched_off = true;  // by an earlier list
  map.constraints[3].node_id = {0, 41};
  optimization::SwitchedLoop loop, missing;
  loop.submap_index = 3;
  loop.node_index = 40;
  missing.submap_index = 9;
  EXPECT_THAT(MarkSwitchedOff({missing, loop}, &map), ElementsAre(1));
  EXPECT_FALSE(map.constraints[0].switched_off);
  EXPECT_TRUE(map.constraints[1].switched_off);
  EXPECT_FALSE(map.constraints[2].switched_off);
  EXPECT_FALSE(map.constraints[3].switched_off);
  EXPECT_TRUE(MarkSwitchedOff({}, &map).empty());
  EXPECT_FALSE(map.constraints[1].switched_off);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
