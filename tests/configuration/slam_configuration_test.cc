// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/slam_configuration.h"

#include <cmath>

#include "cartographer_ext/configuration/lua_value.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::HasSubstr;

constexpr char kHead[] = "include \"common_2d.lua\"\n";

absl::StatusOr<SlamConfiguration> Parse(const std::string& changes,
                                        const std::string& more_keys = "") {
  return ParseSlamConfiguration(
      {"configuration_files"}, "test.lua",
      kHead + changes +
          "\nreturn { map_builder = MAP_BUILDER, trajectory_builder = "
          "TRAJECTORY_BUILDER, " +
          more_keys + " }");
}

void ExpectError(const absl::StatusOr<SlamConfiguration>& configuration,
                 const std::string& hint) {
  ASSERT_FALSE(configuration.ok()) << hint;
  EXPECT_EQ(configuration.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(configuration.status().message()),
              HasSubstr("test.lua"));
  EXPECT_THAT(std::string(configuration.status().message()), HasSubstr(hint));
}

TEST(SlamConfigurationTest, PresetsOfLoopClosureLoad) {
  for (const char* const name :
       {"default.lua", "corridor.lua", "warehouse.lua", "paper_2025.lua",
        "ablation_2025_a.lua", "ablation_2025_b.lua", "ablation_2025_c.lua"}) {
    const auto configuration =
        LoadSlamConfiguration({"configuration_files"}, name);
    EXPECT_TRUE(configuration.ok()) << configuration.status();
  }
}

TEST(SlamConfigurationTest, StockIsStock) {
  const auto configuration =
      LoadSlamConfiguration({"configuration_files"}, "stock.lua");
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  EXPECT_TRUE(configuration->map_builder_options.use_trajectory_builder_2d());
  const auto& builder = configuration->map_builder_options.pose_graph_options()
                            .constraint_builder_options();
  EXPECT_EQ(builder.min_score(), 0.55);
  EXPECT_EQ(
      configuration->trajectory_builder_options.trajectory_builder_2d_options()
          .submaps_options()
          .num_range_data(),
      90);
  EXPECT_TRUE(configuration->sensors.use_odometry);
  EXPECT_EQ(configuration->sensors.odometry_source, "auto");
  EXPECT_TRUE(std::isinf(configuration->sensors.max_range));
}

TEST(SlamConfigurationTest, ChangesArriveInTheOptions) {
  const auto configuration =
      Parse("POSE_GRAPH.constraint_builder.min_score = 0.7");
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  EXPECT_EQ(configuration->map_builder_options.pose_graph_options()
                .constraint_builder_options()
                .min_score(),
            0.7);
}

TEST(SlamConfigurationTest, SensorSettings) {
  const auto configuration =
      Parse("",
            "sensors = { use_odometry = false, use_recorded_imu = true, "
            "odometry_source = \"scan\", "
            "min_range = 0.2, max_range = 25., tracking_frame = \"base\" }");
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  EXPECT_FALSE(configuration->sensors.use_odometry);
  EXPECT_TRUE(configuration->sensors.use_recorded_imu);
  EXPECT_TRUE(UsesImu(*configuration));
  EXPECT_EQ(configuration->sensors.odometry_source, "scan");
  EXPECT_EQ(configuration->sensors.min_range, 0.2);
  EXPECT_EQ(configuration->sensors.max_range, 25.);
  EXPECT_EQ(configuration->sensors.tracking_frame, "base");
}

TEST(SlamConfigurationTest, LocalSlamMayAskForTheImuItself) {
  const auto without = Parse("");
  ASSERT_TRUE(without.ok()) << without.status();
  EXPECT_FALSE(UsesImu(*without));
  const auto with = Parse("TRAJECTORY_BUILDER_2D.use_imu_data = true");
  ASSERT_TRUE(with.ok()) << with.status();
  EXPECT_TRUE(UsesImu(*with));
}

TEST(SlamConfigurationTest, FilesOfARosNodeWork) {
  const auto configuration = Parse(
      "",
      "map_frame = \"map\", tracking_frame = \"imu\", published_frame = "
      "\"base\", odom_frame = \"odom\", provide_odom_frame = true, "
      "use_odometry = false, num_laser_scans = 1, "
      "lookup_transform_timeout_sec = 0.2, rangefinder_sampling_ratio = 1.");
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  EXPECT_FALSE(configuration->sensors.use_odometry);
  EXPECT_EQ(configuration->sensors.tracking_frame, "imu");
}

