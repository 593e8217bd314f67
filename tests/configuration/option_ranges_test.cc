// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/option_ranges.h"

#include "cartographer/mapping/proto/map_builder_options.pb.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"
#include "cartographer_ext/configuration/lua_value.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Result {
  std::string error;
  std::vector<std::string> warnings;
};

Result Check(const std::string& changes) {
  const auto table =
      EvaluateLua("include 'common_2d.lua'\n" + changes +
                      "\nreturn { map_builder = MAP_BUILDER, "
                      "trajectory_builder = TRAJECTORY_BUILDER }",
                  "test.lua", {"configuration_files"});
  EXPECT_TRUE(table.ok()) << table.status();
  using cartographer::mapping::proto::MapBuilderOptions;
  using cartographer::mapping::proto::TrajectoryBuilderOptions;
  Result result;
  absl::Status status = CheckOptionRanges((*table)["map_builder"],
                                          *MapBuilderOptions::descriptor(), "M",
                                          &result.warnings);
  status.Update(CheckOptionRanges((*table)["trajectory_builder"],
                                  *TrajectoryBuilderOptions::descriptor(), "T",
                                  &result.warnings));
  result.error = std::string(status.message());
  return result;
}

TEST(OptionRangesTest, StockValuesAreFine) {
  EXPECT_EQ(Check("").error, "");
  EXPECT_THAT(Check("").warnings, IsEmpty());
}

TEST(OptionRangesTest, ValuesCartographerCannotWorkWith) {
  const struct {
    const char* change;
    const char* key;
  } cases[] = {
      {"TRAJECTORY_BUILDER_2D.max_range = -1", "max_range is -1"},
      {"TRAJECTORY_BUILDER_2D.max_range = 0/0", "max_range is not a number"},
      {"TRAJECTORY_BUILDER_2D.min_range = 100", "min_range is 100"},
      {"TRAJECTORY_BUILDER_2D.voxel_filter_size = 0", "voxel_filter_size is 0"},
      {"TRAJECTORY_BUILDER_2D.voxel_filter_size = 1e-310", "too small"},
      {"TRAJECTORY_BUILDER_2D.adaptive_voxel_filter.max_length = 0",
       "adaptive_voxel_filter.max_length"},
      {"TRAJECTORY_BUILDER_2D.submaps.grid_options_2d.resolution = 0",
       "resolution is 0"},
      {"TRAJECTORY_BUILDER_2D.submaps.grid_options_2d.resolution = 1e-6",
       "resolution is 1e-06"},
      {"TRAJECTORY_BUILDER_2D.submaps.num_range_data = 0", "num_range_data"},
      {"TRAJECTORY_BUILDER_2D.ceres_scan_matcher.translation_weight = -5",
       "ceres_scan_matcher.translation_weight is -5"},
      {"TRAJECTORY_BUILDER_2D.submaps.range_data_inserter."
       "probability_grid_range_data_inserter.hit_probability = 1",
       "hit_probability is 1, must be above 0.5 and below 1"},
      {"POSE_GRAPH.constraint_builder.sampling_ratio = -1",
       "sampling_ratio is -1, must be at least 0 and at most 1"},
      {"POSE_GRAPH.constraint_builder.loop_closure_translation_weight = -3",
       "loop_closure_translation_weight"},
      {"POSE_GRAPH.matcher_translation_weight = -1",
       "matcher_translation_weight"},
      {"POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher."
       "branch_and_bound_depth = 40",
       "branch_and_bound_depth"},
      {"MAP_BUILDER.num_background_threads = 100000",
       "M.num_background_threads is 100000, must be at least 1 and at most "
       "4096: each is an operating system thread"},
      // As the host, reads numbers that are written as strings.
      {"MAP_BUILDER.num_background_threads = '0'",
       "num_background_threads is 0"},
  };
  for (const auto& one : cases) {
    EXPECT_THAT(Check(one.change).error, HasSubstr(one.key)) << one.change;
  }
}

TEST(OptionRangesTest, OddValuesThatWorkAreWarnedOf) {
  const struct {
    const char* change;
    const char* key;
  } cases[] = {
      {"POSE_GRAPH.constraint_builder.min_score = 7", "min_score is 7"},
      {"POSE_GRAPH.optimization_problem.huber_scale = 0", "huber_scale is 0"},
      {"POSE_GRAPH.constraint_builder.max_constraint_distance = 0",
       "max_constraint_distance"},
      {"TRAJECTORY_BUILDER_2D.num_accumulated_range_data = 0",
       "num_accumulated_range_data"},
      {"TRAJECTORY_BUILDER_2D.submaps.grid_options_2d.resolution = 2",
       "resolution is 2"},
  };
  for (const auto& one : cases) {
    const Result result = Check(one.change);
    EXPECT_EQ(result.error, "") << one.change;
    EXPECT_THAT(result.warnings, ElementsAre(HasSubstr(one.key)));
  }
}

TEST(OptionRangesTest, WhatIsNotUsedIsNotJudged) {
  for (const char* const change :
       {"TRAJECTORY_BUILDER_2D.real_time_correlative_scan_matcher."
        "linear_search_window = -1",
        "TRAJECTORY_BUILDER_2D.pose_extrapolator.imu_based.solver_options."
        "num_threads = 0",
        "POSE_GRAPH.constraint_builder.ceres_scan_matcher_3d."
        "translation_weight = -1",
        "TRAJECTORY_BUILDER_2D.max_range = math.huge",
        "POSE_GRAPH.optimize_every_n_nodes = 0",
        "TRAJECTORY_BUILDER_2D.motion_filter.max_time_seconds = -1"}) {
    EXPECT_EQ(Check(change).error, "") << change;
    EXPECT_THAT(Check(change).warnings, IsEmpty()) << change;
  }
  EXPECT_THAT(
      Check(
          "TRAJECTORY_BUILDER_2D.use_online_correlative_scan_matching = true\n"
          "TRAJECTORY_BUILDER_2D.real_time_correlative_scan_matcher."
          "linear_search_window = -1")
          .error,
      HasSubstr("linear_search_window"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
