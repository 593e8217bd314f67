// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/internal/read_options.h"

#include <memory>
#include <string>

#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/proto/grid_2d_options.pb.h"
#include "cartographer/mapping/proto/pose_graph_options.pb.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

using mapping::proto::GridOptions2D;
using mapping::proto::PoseGraphOptions;
using mapping::proto::TrajectoryBuilderOptions;

class NoFiles : public FileResolver {
 public:
  std::string GetFullPathOrDie(const std::string&) override { return ""; }
  std::string GetFileContentOrDie(const std::string&) override { return ""; }
};

TEST(ReadOptionsTest, ReadsPlainFieldsByName) {
  LuaParameterDictionary table(
      "return { optimize_every_n_nodes = -3, matcher_translation_weight = 0.1, "
      "matcher_rotation_weight = 2, global_sampling_ratio = 0.003, "
      "max_num_final_iterations = 7, log_residual_histograms = true, "
      "global_constraint_search_after_n_seconds = 10.5 }",
      std::make_unique<NoFiles>());
  const auto options = ReadOptions<PoseGraphOptions>(&table);
  EXPECT_EQ(options.optimize_every_n_nodes(), -3);
  EXPECT_EQ(options.matcher_translation_weight(), 0.1);
  EXPECT_EQ(options.matcher_rotation_weight(), 2.);
  EXPECT_EQ(options.max_num_final_iterations(), 7);
  EXPECT_TRUE(options.log_residual_histograms());
  EXPECT_EQ(options.global_constraint_search_after_n_seconds(), 10.5);
  EXPECT_FALSE(options.has_constraint_builder_options());
}

TEST(ReadOptionsTest, DeprecatedFieldsAreNotRead) {
  LuaParameterDictionary table(
      "return { collate_fixed_frame = true, collate_landmarks = false }",
      std::make_unique<NoFiles>());
  EXPECT_TRUE(
      ReadOptions<TrajectoryBuilderOptions>(&table).collate_fixed_frame());
}

TEST(ReadOptionsTest, EnumerationsByName) {
  LuaParameterDictionary table(
      "return { grid_type = 'TSDF', resolution = 0.1 }",
      std::make_unique<NoFiles>());
  const auto options = ReadOptions<GridOptions2D>(&table);
  EXPECT_EQ(options.grid_type(), GridOptions2D::TSDF);
  // Single precision, as the field is.
  EXPECT_EQ(options.resolution(), 0.1f);
}

TEST(ReadOptionsTest, OptionalKeysKeepTheirDefaults) {
  for (const bool is_there : {false, true}) {
    LuaParameterDictionary table(std::string("return { grid_type = 'TSDF'") +
                                     (is_there ? ", resolution = 0.5 }" : "}"),
                                 std::make_unique<NoFiles>());
    GridOptions2D options;
    options.set_resolution(0.25f);
    ReadFields(&table, &options, {"resolution"});
    EXPECT_EQ(options.resolution(), is_there ? 0.5f : 0.25f);
  }
}

TEST(ReadOptionsTest, OptionalTables) {
  using Trimmer = PoseGraphOptions::OverlappingSubmapsTrimmerOptions2D;
  PoseGraphOptions options;
  const auto trimmer = [&options]() {
    return options.mutable_overlapping_submaps_trimmer_2d();
  };
  LuaParameterDictionary empty("return {}", std::make_unique<NoFiles>());
  ReadOptionalTable<Trimmer>(&empty, "trimmer", trimmer);
  EXPECT_FALSE(options.has_overlapping_submaps_trimmer_2d());
  LuaParameterDictionary full(
      "return { trimmer = { fresh_submaps_count = 1, min_covered_area = 2, "
      "min_added_submaps_count = 5 } }",
      std::make_unique<NoFiles>());
  ReadOptionalTable<Trimmer>(&full, "trimmer", trimmer);
  EXPECT_EQ(options.overlapping_submaps_trimmer_2d().min_added_submaps_count(),
            5);
}

TEST(ReadOptionsDeathTest, MissingKeysAndUnknownNames) {
  const auto read = [](const std::string& code) {
    LuaParameterDictionary table(code, std::make_unique<NoFiles>());
    ReadOptions<GridOptions2D>(&table);
  };
  EXPECT_DEATH(read("return { grid_type = 'TSDF' }"),
               "'resolution' is missing");
  EXPECT_DEATH(read("return { grid_type = 'HEX', resolution = 1 }"),
               "grid_type: there is no 'HEX', only .*PROBABILITY_GRID");
}

}  // namespace
}  // namespace common
}  // namespace cartographer