TEST(SlamConfigurationTest, WhatTheHostWouldDieOfBecomesAnError) {
  ExpectError(Parse("POSE_GRAPH.optimize_every_n_nodez = 3"),
              "optimize_every_n_nodez");
  ExpectError(Parse("POSE_GRAPH.optimize_every_n_nodes = nil"),
              "optimize_every_n_nodes");
  ExpectError(Parse("POSE_GRAPH.optimize_every_n_nodes = {}"),
              "optimize_every_n_nodes");
  ExpectError(Parse("MAP_BUILDER.num_background_threads = 0"), "");
  ExpectError(Parse("", "surprise = 3"), "surprise");
  ExpectError(Parse("MAP_BUILDER.use_trajectory_builder_2d = false\n"
                    "MAP_BUILDER.use_trajectory_builder_3d = true"),
              "use_trajectory_builder_2d");
  ExpectError(Parse("", "sensors = { odometry_source = \"both?\" }"),
              "sensors.odometry_source");
  ExpectError(Parse("", "sensors = { min_range = -1. }"), "sensors.min_range");
  ExpectError(Parse("", "sensors = { min_range = 2., max_range = 1. }"),
              "sensors.max_range");
  ExpectError(Parse("this is no Lua"), "");
}

TEST(SlamConfigurationTest, MisspeltStockKeysAreRecognised) {
  ExpectError(Parse("POSE_GRAPH.constraint_builder.min_scoore = 0.5"),
              "POSE_GRAPH.constraint_builder.min_scoore is not an option, did "
              "you mean 'min_score'?");
  ExpectError(Parse("TRAJECTORY_BUILDER_2D.max_rang = 3."),
              "TRAJECTORY_BUILDER_2D.max_rang is not an option, did you mean "
              "'max_range'?");
  // What the renamed key misses is explained by the new name.
  ExpectError(Parse("MAP_BUILDER.nun_background_threads = 4\n"
                    "MAP_BUILDER.num_background_threads = nil"),
              "did you mean 'num_background_threads'?");
  ExpectError(Parse("", "sensors = { use_recorded_imus = true }"),
              "sensors.use_recorded_imus is not an option, did you mean "
              "'use_recorded_imu'?");
  ExpectError(Parse("POSE_GRAPH.zzz = 3"), "zzz");
}

TEST(SlamConfigurationTest, UnknownKeysOfTheResultAndMisplacedBlocks) {
  ExpectError(Parse("", "sensor = {}"),
              "): sensor is not an option, did you mean 'sensors'?");
  ExpectError(Parse("POSE_GRAPH.cartographer_ext = {}"),
              "): POSE_GRAPH.cartographer_ext is not an option; blocks of that "
              "name belong to POSE_GRAPH.constraint_builder,");
}

TEST(SlamConfigurationTest, MessagesSpeakOfTheFileAndNotOfTheCode) {
  for (const char* const changes :
       {"POSE_GRAPH.constraint_builder.cartographer_ext = { fusion = { "
        "min_final_score = 'high' } }",
        "POSE_GRAPH.constraint_builder.cartographer_ext = { fusion = { "
        "min_final_score = 7 } }",
        "POSE_GRAPH.constraint_builder.cartographer_ext = { search = { "
        "max_searches_per_node = 1.5 } }",
        "POSE_GRAPH.constraint_builder.cartographer_ext = { fusion = { "
        "enabled = 1 } }",
        "POSE_GRAPH.constraint_builder.cartographer_ext = { fusion = 1 }",
        "POSE_GRAPH.constraint_builder.cartographer_ext = 1"}) {
    ExpectError(Parse(changes),
                "): POSE_GRAPH.constraint_builder.cartographer_ext");
  }
  ExpectError(Parse("", "sensors = { odometry_source = \"both?\" }"),
              "): sensors.odometry_source is \"both?\", must be one of");
  ExpectError(Parse("", "sensors = { min_range = 0 / 0 }"),
              "): sensors.min_range is ");
  ExpectError(Parse("", "sensors = { max_range = -1. }"),
              "): sensors.max_range is -1, must be above");
  ExpectError(Parse("POSE_GRAPH.constraint_builder.min_score = true"),
              "): POSE_GRAPH.constraint_builder.min_score is true, must be a "
              "number");
  ExpectError(Parse("MAP_BUILDER.use_trajectory_builder_2d = false"),
              "): MAP_BUILDER.use_trajectory_builder_2d must be true");
  ExpectError(Parse("MAP_BUILDER.use_trajectory_builder_3d = true"),
              "): MAP_BUILDER.use_trajectory_builder_3d must be false");
  const auto missing = Parse("TRAJECTORY_BUILDER_2D.max_range = nil");
  ExpectError(missing, "Key 'TRAJECTORY_BUILDER_2D.max_range' is missing");
  EXPECT_THAT(std::string(missing.status().message()),
              testing::Not(HasSubstr("\n")));
}

