// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/option_types.h"

#include "cartographer/mapping/proto/map_builder_options.pb.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"
#include "cartographer_ext/configuration/lua_value.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::MapBuilderOptions;
using cartographer::mapping::proto::TrajectoryBuilderOptions;

// Empty where nothing is wrong.
std::string ErrorIn(const std::string& lua,
                    const google::protobuf::Descriptor& message =
                        *MapBuilderOptions::descriptor()) {
  const auto table = EvaluateLua("return {" + lua + "}", "test.lua", {});
  EXPECT_TRUE(table.ok()) << table.status();
  return std::string(CheckOptionTypes(*table, message, "top").message());
}

TEST(OptionTypesTest, RightTypesPass) {
  EXPECT_EQ(ErrorIn("use_trajectory_builder_2d = true, "
                    "num_background_threads = 4., pose_graph = { "
                    "optimize_every_n_nodes = 90, matcher_rotation_weight = 1, "
                    "constraint_builder = { min_score = 0.55 } }"),
            "");
  EXPECT_EQ(ErrorIn("trajectory_builder_2d = { submaps = { grid_options_2d = "
                    "{ grid_type = 'PROBABILITY_GRID' } } }",
                    *TrajectoryBuilderOptions::descriptor()),
            "");
}

TEST(OptionTypesTest, WrongTypesAreNamed) {
  EXPECT_EQ(ErrorIn("use_trajectory_builder_2d = 1"),
            "top.use_trajectory_builder_2d is 1, must be true or false");
  EXPECT_EQ(ErrorIn("num_background_threads = 0.5"),
            "top.num_background_threads is 0.5, must be an integer of 32 bits");
  EXPECT_EQ(ErrorIn("num_background_threads = 1e10"),
            "top.num_background_threads is 1e+10, must be an integer of 32 "
            "bits");
  EXPECT_EQ(
      ErrorIn("pose_graph = { constraint_builder = { min_score = 'high' } }"),
      "top.pose_graph.constraint_builder.min_score is \"high\", must be a "
      "number");
  EXPECT_EQ(ErrorIn("pose_graph = { constraint_builder = { min_score = {} } }"),
            "top.pose_graph.constraint_builder.min_score is a table, must be a "
            "number");
  EXPECT_EQ(
      ErrorIn("pose_graph = { constraint_builder = 3 }"),
      "top.pose_graph.constraint_builder is 3, must be a table with names");
  EXPECT_EQ(ErrorIn("pose_graph = { 1, 2 }"),
            "top.pose_graph is a table, must be a table with names");
  EXPECT_EQ(
      ErrorIn("trajectory_builder_2d = { submaps = { grid_options_2d = { "
              "grid_type = true } } }",
              *TrajectoryBuilderOptions::descriptor()),
      "top.trajectory_builder_2d.submaps.grid_options_2d.grid_type is true, "
      "must be a string");
}

// Fields whose names have a number of dimensions behind "_options".
TEST(OptionTypesTest, FindsFieldsOfDimensions) {
  const std::string head = "pose_graph = { constraint_builder = { ";
  EXPECT_EQ(ErrorIn(head + "fast_correlative_scan_matcher = { "
                           "branch_and_bound_depth = 'x' } } }"),
            "top.pose_graph.constraint_builder.fast_correlative_scan_matcher."
            "branch_and_bound_depth is \"x\", must be an integer of 32 bits");
  // The one of 3D has a field that the one of 2D does not have.
  EXPECT_EQ(ErrorIn(head + "fast_correlative_scan_matcher_3d = { "
                           "full_resolution_depth = 'x' } } }"),
            "top.pose_graph.constraint_builder.fast_correlative_scan_matcher_"
            "3d.full_resolution_depth is \"x\", must be an integer of 32 bits");
  EXPECT_EQ(
      ErrorIn("trajectory_builder_2d = { submaps = { range_data_inserter = { "
              "probability_grid_range_data_inserter = { hit_probability = "
              "false } } } }",
              *TrajectoryBuilderOptions::descriptor()),
      "top.trajectory_builder_2d.submaps.range_data_inserter."
      "probability_grid_range_data_inserter.hit_probability is false, must be "
      "a number");
}

TEST(OptionTypesTest, LeavesToTheHostWhatIsTheHosts) {
  // Unknown keys, our own blocks, numbers as text.
  EXPECT_EQ(ErrorIn("no_such_key = {}"), "");
  EXPECT_EQ(ErrorIn("pose_graph = { optimization_problem = { "
                    "cartographer_ext = { loop_sigma = 'x' } } }"),
            "");
  EXPECT_EQ(ErrorIn("num_background_threads = '4'"), "");
  EXPECT_EQ(ErrorIn(""), "");
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
