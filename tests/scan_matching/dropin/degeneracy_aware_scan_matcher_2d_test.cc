// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/dropin/degeneracy_aware_scan_matcher_2d.h"

#include <cmath>
#include <limits>
#include <vector>

#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/tsdf_2d.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/options/option_description.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

namespace mapping = cartographer::mapping;
namespace sensor = cartographer::sensor;
namespace transform = cartographer::transform;
using mapping::scan_matching::CeresScanMatcher2D;
using StockOptions = mapping::scan_matching::proto::CeresScanMatcherOptions2D;

StockOptions Options(const double occupied_space_weight) {
  StockOptions options;
  options.set_occupied_space_weight(occupied_space_weight);
  options.set_translation_weight(0.1);
  options.set_rotation_weight(1.5);
  options.mutable_ceres_solver_options()->set_use_nonmonotonic_steps(true);
  options.mutable_ceres_solver_options()->set_max_num_iterations(50);
  options.mutable_ceres_solver_options()->set_num_threads(1);
  return options;
}

proto::ScanMatcherOptions Extension() {
  proto::ScanMatcherOptions extension;
  options::SetDefaults(&extension);
  return extension;
}

StockOptions WithBlock(StockOptions stock) {
  options::SetExtension(Extension(), &stock);
  return stock;
}

sensor::PointCloud Cloud(const std::vector<Eigen::Vector2d>& points) {
  sensor::PointCloud cloud;
  for (const Eigen::Vector2d& point : points) {
    cloud.push_back({Eigen::Vector3f(static_cast<float>(point.x()),
                                     static_cast<float>(point.y()), 0.f)});
  }
  return cloud;
}

mapping::ProbabilityGrid EmptyGrid(mapping::ValueConversionTables* tables) {
  return mapping::ProbabilityGrid(
      mapping::MapLimits(0.05, Eigen::Vector2d(4., 4.),
                         mapping::CellLimits(160, 160)),
      tables);
}

// An L of two walls on cell centres, free space before them.
std::vector<Eigen::Vector2d> Walls() {
  std::vector<Eigen::Vector2d> points;
  for (double s = -1.975; s < 2.; s += 0.05) {
    points.emplace_back(s, 2.025);
    points.emplace_back(2.025, s);
  }
  return points;
}

void Draw(const std::vector<Eigen::Vector2d>& points,
          mapping::ProbabilityGrid* const grid) {
  for (double x = -1.975; x < 2.; x += 0.05) {
    for (double y = -1.975; y < 2.; y += 0.05) {
      grid->SetProbability(grid->limits().GetCellIndex(Eigen::Vector2f(x, y)),
                           0.2f);
    }
  }
  for (const Eigen::Vector2d& point : points) {
    grid->SetProbability(grid->limits().GetCellIndex(point.cast<float>()),
                         0.8f);
  }
}

// The four behaviours of the stock tests hold with the block, too: one cell,
// one point, seen from four places.
TEST(DegeneracyAwareScanMatcher2DTest, OnePointIsPulledOntoItsCell) {
  mapping::ValueConversionTables tables;
  mapping::ProbabilityGrid grid(
      mapping::MapLimits(1., Eigen::Vector2d(10., 10.),
                         mapping::CellLimits(20, 20)),
      &tables);
  grid.SetProbability(grid.limits().GetCellIndex({-3.5f, 2.5f}), 0.9f);
  const CeresScanMatcher2D matcher(WithBlock(Options(1.)));
  for (const Eigen::Vector2d& start :
       {Eigen::Vector2d(-0.5, 0.5), Eigen::Vector2d(-0.3, 0.5),
        Eigen::Vector2d(-0.45, 0.3), Eigen::Vector2d(-0.3, 0.3)}) {
    const transform::Rigid2d initial = transform::Rigid2d::Translation(start);
    transform::Rigid2d pose;
    ceres::Solver::Summary summary;
    matcher.Match(initial.translation(), initial, Cloud({{-3., 2.}}), grid,
                  &pose, &summary);
    EXPECT_NEAR((pose.translation() - Eigen::Vector2d(-0.5, 0.5)).norm(), 0.,
                0.03);
    EXPECT_NEAR(pose.rotation().angle(), 0., 1e-2);
    EXPECT_NEAR(summary.final_cost, 0., 1e-2);
    EXPECT_EQ(summary.termination_type, ceres::CONVERGENCE);
  }
}

TEST(DegeneracyAwareScanMatcher2DTest, AgreesWithStockWhereAllIsDetermined) {
  mapping::ValueConversionTables tables;
  mapping::ProbabilityGrid grid = EmptyGrid(&tables);
  Draw(Walls(), &grid);
  const transform::Rigid2d truth({0.03, -0.02}, 0.01);
  std::vector<Eigen::Vector2d> seen;
  for (const Eigen::Vector2d& point : Walls()) {
    seen.push_back(truth.inverse() * point);
  }
  const CeresScanMatcher2D stock(Options(20.));
  const CeresScanMatcher2D ours(WithBlock(Options(20.)));
  transform::Rigid2d stock_pose, our_pose;
  ceres::Solver::Summary stock_summary, our_summary;
  const transform::Rigid2d initial;
  stock.Match({0., 0.}, initial, Cloud(seen), grid, &stock_pose,
              &stock_summary);
  ours.Match({0., 0.}, initial, Cloud(seen), grid, &our_pose, &our_summary);
  EXPECT_NEAR((stock_pose.translation() - our_pose.translation()).norm(), 0.,
              3e-3);
  EXPECT_NEAR(stock_pose.rotation().angle(), our_pose.rotation().angle(), 1e-3);
  EXPECT_LE(our_summary.final_cost, 1.01 * stock_summary.final_cost);
  EXPECT_NEAR(our_summary.initial_cost / stock_summary.initial_cost, 1., 1e-9);
}

