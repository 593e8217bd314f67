// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/configuration_patch.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tuning/temporary_file.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kWithBlock[] = R"(
include "common_2d.lua"
POSE_GRAPH.optimization_problem.cartographer_ext = { loop_sigma = 0.3 }
return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
})";

Parameter Range(const std::string& key, const double low, const double high) {
  Parameter parameter;
  parameter.key = key;
  parameter.low = low;
  parameter.high = high;
  return parameter;
}

Parameter Choices(const std::string& key, std::vector<Value> choices) {
  Parameter parameter;
  parameter.key = key;
  parameter.kind = Parameter::Kind::kChoice;
  parameter.choices = std::move(choices);
  return parameter;
}

class BaseConfigurationTest : public testing::Test {
 protected:
  BaseConfiguration Stock() const {
    return *BaseConfiguration::Load({"configuration_files"}, "stock.lua");
  }
  BaseConfiguration WithBlock() const {
    folder_.Write("block.lua", kWithBlock);
    auto configuration = BaseConfiguration::Load(
        {folder_.path(), "configuration_files"}, "block.lua");
    EXPECT_TRUE(configuration.ok()) << configuration.status();
    return *configuration;
  }
  const test::Folder folder_;
};

TEST_F(BaseConfigurationTest, FindsValues) {
  const auto values = Stock().Values(
      {Range("POSE_GRAPH.constraint_builder.min_score", 0., 1.),
       Range("POSE_GRAPH.optimize_every_n_nodes", 1, 100),
       Choices("TRAJECTORY_BUILDER_2D.use_imu_data", {true, false})});
  ASSERT_TRUE(values.ok()) << values.status();
  EXPECT_THAT(*values, ElementsAre(0.55, 90, false));
}

TEST_F(BaseConfigurationTest, AssignsWithoutTouchingTheFile) {
  const BaseConfiguration stock = Stock();
  const std::string key = "POSE_GRAPH.constraint_builder.min_score";
  const auto changed = evaluation::ParseSlamConfiguration(
      stock.directories(), "changed", stock.CodeWith({{key, 0.7}}));
  ASSERT_TRUE(changed.ok()) << changed.status();
  EXPECT_EQ(changed->map_builder_options.pose_graph_options()
                .constraint_builder_options()
                .min_score(),
            0.7);
  EXPECT_EQ(stock.parsed()
                .map_builder_options.pose_graph_options()
                .constraint_builder_options()
                .min_score(),
            0.55);
  const auto same = evaluation::ParseSlamConfiguration(
      stock.directories(), "same", stock.CodeWith(nlohmann::json::object()));
  ASSERT_TRUE(same.ok());
  EXPECT_EQ(same->map_builder_options.SerializeAsString(),
            stock.parsed().map_builder_options.SerializeAsString());
}

TEST_F(BaseConfigurationTest, FilesAreIncludedBeforeKeysAreAssigned) {
  const BaseConfiguration stock = Stock();
  const std::string key =
      "POSE_GRAPH.optimization_problem.odometry_translation_weight";
  const std::vector<Parameter> parameters = {
      Choices("include.loops", {"", "loop_closure_default.lua"}),
      Range(key, 1., 1e6)};
  const auto values = stock.Values(parameters);
  ASSERT_TRUE(values.ok()) << values.status();
  EXPECT_EQ((*values)[0], "");
  EXPECT_TRUE(stock.CheckParameters(parameters).ok());
  const auto weight = [&](const nlohmann::json& assignment) {
    const auto changed = evaluation::ParseSlamConfiguration(
        stock.directories(), "changed", stock.CodeWith(assignment));
    EXPECT_TRUE(changed.ok()) << changed.status();
    return changed->map_builder_options.pose_graph_options()
        .optimization_problem_options()
        .odometry_translation_weight();
  };
  EXPECT_EQ(weight({{"include.loops", ""}}), 1e5);
  EXPECT_EQ(weight({{"include.loops", "loop_closure_default.lua"}}), 10.);
  EXPECT_EQ(weight({{"include.loops", "loop_closure_default.lua"}, {key, 7.}}),
            7.);
  EXPECT_THAT(std::string(stock
                              .CheckParameters({Choices("include.loops",
                                                        {"", "not_there.lua"})})
                              .message()),
              HasSubstr("not_there.lua"));
}

