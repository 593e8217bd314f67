// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/reorder.h"

#include <algorithm>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

std::vector<EventKey> Keys(const std::vector<TimeNs>& times) {
  std::vector<EventKey> keys;
  for (const TimeNs time : times) {
    keys.push_back(EventKey{time, 0, static_cast<int64_t>(keys.size())});
  }
  return keys;
}

// Ordinals in the order of delivery.
std::vector<int64_t> Deliver(const std::vector<EventKey>& keys,
                             const ReorderPlan& plan) {
  ReorderBuffer<int64_t> buffer(plan.window);
  std::vector<int64_t> delivered;
  for (const EventKey& key : keys) {
    if (std::binary_search(plan.dropped.begin(), plan.dropped.end(),
                           key.ordinal)) {
      continue;
    }
    buffer.Push(key, key.ordinal);
    while (buffer.Ready()) delivered.push_back(buffer.Pop());
  }
  while (!buffer.empty()) delivered.push_back(buffer.Pop());
  return delivered;
}

TEST(ReorderTest, SortedInputNeedsNoWindow) {
  const ReorderPlan plan = PlanReordering(Keys({1, 2, 2, 3}), 10);
  EXPECT_EQ(plan.window, 0u);
  EXPECT_TRUE(plan.dropped.empty());
}

TEST(ReorderTest, StableAndByRank) {
  std::vector<EventKey> keys = Keys({5, 5, 3, 5});
  keys[0].rank = 1;
  const ReorderPlan plan = PlanReordering(keys, 10);
  EXPECT_EQ(plan.window, 2u);
  EXPECT_EQ(Deliver(keys, plan), (std::vector<int64_t>{2, 1, 3, 0}));
}

TEST(ReorderTest, FindsTheSmallestWindow) {
  Random random(11);
  for (int round = 0; round < 200; ++round) {
    std::vector<TimeNs> times;
    const int n = random.UniformInt(1, 60);
    for (int i = 0; i < n; ++i) {
      times.push_back(i + random.UniformInt(0, 8));
    }
    const std::vector<EventKey> keys = Keys(times);
    std::vector<EventKey> sorted = keys;
    std::sort(sorted.begin(), sorted.end());
    std::vector<int64_t> expected;
    for (const EventKey& key : sorted) expected.push_back(key.ordinal);
    ReorderPlan plan = PlanReordering(keys, 1000);
    ASSERT_TRUE(plan.dropped.empty());
    ASSERT_EQ(Deliver(keys, plan), expected);
    if (plan.window > 0) {
      --plan.window;
      ASSERT_NE(Deliver(keys, plan), expected);
    }
  }
}

TEST(ReorderTest, DropsWhatComesTooLate) {
  const std::vector<EventKey> keys = Keys({10, 11, 12, 13, 1, 14});
  const ReorderPlan plan = PlanReordering(keys, 2);
  EXPECT_EQ(plan.dropped, std::vector<int64_t>{4});
  EXPECT_EQ(plan.window, 0u);
  EXPECT_EQ(Deliver(keys, plan), (std::vector<int64_t>{0, 1, 2, 3, 5}));
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
