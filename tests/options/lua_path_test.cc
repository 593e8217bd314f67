// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/lua_path.h"

#include <string>
#include <thread>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace options {
namespace {

TEST(LuaPathTest, InnermostScopeCounts) {
  EXPECT_EQ(LuaPathOf("matcher", "UNKNOWN"), "UNKNOWN.matcher");
  {
    const ScopedLuaPath outer("POSE_GRAPH");
    EXPECT_EQ(LuaPathOf("matcher", "UNKNOWN"), "POSE_GRAPH.matcher");
    {
      const ScopedLuaPath inner(LuaPathOf("constraint_builder", "UNKNOWN"));
      EXPECT_EQ(LuaPathOf("matcher", "UNKNOWN"),
                "POSE_GRAPH.constraint_builder.matcher");
    }
    EXPECT_EQ(LuaPathOf("matcher", "UNKNOWN"), "POSE_GRAPH.matcher");
  }
  EXPECT_EQ(LuaPathOf("matcher", "UNKNOWN"), "UNKNOWN.matcher");
}

TEST(LuaPathTest, ThreadsDoNotSeeEachOther) {
  const ScopedLuaPath scope("POSE_GRAPH");
  std::string seen;
  std::thread([&seen] { seen = LuaPathOf("matcher", "UNKNOWN"); }).join();
  EXPECT_EQ(seen, "UNKNOWN.matcher");
}

}  // namespace
}  // namespace options
}  // namespace cartographer_ext
