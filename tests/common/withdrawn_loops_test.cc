// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/withdrawn_loops.h"

#include <set>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

LoopId Id(const int submap, const int node) {
  LoopId id;
  id.submap_index = submap;
  id.node_trajectory = 1;
  id.node_index = node;
  return id;
}

LoopDescription Loop(const int submap, const int node) {
  LoopDescription loop;
  loop.is_loop = true;
  loop.id = Id(submap, node);
  return loop;
}

LoopDescription Mark(const int submap, const int node) {
  LoopDescription loop = Loop(submap, node);
  loop.has_weight = false;
  return loop;
}

LoopDescription Insertion(const int submap, const int node) {
  LoopDescription loop = Loop(submap, node);
  loop.is_loop = false;
  return loop;
}

std::vector<size_t> Find(const std::vector<LoopDescription>& constraints,
                         const std::set<LoopId>& withdrawn = {}) {
  return FindWithdrawnLoops(
      constraints, [](const LoopDescription& loop) { return loop; }, withdrawn);
}

TEST(WithdrawnLoopsTest, WithoutMarksAllLoopsCount) {
  EXPECT_THAT(Find({}), IsEmpty());
  EXPECT_THAT(Find({Loop(0, 1), Insertion(0, 1), Loop(0, 2)}), IsEmpty());
}

TEST(WithdrawnLoopsTest, AMarkWithdrawsTheLoopsOfItsPairBeforeIt) {
  EXPECT_THAT(Find({Loop(0, 1), Loop(0, 2), Insertion(0, 1), Loop(0, 1),
                    Loop(1, 1), Mark(0, 1), Loop(0, 3)}),
              ElementsAre(0, 3, 5));
}

TEST(WithdrawnLoopsTest, LaterLoopsOfThePairCount) {
  EXPECT_THAT(Find({Loop(0, 1), Mark(0, 1), Loop(0, 1)}), ElementsAre(0, 1));
  EXPECT_THAT(Find({Mark(0, 1)}), ElementsAre(0));
}

TEST(WithdrawnLoopsTest, IdsMayBeWithdrawnWithoutAMark) {
  EXPECT_THAT(
      Find({Loop(0, 1), Insertion(0, 1), Loop(0, 2), Mark(3, 3)}, {Id(0, 1)}),
      ElementsAre(0, 3));
}

TEST(WithdrawnLoopsTest, FollowsTheDeletionOfSubmaps) {
  WithdrawnLoops loops;
  loops.Add(Id(0, 1));
  loops.Add(Id(0, 1));
  loops.Add(Id(1, 2));
  loops.Add(Id(1, 3));
  loops.EraseSubmap(0, 1);
  EXPECT_EQ(loops.All(), std::set<LoopId>{Id(0, 1)});
  loops.EraseSubmap(1, 0);
  EXPECT_EQ(loops.All().size(), 1u);
}

TEST(WithdrawnLoopsTest, ErasesLoopsThatAreAcceptedAgain) {
  WithdrawnLoops loops;
  for (const LoopId& id : {Id(0, 1), Id(0, 2), Id(0, 1)}) loops.Add(id);
  EXPECT_TRUE(loops.Erase(Id(0, 1)));
  EXPECT_EQ(loops.All(), std::set<LoopId>{Id(0, 2)});
  EXPECT_FALSE(loops.Erase(Id(0, 1)));
}

TEST(WithdrawnLoopsTest, IsBounded) {
  WithdrawnLoops loops;
  for (size_t i = 0; i <= WithdrawnLoops::kCapacity; ++i) {
    loops.Add(Id(0, static_cast<int>(i)));
  }
  EXPECT_EQ(loops.All().size(), WithdrawnLoops::kCapacity);
  EXPECT_EQ(loops.All().count(Id(0, 0)), 0u);
}

}  // namespace
}  // namespace cartographer_ext