TEST(SlamConfigurationTest, OtherFilesAreNoConfigurations) {
  const auto parse = [](const std::string& code) {
    return ParseSlamConfiguration({"configuration_files"}, "test.lua", code);
  };
  ExpectError(parse("x = 1"), "): returns no map_builder: a configuration ");
  ExpectError(parse("return 3"), "): returns no map_builder: ");
  ExpectError(parse("return { map_builder = {} }"),
              "): returns no trajectory_builder: ");
  ExpectError(parse("return { parameters = {} }"),
              "is a search file of cartographer_ext_tune");
}

TEST(SlamConfigurationTest, ValuesOutOfRangeNameTheKeyOfTheFile) {
  ExpectError(Parse("TRAJECTORY_BUILDER_2D.max_range = -1"),
              "TRAJECTORY_BUILDER_2D.max_range is -1, must be above 0");
  ExpectError(Parse("POSE_GRAPH.constraint_builder.sampling_ratio = 0 / 0"),
              "POSE_GRAPH.constraint_builder.sampling_ratio is not a number");
  ExpectError(Parse("MAP_BUILDER.num_background_threads = 100000"),
              "MAP_BUILDER.num_background_threads is 100000");
  const auto odd = Parse("POSE_GRAPH.constraint_builder.min_score = 7");
  ASSERT_TRUE(odd.ok()) << odd.status();
  ASSERT_EQ(odd->warnings.size(), 1u);
  EXPECT_THAT(odd->warnings[0],
              HasSubstr("test.lua: POSE_GRAPH.constraint_builder.min_score is "
                        "7, should be at least 0 and at most 1"));
}

TEST(SlamConfigurationTest, CodeThatHarmsIsRefused) {
  ExpectError(Parse("os.exit(0)"), "os.exit");
  ExpectError(Parse("pcall(os.exit, 0)"), "os.exit");
  const auto itself = Parse("POSE_GRAPH.constraint_builder = POSE_GRAPH");
  EXPECT_EQ(itself.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(itself.status().message()),
              HasSubstr("map_builder.pose_graph.constraint_builder"));
}

TEST(SlamConfigurationTest, RestrictedConfigurationsAreTheSame) {
  const auto open =
      LoadSlamConfiguration({"configuration_files"}, "default.lua");
  RestrictLua(true);
  const auto restricted =
      LoadSlamConfiguration({"configuration_files"}, "default.lua");
  const auto harmful = Parse("HOME = os.getenv('HOME')");
  RestrictLua(false);
  ASSERT_TRUE(open.ok() && restricted.ok()) << restricted.status();
  EXPECT_EQ(restricted->map_builder_options.SerializeAsString(),
            open->map_builder_options.SerializeAsString());
  EXPECT_EQ(restricted->trajectory_builder_options.SerializeAsString(),
            open->trajectory_builder_options.SerializeAsString());
  EXPECT_FALSE(harmful.ok());
}

TEST(SlamConfigurationTest, MissingFilesNameTheFolders) {
  const auto configuration =
      LoadSlamConfiguration({"configuration_files", "elsewhere"}, "nope.lua");
  ASSERT_FALSE(configuration.ok());
  EXPECT_THAT(std::string(configuration.status().message()),
              HasSubstr("nope.lua"));
  EXPECT_THAT(std::string(configuration.status().message()),
              HasSubstr("configuration_files, elsewhere"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