TEST(DegeneracyAwareScanMatcher2DTest, OutputMayBeTheInput) {
  mapping::ValueConversionTables tables;
  mapping::ProbabilityGrid grid = EmptyGrid(&tables);
  Draw(Walls(), &grid);
  const DegeneracyAwareScanMatcher2D matcher(Options(20.), Extension());
  transform::Rigid2d pose({0.02, 0.01}, 0.01), other;
  matcher.Match(pose.translation(), pose, Cloud(Walls()), grid, &other,
                nullptr);
  ceres::Solver::Summary summary;
  matcher.Match(pose.translation(), pose, Cloud(Walls()), grid, &pose,
                &summary);
  EXPECT_EQ(pose.translation(), other.translation());
  EXPECT_EQ(pose.rotation().angle(), other.rotation().angle());
}

TEST(DegeneracyAwareScanMatcher2DTest, NothingToMatchGivesThePrediction) {
  mapping::ValueConversionTables tables;
  const mapping::ProbabilityGrid unknown = EmptyGrid(&tables);
  mapping::ProbabilityGrid known = EmptyGrid(&tables);
  Draw(Walls(), &known);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  sensor::PointCloud not_finite = Cloud({{1., 1.}});
  not_finite.push_back({Eigen::Vector3f(nan, nan, 0.f)});
  const CeresScanMatcher2D matcher(WithBlock(Options(1.)));
  for (const sensor::PointCloud& cloud :
       {sensor::PointCloud(), Cloud({{1., 1.}}), Cloud({{1., 1.}, {1., 1.1}}),
        not_finite, Cloud(Walls())}) {
    transform::Rigid2d pose;
    ceres::Solver::Summary summary;
    const transform::Rigid2d initial({0.1, 0.2}, 0.3);
    matcher.Match({0.11, 0.22}, initial, cloud, unknown, &pose, &summary);
    EXPECT_NEAR(pose.translation().x(), 0.11, 1e-6);
    EXPECT_NEAR(pose.translation().y(), 0.22, 1e-6);
    EXPECT_NEAR(pose.rotation().angle(), 0.3, 1e-6);
    EXPECT_TRUE(std::isfinite(summary.final_cost));
    matcher.Match({0.11, 0.22}, initial, cloud, known, &pose, &summary);
    EXPECT_TRUE(pose.translation().allFinite());
    EXPECT_TRUE(std::isfinite(pose.rotation().angle()));
  }
}

TEST(DegeneracyAwareScanMatcher2DTest, TsdfGoesToTheStockMatcher) {
  mapping::ValueConversionTables tables;
  mapping::TSDF2D grid(mapping::MapLimits(0.1, Eigen::Vector2d(1., 1.),
                                          mapping::CellLimits(20, 20)),
                       0.3, 1.0, &tables);
  for (float x = -0.95f; x < 1.f; x += 0.1f) {
    for (float y = -0.25f; y < 0.3f; y += 0.1f) {
      grid.SetCell(grid.limits().GetCellIndex({x, y}), y, 1.f);
    }
  }
  std::vector<Eigen::Vector2d> points;
  for (double x = -0.5; x < 0.5; x += 0.05) points.emplace_back(x, 0.);
  const transform::Rigid2d initial({0., 0.05}, 0.);
  transform::Rigid2d stock_pose, our_pose;
  ceres::Solver::Summary summary;
  CeresScanMatcher2D(Options(1.))
      .Match(initial.translation(), initial, Cloud(points), grid, &stock_pose,
             &summary);
  CeresScanMatcher2D(WithBlock(Options(1.)))
      .Match(initial.translation(), initial, Cloud(points), grid, &our_pose,
             &summary);
  EXPECT_EQ(stock_pose.translation(), our_pose.translation());
  EXPECT_EQ(stock_pose.rotation().angle(), our_pose.rotation().angle());

  Prediction prediction;
  prediction.pose = Pose2(0., 0.05, 0.);
  MatchReport report;
  DegeneracyAwareScanMatcher2D(Options(1.), Extension())
      .MatchWithPrediction(prediction, initial, Cloud(points), grid, &our_pose,
                           &report);
  EXPECT_EQ(stock_pose.translation(), our_pose.translation());
  EXPECT_EQ(report.final_cost, summary.final_cost);
  EXPECT_EQ(report.degeneracy.state, DegeneracyState::kNone);
  EXPECT_GT(report.covariance.diagonal().minCoeff(), 0.);
}

TEST(DegeneracyAwareScanMatcher2DDeathTest, WeightsMustBePositive) {
  StockOptions options = Options(1.);
  options.set_rotation_weight(0.);
  EXPECT_DEATH(DegeneracyAwareScanMatcher2D(options, Extension()), "");
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
