// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/pose_graph_context.h"

#include <memory>
#include <thread>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

struct Counter {
  int value = 0;
};
struct OtherCounter {
  int value = 0;
};

// Counts how many of it exist.
struct Tracked {
  Tracked() { ++alive; }
  ~Tracked() { --alive; }
  static int alive;
};
int Tracked::alive = 0;

TEST(PoseGraphContextTest, HasOnePartOfEachType) {
  PoseGraphContext context;
  context.Get<Counter>()->value = 3;
  EXPECT_EQ(context.Get<Counter>()->value, 3);
  EXPECT_EQ(context.Get<OtherCounter>()->value, 0);
  EXPECT_EQ(PoseGraphContext().Get<Counter>()->value, 0);
}

TEST(PoseGraphContextTest, FreesItsPartsWithTheLastOwner) {
  auto context = std::make_shared<PoseGraphContext>();
  context->Get<Tracked>();
  auto owner = context;
  EXPECT_EQ(Tracked::alive, 1);
  context.reset();
  EXPECT_EQ(Tracked::alive, 1);
  owner.reset();
  EXPECT_EQ(Tracked::alive, 0);
}

TEST(PoseGraphContextTest, TheInnermostScopeIsCurrent) {
  EXPECT_EQ(PoseGraphContext::Current(), nullptr);
  EXPECT_NE(PoseGraphContext::CurrentOrNew(), nullptr);
  const auto outer = std::make_shared<PoseGraphContext>();
  const auto inner = std::make_shared<PoseGraphContext>();
  {
    const ScopedPoseGraphContext outer_scope(outer);
    EXPECT_EQ(PoseGraphContext::Current(), outer);
    EXPECT_EQ(PoseGraphContext::CurrentOrNew(), outer);
    {
      const ScopedPoseGraphContext inner_scope(inner);
      EXPECT_EQ(PoseGraphContext::Current(), inner);
      const ScopedPoseGraphContext hidden(nullptr);
      EXPECT_EQ(PoseGraphContext::Current(), nullptr);
    }
    EXPECT_EQ(PoseGraphContext::Current(), outer);
  }
  EXPECT_EQ(PoseGraphContext::Current(), nullptr);
}

TEST(PoseGraphContextTest, AScopeHoldsForItsThreadOnly) {
  const auto context = std::make_shared<PoseGraphContext>();
  const ScopedPoseGraphContext scope(context);
  std::thread([] { EXPECT_EQ(PoseGraphContext::Current(), nullptr); }).join();
}

TEST(PoseGraphContextTest, ThreadsGetTheSamePart) {
  PoseGraphContext context;
  std::vector<Counter*> parts(8);
  std::vector<std::thread> threads;
  for (Counter*& part : parts) {
    threads.emplace_back([&context, &part] { part = context.Get<Counter>(); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const Counter* const part : parts) EXPECT_EQ(part, parts.front());
}

}  // namespace
}  // namespace cartographer_ext
