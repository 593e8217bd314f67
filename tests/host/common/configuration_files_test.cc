// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The stock configuration files are complete, have no surplus keys (the strict
// dictionaries would end the program) and hold the stock values.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer {
namespace mapping {
namespace {

struct Options {
  proto::MapBuilderOptions map_builder;
  proto::TrajectoryBuilderOptions trajectory_builder;
};

Options Load(const std::string& basename,
             const std::vector<std::string>& directories) {
  auto resolver =
      std::make_unique<common::ConfigurationFileResolver>(directories);
  const std::string code = resolver->GetFileContentOrDie(basename);
  common::LuaParameterDictionary dictionary(code, std::move(resolver));
  Options options;
  options.map_builder =
      CreateMapBuilderOptions(dictionary.GetDictionary("map_builder").get());
  options.trajectory_builder = CreateTrajectoryBuilderOptions(
      dictionary.GetDictionary("trajectory_builder").get());
  return options;
}

TEST(ConfigurationFilesTest, StockMapBuilder) {
  const auto options = Load("stock.lua", {"configuration_files"}).map_builder;
  EXPECT_TRUE(options.use_trajectory_builder_2d());
  EXPECT_FALSE(options.use_trajectory_builder_3d());
  EXPECT_EQ(options.num_background_threads(), 4);
  EXPECT_FALSE(options.collate_by_trajectory());

  const auto& graph = options.pose_graph_options();
  EXPECT_EQ(graph.optimize_every_n_nodes(), 90);
  EXPECT_EQ(graph.matcher_translation_weight(), 5e2);
  EXPECT_EQ(graph.matcher_rotation_weight(), 1.6e3);
  EXPECT_EQ(graph.max_num_final_iterations(), 200);
  EXPECT_EQ(graph.global_sampling_ratio(), 0.003);
  EXPECT_EQ(graph.global_constraint_search_after_n_seconds(), 10.);
  EXPECT_FALSE(graph.has_overlapping_submaps_trimmer_2d());

  const auto& loops = graph.constraint_builder_options();
  EXPECT_EQ(loops.sampling_ratio(), 0.3);
  EXPECT_EQ(loops.max_constraint_distance(), 15.);
  EXPECT_EQ(loops.min_score(), 0.55);
  EXPECT_EQ(loops.global_localization_min_score(), 0.6);
  EXPECT_EQ(loops.loop_closure_translation_weight(), 1.1e4);
  EXPECT_EQ(loops.loop_closure_rotation_weight(), 1e5);
  const auto& search = loops.fast_correlative_scan_matcher_options();
  EXPECT_EQ(search.linear_search_window(), 7.);
  EXPECT_NEAR(search.angular_search_window(), M_PI / 6., 1e-15);
  EXPECT_EQ(search.branch_and_bound_depth(), 7);
  const auto& refinement = loops.ceres_scan_matcher_options();
  EXPECT_EQ(refinement.occupied_space_weight(), 20.);
  EXPECT_EQ(refinement.translation_weight(), 10.);
  EXPECT_EQ(refinement.rotation_weight(), 1.);
  EXPECT_TRUE(refinement.ceres_solver_options().use_nonmonotonic_steps());
  EXPECT_EQ(refinement.ceres_solver_options().max_num_iterations(), 10);
  EXPECT_EQ(
      loops.fast_correlative_scan_matcher_options_3d().full_resolution_depth(),
      3);
  EXPECT_EQ(loops.ceres_scan_matcher_options_3d().occupied_space_weight_size(),
            2);

  const auto& problem = graph.optimization_problem_options();
  EXPECT_EQ(problem.huber_scale(), 10.);
  EXPECT_EQ(problem.acceleration_weight(), 1.1e2);
  EXPECT_EQ(problem.rotation_weight(), 1.6e4);
  EXPECT_EQ(problem.local_slam_pose_translation_weight(), 1e5);
  EXPECT_EQ(problem.local_slam_pose_rotation_weight(), 1e5);
  EXPECT_EQ(problem.odometry_translation_weight(), 1e5);
  EXPECT_EQ(problem.odometry_rotation_weight(), 1e5);
  EXPECT_EQ(problem.fixed_frame_pose_translation_weight(), 1e1);
  EXPECT_EQ(problem.fixed_frame_pose_rotation_weight(), 1e2);
  EXPECT_EQ(problem.ceres_solver_options().max_num_iterations(), 50);
  EXPECT_EQ(problem.ceres_solver_options().num_threads(), 7);
}

TEST(ConfigurationFilesTest, StockTrajectoryBuilder) {
  const auto options =
      Load("stock.lua", {"configuration_files"}).trajectory_builder;
  EXPECT_TRUE(options.collate_fixed_frame());
  EXPECT_FALSE(options.collate_landmarks());
  EXPECT_FALSE(options.has_pure_localization_trimmer());

  const auto& local = options.trajectory_builder_2d_options();
  EXPECT_FALSE(local.use_imu_data());
  EXPECT_EQ(local.max_range(), 30.f);
  EXPECT_EQ(local.min_z(), -0.8f);
  EXPECT_EQ(local.max_z(), 2.f);
  EXPECT_EQ(local.missing_data_ray_length(), 5.f);
  EXPECT_EQ(local.num_accumulated_range_data(), 1);
  EXPECT_EQ(local.voxel_filter_size(), 0.025f);
  EXPECT_FALSE(local.use_online_correlative_scan_matching());
  EXPECT_EQ(local.imu_gravity_time_constant(), 10.);
  EXPECT_EQ(local.adaptive_voxel_filter_options().max_length(), 0.5f);
  EXPECT_EQ(local.adaptive_voxel_filter_options().min_num_points(), 200.f);
  EXPECT_EQ(local.adaptive_voxel_filter_options().max_range(), 50.f);
  EXPECT_EQ(local.real_time_correlative_scan_matcher_options()
                .translation_delta_cost_weight(),
            0.1);
  EXPECT_EQ(local.ceres_scan_matcher_options().occupied_space_weight(), 1.);
  EXPECT_EQ(local.ceres_scan_matcher_options().translation_weight(), 10.);
  EXPECT_EQ(local.ceres_scan_matcher_options().rotation_weight(), 40.);
  EXPECT_EQ(local.motion_filter_options().max_time_seconds(), 5.);
  EXPECT_EQ(local.motion_filter_options().max_distance_meters(), 0.2);
  EXPECT_NEAR(local.motion_filter_options().max_angle_radians(), M_PI / 180.,
              1e-15);
  EXPECT_FALSE(local.pose_extrapolator_options().use_imu_based());
  EXPECT_EQ(local.pose_extrapolator_options()
                .constant_velocity()
                .pose_queue_duration(),
            0.001);
  EXPECT_EQ(local.pose_extrapolator_options().imu_based().gravity_constant(),
            9.806);

  const auto& submaps = local.submaps_options();
  EXPECT_EQ(submaps.num_range_data(), 90);
  EXPECT_EQ(submaps.grid_options_2d().grid_type(),
            proto::GridOptions2D::PROBABILITY_GRID);
  EXPECT_EQ(submaps.grid_options_2d().resolution(), 0.05f);
  const auto& inserter = submaps.range_data_inserter_options();
  EXPECT_EQ(inserter.range_data_inserter_type(),
            proto::RangeDataInserterOptions::PROBABILITY_GRID_INSERTER_2D);
  const auto& hits = inserter.probability_grid_range_data_inserter_options_2d();
  EXPECT_EQ(hits.hit_probability(), 0.55);
  EXPECT_EQ(hits.miss_probability(), 0.49);
  EXPECT_TRUE(hits.insert_free_space());
  EXPECT_EQ(
      inserter.tsdf_range_data_inserter_options_2d().truncation_distance(),
      0.3);
  EXPECT_EQ(options.trajectory_builder_3d_options().rotational_histogram_size(),
            120);
}

// The files that come with Cartographer's own include ours by the same names.
TEST(ConfigurationFilesTest, GoldenConfigurations) {
  const std::string directory = cartographer_ext::test::Golden("configs");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(directory);
  for (const std::string name :
       {"aces-made", "aces-sound", "csail-made", "csail-sound"}) {
    const Options options =
        Load(name + "-by-cartographer.lua", {directory, "configuration_files"});
    EXPECT_TRUE(options.trajectory_builder.trajectory_builder_2d_options()
                    .use_online_correlative_scan_matching());
  }
}

TEST(ConfigurationFilesDeathTest, SurplusKeysAreFatal) {
  EXPECT_DEATH(
      {
        auto resolver = std::make_unique<common::ConfigurationFileResolver>(
            std::vector<std::string>{"configuration_files"});
        common::LuaParameterDictionary dictionary(
            "include 'stock.lua'\n"
            "POSE_GRAPH.constraint_builder.bogus = 1\n"
            "return MAP_BUILDER",
            std::move(resolver));
        CreateMapBuilderOptions(&dictionary);
      },
      "pose_graph.constraint_builder.bogus");
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
