// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"

#include <cmath>

#include "cartographer/mapping/internal/2d/tsdf_2d.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

proto::CeresScanMatcherOptions2D Options() {
  const auto lua = test::Lua(R"(return {
    occupied_space_weight = 1.,
    translation_weight = 0.1,
    rotation_weight = 1.5,
    ceres_solver_options = {
      use_nonmonotonic_steps = true,
      max_num_iterations = 50,
      num_threads = 1,
    },
  })");
  return CreateCeresScanMatcherOptions2D(lua.get());
}

TEST(CeresScanMatcherOptionsTest, ReadsEachKeyOnce) {
  const auto options = Options();
  EXPECT_EQ(options.occupied_space_weight(), 1.);
  EXPECT_EQ(options.translation_weight(), 0.1);
  EXPECT_EQ(options.rotation_weight(), 1.5);
  EXPECT_TRUE(options.ceres_solver_options().use_nonmonotonic_steps());
  EXPECT_EQ(options.ceres_solver_options().max_num_iterations(), 50);
}

// One occupied cell of one metre, centred at (-3.5, 2.5), and one point.
class OnePointTest
    : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(OnePointTest, IsPulledOntoTheCell) {
  ValueConversionTables tables;
  ProbabilityGrid grid(
      MapLimits(1., Eigen::Vector2d(10., 10.), CellLimits(20, 20)), &tables);
  grid.SetProbability(grid.limits().GetCellIndex({-3.5f, 2.5f}),
                      kMaxProbability);
  const sensor::PointCloud cloud = test::Cloud({{-3.f, 2.f}});
  const CeresScanMatcher2D matcher(Options());
  const transform::Rigid2d initial =
      transform::Rigid2d::Translation({GetParam().first, GetParam().second});
  transform::Rigid2d pose;
  ceres::Solver::Summary summary;
  matcher.Match(initial.translation(), initial, cloud, grid, &pose, &summary);
  EXPECT_NEAR(summary.final_cost, 0., 1e-2) << summary.FullReport();
  // The target, which is the initial pose, pulls a little the other way.
  EXPECT_NEAR((pose.translation() - Eigen::Vector2d(-0.5, 0.5)).norm(), 0.,
              1.5e-2);
  EXPECT_NEAR(pose.rotation().angle(), 0., 1e-2);
}

INSTANTIATE_TEST_SUITE_P(Initial, OnePointTest,
                         ::testing::Values(std::make_pair(-0.5, 0.5),
                                           std::make_pair(-0.3, 0.5),
                                           std::make_pair(-0.45, 0.3),
                                           std::make_pair(-0.3, 0.3)));

TEST(CeresScanMatcherTest, RefinesBelowACell) {
  ValueConversionTables tables;
  const auto grid = test::RoomGrid(&tables, 0.05, 8);
  const sensor::PointCloud room = test::Room();
  auto options = Options();
  options.set_occupied_space_weight(20.);
  const CeresScanMatcher2D matcher(options);
  const transform::Rigid2d expected({0.07, -0.04}, 0.03);
  const sensor::PointCloud seen = test::Moved(room, expected.inverse());
  // All three arguments are the same pose.
  transform::Rigid2d pose({0.03, 0.}, 0.01);
  ceres::Solver::Summary summary;
  matcher.Match(pose.translation(), pose, seen, *grid, &pose, &summary);
  EXPECT_NEAR((pose.translation() - expected.translation()).norm(), 0., 0.01);
  EXPECT_NEAR((pose.inverse() * expected).normalized_angle(), 0., 0.01);
  EXPECT_LT(summary.final_cost, summary.initial_cost);
}

TEST(CeresScanMatcherTest, WithoutPointsOnlyTheTargetPulls) {
  ValueConversionTables tables;
  const auto grid = test::RoomGrid(&tables, 0.05, 1);
  const CeresScanMatcher2D matcher(Options());
  transform::Rigid2d pose;
  ceres::Solver::Summary summary;
  matcher.Match({1., 2.}, transform::Rigid2d({0., 0.}, 0.5), {}, *grid, &pose,
                &summary);
  EXPECT_NEAR((pose.translation() - Eigen::Vector2d(1., 2.)).norm(), 0., 1e-4);
  EXPECT_NEAR(pose.rotation().angle(), 0.5, 1e-6);
}

TEST(CeresScanMatcherTest, TSDF) {
  ValueConversionTables tables;
  const CellLimits size(40, 40);
  TSDF2D tsdf(MapLimits(0.1, Eigen::Vector2d(2., 2.), size), 1.f, 10.f,
              &tables);
  for (const Eigen::Array2i& index : XYIndexRangeIterator(size)) {
    const Eigen::Vector2f center = tsdf.limits().GetCellCenter(index);
    tsdf.SetCell(index, 1.f - center.x(), 5.f);
  }
  tsdf.FinishUpdate();
  sensor::PointCloud wall;
  for (int i = -5; i <= 5; ++i) {
    wall.push_back({Eigen::Vector3f(0.8f, 0.1f * i, 0.f)});
  }
  auto options = Options();
  options.set_occupied_space_weight(100.);
  const CeresScanMatcher2D matcher(options);
  transform::Rigid2d pose;
  ceres::Solver::Summary summary;
  matcher.Match({0., 0.}, transform::Rigid2d::Identity(), wall, tsdf, &pose,
                &summary);
  EXPECT_NEAR(pose.translation().x(), 0.2, 1e-3);
  EXPECT_NEAR(pose.translation().y(), 0., 1e-3);
}

}  // namespace
}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
