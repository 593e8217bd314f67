// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Damaged Lua files: reading them must return.
#include <algorithm>
#include <string>

#include "cartographer_ext/configuration/lua_value.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

// No libraries that read files: damaged code is not to find any.
class LuaFuzzTest : public testing::Test {
 protected:
  LuaFuzzTest() { RestrictLua(true); }
  ~LuaFuzzTest() override { RestrictLua(false); }
};

TEST_F(LuaFuzzTest, DamagedCodeReturns) {
  const std::string program = R"(
local function assign(path, value)
  local names = {}
  for name in path:gmatch("[^.]+") do names[#names + 1] = name end
  local place = _G
  for i = 1, #names - 1 do place = place[names[i]] end
  place[names[#names]] = value
end
A = { b = { 0.55, 90, true }, c = "auto", d = { e = 1e-3 } }
assign("A.d.e", 7 // 2)
return { a = A, n = string.rep("x", 10), m = math.huge, t = table.concat({ 1, 2 }, ",") }
)";
  ASSERT_TRUE(EvaluateLua(program, "t", {}).ok());
  const std::string preset =
      test::ReadBytes("configuration_files/loop_closure_default.lua");
  ASSERT_FALSE(preset.empty());
  for (const std::string& sample : {program, preset}) {
    test::ForEachMutation(sample, [](const std::string& damaged) {
      EvaluateLua(damaged, "t", {"configuration_files"}).status().IgnoreError();
    });
  }
}

// Each takes some child processes, so they are few.
TEST_F(LuaFuzzTest, DamagedConfigurationsReturn) {
  const std::string sample = R"(
include "common_2d.lua"
POSE_GRAPH.constraint_builder.min_score = 0.55
POSE_GRAPH.optimize_every_n_nodes = 90
TRAJECTORY_BUILDER_2D.max_range = 30.
TRAJECTORY_BUILDER_2D.submaps.num_range_data = 90
TRAJECTORY_BUILDER_2D.use_imu_data = false
return { map_builder = MAP_BUILDER, trajectory_builder = TRAJECTORY_BUILDER,
         sensors = { odometry_source = "auto", min_range = 0.1 } }
)";
  ASSERT_TRUE(
      ParseSlamConfiguration({"configuration_files"}, "t", sample).ok());
  const int count = std::max(20, test::FuzzIterations() / 100);
  for (int i = 0; i < count; ++i) {
    test::Mutator mutator(test::FuzzSeed() * 7919u + i);
    ::alarm(60);
    ParseSlamConfiguration({"configuration_files"}, "t", mutator.Mutate(sample))
        .status()
        .IgnoreError();
  }
  ::alarm(0);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