TEST_F(BaseConfigurationTest, KnowsKeysThatABlockLeavesOut) {
  const BaseConfiguration configuration = WithBlock();
  const std::string block = "POSE_GRAPH.optimization_problem.cartographer_ext.";
  const std::vector<Parameter> parameters = {
      Range(block + "loop_sigma", 0.05, 0.2),
      Choices(block + "odometry_check", {true, false})};
  const auto values = configuration.Values(parameters);
  ASSERT_TRUE(values.ok()) << values.status();
  EXPECT_EQ((*values)[0].get<double>(), 0.3);
  EXPECT_EQ((*values)[1], true);
  EXPECT_TRUE(configuration.CheckParameters(parameters).ok())
      << configuration.CheckParameters(parameters);
}

std::string ErrorOf(const BaseConfiguration& configuration,
                    const Parameter& parameter) {
  const absl::Status status = configuration.CheckParameters({parameter});
  EXPECT_FALSE(status.ok()) << parameter.key;
  return std::string(status.message());
}

TEST_F(BaseConfigurationTest, BadKeysAreNamed) {
  const BaseConfiguration stock = Stock();
  EXPECT_THAT(
      ErrorOf(stock, Range("POSE_GRAPH.constraint_builder.min_scor", 0., 1.)),
      HasSubstr("did you mean 'min_score'"));
  EXPECT_THAT(
      ErrorOf(stock, Range("POSE_GRAPH.constraint_builder.minscore", 0., 1.)),
      HasSubstr("did you mean 'min_score'"));
  EXPECT_THAT(ErrorOf(stock, Range("POSEGRAPH.x", 0., 1.)),
              HasSubstr("no key POSEGRAPH.x"));
  EXPECT_THAT(ErrorOf(stock, Range("POSE_GRAPH.constraint_builder", 0., 1.)),
              HasSubstr("is a table"));
  EXPECT_THAT(ErrorOf(stock, Range("TRAJECTORY_BUILDER_2D.use_imu_data", 0, 1)),
              HasSubstr("give choices"));
  EXPECT_THAT(
      ErrorOf(
          stock,
          Range("POSE_GRAPH.optimization_problem.cartographer_ext.loop_sigma",
                1., 2.)),
      HasSubstr("does not have the block"));
  EXPECT_THAT(ErrorOf(WithBlock(),
                      Range("POSE_GRAPH.optimization_problem.cartographer_ext."
                            "loop_sigm",
                            1., 2.)),
              HasSubstr("did you mean 'loop_sigma'"));
}

TEST_F(BaseConfigurationTest, KeysWithoutEffectAreNamed) {
  EXPECT_THAT(
      ErrorOf(Stock(), Range("TRAJECTORY_BUILDER_3D.min_range", 1., 2.)),
      HasSubstr("is not used"));
}

TEST_F(BaseConfigurationTest, ValuesThatAreNotAllowedAreNamed) {
  const std::string error = ErrorOf(
      WithBlock(),
      Range("POSE_GRAPH.optimization_problem.cartographer_ext.loop_sigma", -1.,
            2.));
  EXPECT_THAT(error, HasSubstr("loop_sigma = -1."));
  EXPECT_THAT(error, HasSubstr("range"));
  // A fraction where an integer is wanted.
  EXPECT_THAT(
      ErrorOf(Stock(), Range("POSE_GRAPH.optimize_every_n_nodes", 0.5, 20.)),
      HasSubstr("optimize_every_n_nodes"));
  // Ends that are integers hide it no longer.
  EXPECT_THAT(
      ErrorOf(Stock(), Range("POSE_GRAPH.optimize_every_n_nodes", 1., 20.)),
      HasSubstr("give it integer = true"));
}

TEST_F(BaseConfigurationTest, BadFilesAreErrors) {
  EXPECT_FALSE(BaseConfiguration::Load({folder_.path()}, "absent.lua").ok());
  folder_.Write("bad.lua", "return { map_builder = {} }");
  EXPECT_FALSE(BaseConfiguration::Load({folder_.path()}, "bad.lua").ok());
}

TEST_F(BaseConfigurationTest, FingerprintFollowsTheOptions) {
  EXPECT_EQ(Stock().Fingerprint(), Stock().Fingerprint());
  EXPECT_NE(Stock().Fingerprint(), WithBlock().Fingerprint());
  folder_.Write("imu.lua",
                "include \"stock.lua\"\n"
                "return { map_builder = MAP_BUILDER,\n"
                "         trajectory_builder = TRAJECTORY_BUILDER,\n"
                "         sensors = { use_recorded_imu = true } }");
  const auto imu = BaseConfiguration::Load(
      {folder_.path(), "configuration_files"}, "imu.lua");
  ASSERT_TRUE(imu.ok()) << imu.status();
  EXPECT_NE(Stock().Fingerprint(), imu->Fingerprint());
  EXPECT_EQ(HashText(""), "cbf29ce484222325");
  EXPECT_EQ(HashText("a"), "af63dc4c8601ec8c");
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
