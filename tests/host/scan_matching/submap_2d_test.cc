// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/submap_2d.h"

#include <set>

#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace {

std::string Options(const std::string& grid_type, const std::string& inserter) {
  return R"(return {
    num_range_data = 3,
    grid_options_2d = { grid_type = ')" +
         grid_type + R"(', resolution = 0.05 },
    range_data_inserter = {
      range_data_inserter_type = ')" +
         inserter + R"(',
      probability_grid_range_data_inserter = {
        insert_free_space = true,
        hit_probability = 0.55,
        miss_probability = 0.49,
      },
      tsdf_range_data_inserter = {
        truncation_distance = 0.3,
        maximum_weight = 10.,
        update_free_space = false,
        normal_estimation_options = {
          num_normal_samples = 4,
          sample_radius = 0.5,
        },
        project_sdf_distance_to_scan_normal = true,
        update_weight_range_exponent = 0,
        update_weight_angle_scan_normal_to_ray_kernel_bandwidth = 0.5,
        update_weight_distance_cell_to_hit_kernel_bandwidth = 0.4,
      },
    },
  })";
}

proto::SubmapsOptions2D DefaultOptions() {
  const auto lua =
      test::Lua(Options("PROBABILITY_GRID", "PROBABILITY_GRID_INSERTER_2D"));
  return CreateSubmapsOptions2D(lua.get());
}

sensor::RangeData RangeDataFrom(const float x) {
  return {Eigen::Vector3f(x, 0.f, 0.f),
          test::Cloud({{x + 1.f, 0.5f}, {x - 0.5f, 1.f}}),
          {}};
}

TEST(Submap2DTest, ReadsOptions) {
  const proto::SubmapsOptions2D options = DefaultOptions();
  EXPECT_EQ(options.num_range_data(), 3);
  EXPECT_FLOAT_EQ(options.grid_options_2d().resolution(), 0.05f);
  const auto& tsdf = options.range_data_inserter_options()
                         .tsdf_range_data_inserter_options_2d();
  EXPECT_EQ(tsdf.truncation_distance(), 0.3);
  EXPECT_EQ(tsdf.maximum_weight(), 10.);
  EXPECT_EQ(tsdf.normal_estimation_options().num_normal_samples(), 4);
  EXPECT_TRUE(tsdf.project_sdf_distance_to_scan_normal());
  EXPECT_EQ(tsdf.update_weight_distance_cell_to_hit_kernel_bandwidth(), 0.4);
}

TEST(Submap2DDeathTest, RefusesWhatItCannotBuild) {
  EXPECT_DEATH(
      {
        const auto lua = test::Lua(Options("TSDF", "TSDF_INSERTER_2D"));
        CreateSubmapsOptions2D(lua.get());
      },
      "grid_type: TSDF submaps can be read");
  EXPECT_DEATH(
      {
        const auto lua =
            test::Lua(Options("PROBABILITY_GRID", "TSDF_INSERTER_2D"));
        CreateSubmapsOptions2D(lua.get());
      },
      "does not go with");
}

TEST(ActiveSubmaps2DTest, TwoAtATimeFinishedAfterTwiceTheRangeData) {
  ActiveSubmaps2D active(DefaultOptions());
  EXPECT_TRUE(active.submaps().empty());
  std::set<std::shared_ptr<const Submap2D>> all;
  for (int i = 0; i != 20; ++i) {
    const auto inserted = active.InsertRangeData(RangeDataFrom(0.1f * i));
    all.insert(inserted.begin(), inserted.end());
    EXPECT_EQ(inserted.size(), i < 3 ? 1u : 2u) << i;
    EXPECT_EQ(inserted.front()->insertion_finished(),
              inserted.front()->num_range_data() == 6);
    if (inserted.size() == 2) {
      EXPECT_EQ(inserted[0]->num_range_data(),
                inserted[1]->num_range_data() + 3);
      EXPECT_FALSE(inserted[1]->insertion_finished());
    }
    EXPECT_EQ(active.submaps(), inserted);
  }
  // New ones with insertions 1, 4, 7, ..., 19.
  EXPECT_EQ(all.size(), 7u);
  int finished = 0;
  for (const auto& submap : all) finished += submap->insertion_finished();
  EXPECT_EQ(finished, 5);
}

TEST(ActiveSubmaps2DTest, OriginAndInitialGrid) {
  ActiveSubmaps2D active(DefaultOptions());
  const auto submap = active.InsertRangeData(RangeDataFrom(2.f)).front();
  EXPECT_NEAR(
      (submap->local_pose().translation() - Eigen::Vector3d(2., 0., 0.)).norm(),
      0., 1e-12);
  const MapLimits& limits = submap->grid()->limits();
  EXPECT_EQ(limits.cell_limits().num_x_cells, 100);
  EXPECT_EQ(limits.resolution(), static_cast<double>(0.05f));
  EXPECT_NEAR(limits.max().x(), 4.5, 1e-6);
  EXPECT_NEAR(limits.max().y(), 2.5, 1e-6);
}

TEST(ActiveSubmaps2DTest, FinishingCrops) {
  ActiveSubmaps2D active(DefaultOptions());
  std::shared_ptr<const Submap2D> first;
  for (int i = 0; i != 6; ++i) {
    first = active.InsertRangeData(RangeDataFrom(0.f)).front();
  }
  ASSERT_TRUE(first->insertion_finished());
  // Returns at (1, 0.5) and (-0.5, 1): 31 by 21 cells, one more for where the
  // points lie within their cells.
  EXPECT_NEAR(first->grid()->limits().cell_limits().num_y_cells, 31, 1);
  EXPECT_NEAR(first->grid()->limits().cell_limits().num_x_cells, 21, 1);
  EXPECT_NEAR(first->grid()->limits().max().x(), 1., 0.06);
}

TEST(Submap2DTest, ProtoRoundTrip) {
  ActiveSubmaps2D active(DefaultOptions());
  const auto submap = active.InsertRangeData(RangeDataFrom(2.f)).front();
  const proto::Submap proto = submap->ToProto(true);
  EXPECT_FALSE(submap->ToProto(false).submap_2d().has_grid());
  ValueConversionTables tables;
  Submap2D read(proto.submap_2d(), &tables);
  EXPECT_EQ(read.num_range_data(), 1);
  EXPECT_FALSE(read.insertion_finished());
  EXPECT_EQ(read.ToProto(true).SerializeAsString(), proto.SerializeAsString());

  const Submap2D bare(submap->ToProto(false).submap_2d(), &tables);
  EXPECT_EQ(bare.grid(), nullptr);
  proto::SubmapQuery::Response nothing;
  bare.ToResponseProto(transform::Rigid3d::Identity(), &nothing);
  EXPECT_EQ(nothing.textures_size(), 0);

  proto::Submap update = proto;
  update.mutable_submap_2d()->set_num_range_data(6);
  update.mutable_submap_2d()->set_finished(true);
  read.UpdateFromProto(update);
  EXPECT_EQ(read.num_range_data(), 6);
  EXPECT_TRUE(read.insertion_finished());
  proto::SubmapQuery::Response response;
  read.ToResponseProto(transform::Rigid3d::Identity(), &response);
  EXPECT_EQ(response.submap_version(), 6);
  ASSERT_EQ(response.textures_size(), 1);
  EXPECT_GT(response.textures(0).width(), 1);
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
