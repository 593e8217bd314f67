// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"

#include <algorithm>
#include <cmath>

#include "cartographer/mapping/internal/2d/scan_matching/rotated_cell_indices.h"
#include "cartographer/mapping/internal/2d/tsdf_2d.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

proto::FastCorrelativeScanMatcherOptions2D Options(const double linear,
                                                   const double angular,
                                                   const int depth) {
  proto::FastCorrelativeScanMatcherOptions2D options;
  options.set_linear_search_window(linear);
  options.set_angular_search_window(angular);
  options.set_branch_and_bound_depth(depth);
  return options;
}

TEST(FastCorrelativeOptionsTest, ReadsEachKeyOnce) {
  const auto lua = test::Lua(
      "return { linear_search_window = 7., angular_search_window = 0.5,"
      " branch_and_bound_depth = 6 }");
  const auto options = CreateFastCorrelativeScanMatcherOptions2D(lua.get());
  EXPECT_EQ(options.linear_search_window(), 7.);
  EXPECT_EQ(options.angular_search_window(), 0.5);
  EXPECT_EQ(options.branch_and_bound_depth(), 6);
}

TEST(PrecomputationGridTest, HoldsMaximaOfSquares) {
  ValueConversionTables tables;
  const CellLimits size(13, 9);
  ProbabilityGrid grid(MapLimits(0.05, Eigen::Vector2d(0., 0.), size), &tables);
  cartographer_ext::Random random(1);
  for (const Eigen::Array2i& index : XYIndexRangeIterator(size)) {
    if (random.Uniform() < 0.2) continue;
    grid.SetProbability(index, static_cast<float>(random.Uniform(0.1, 0.9)));
  }
  for (const int width : {1, 2, 3, 4, 7, 8, 13, 16, 20}) {
    const PrecomputationGrid2D wide(grid, size, width, nullptr);
    for (const Eigen::Array2i& index : XYIndexRangeIterator(
             Eigen::Array2i(-width - 1, -width - 1), Eigen::Array2i(14, 10))) {
      float best = kMinProbability;
      for (const Eigen::Array2i& inner : XYIndexRangeIterator(
               index, index + Eigen::Array2i(width - 1, width - 1))) {
        best = std::max(best, grid.GetProbability(inner));
      }
      ASSERT_NEAR(wide.ToScore(wide.GetValue(index)), best,
                  0.5 * 0.8 / 255. + 1e-5)
          << "width " << width << " at " << index.transpose();
    }
  }
}

TEST(PrecomputationGridTest, TinyAndUnknownGrids) {
  ValueConversionTables tables;
  const ProbabilityGrid grid(
      MapLimits(0.05, Eigen::Vector2d(0., 0.), CellLimits(1, 1)), &tables);
  const PrecomputationGrid2D wide(grid, CellLimits(1, 1), 8, nullptr);
  EXPECT_EQ(wide.GetValue({0, 0}), 0);
  EXPECT_EQ(wide.GetValue({-7, -7}), 0);
  EXPECT_NEAR(wide.ToScore(0.f), kMinProbability, 1e-6);
  EXPECT_NEAR(wide.ToScore(255.f), kMaxProbability, 1e-6);
}

TEST(PrecomputationGridTest, DistancesCountFromTheSurface) {
  ValueConversionTables tables;
  const CellLimits size(2, 1);
  TSDF2D tsdf(MapLimits(0.05, Eigen::Vector2d(0., 0.), size), 0.3f, 10.f,
              &tables);
  tsdf.SetCell({0, 0}, -0.1f, 1.f);
  tsdf.FinishUpdate();
  const PrecomputationGrid2D grid(tsdf, size, 1, nullptr);
  EXPECT_NEAR(grid.ToScore(grid.GetValue({0, 0})), 0.9, 2e-3);
  EXPECT_NEAR(grid.ToScore(grid.GetValue({1, 0})), 0.7, 2e-3);
}

class FastCorrelativeScanMatcherTest : public ::testing::Test {
 protected:
  FastCorrelativeScanMatcherTest()
      : grid_(test::RoomGrid(&tables_, 0.05, 5)), room_(test::Room()) {}

  ValueConversionTables tables_;
  std::unique_ptr<ProbabilityGrid> grid_;
  sensor::PointCloud room_;
};

TEST_F(FastCorrelativeScanMatcherTest, FindsKnownPoses) {
  cartographer_ext::Random random(3);
  const FastCorrelativeScanMatcher2D matcher(*grid_, Options(1.5, 0.6, 4));
  for (int i = 0; i != 20; ++i) {
    const transform::Rigid2d expected(
        {random.Uniform(-1., 1.), random.Uniform(-1., 1.)},
        random.Uniform(-0.5, 0.5));
    const sensor::PointCloud seen = test::Moved(room_, expected.inverse());
    float score = 0.f;
    transform::Rigid2d pose;
    ASSERT_TRUE(matcher.Match(transform::Rigid2d::Identity(), seen, 0.3f,
                              &score, &pose));
    EXPECT_GT(score, 0.6f);
    EXPECT_NEAR((pose.translation() - expected.translation()).norm(), 0., 0.06);
    EXPECT_NEAR((pose.inverse() * expected).normalized_angle(), 0., 0.03);
  }
}

TEST_F(FastCorrelativeScanMatcherTest, FindsPosesInTheFullSubmap) {
  const FastCorrelativeScanMatcher2D matcher(*grid_, Options(0.1, 0.1, 6));
  const transform::Rigid2d expected({1.3, 0.6}, 2.8);
  const sensor::PointCloud seen = test::Moved(room_, expected.inverse());
  float score = 0.f;
  transform::Rigid2d pose;
  EXPECT_FALSE(
      matcher.Match(transform::Rigid2d::Identity(), seen, 0.6f, &score, &pose));
  EXPECT_EQ(score, 0.f);
  ASSERT_TRUE(matcher.MatchFullSubmap(seen, 0.6f, &score, &pose));
  EXPECT_NEAR((pose.translation() - expected.translation()).norm(), 0., 0.06);
  EXPECT_NEAR((pose.inverse() * expected).normalized_angle(), 0., 0.03);
}

// Branch and bound must not miss what trying everything finds; any depth, also
// with more points than 16-bit sums hold and points outside the grid.
TEST_F(FastCorrelativeScanMatcherTest, AgreesWithExhaustiveSearch) {
  sensor::PointCloud cloud =
      test::Moved(room_, transform::Rigid2d({0.4, -0.2}, 0.15));
  ASSERT_GT(cloud.size(), 257u);
  cloud.push_back({Eigen::Vector3f(6.f, 6.f, 0.f)});
  const transform::Rigid2d initial({0.05, 0.1}, -0.2);
  const double linear = 0.35;
  const double angular = 0.12;

  const sensor::PointCloud rotated = RotateCloud(cloud, initial);
  const SearchParameters parameters(linear, angular, cloud, 0.05);
  const Eigen::Vector2f translation = initial.translation().cast<float>();
  const auto scans = DiscretizeScans(grid_->limits(),
                                     GenerateRotatedScans(rotated, parameters),
                                     Eigen::Translation2f(translation));
  const PrecomputationGrid2D values(*grid_, grid_->limits().cell_limits(), 1,
                                    nullptr);
  int best = 0;
  for (const DiscreteScan2D& scan : scans) {
    for (const Eigen::Array2i& offset :
         XYIndexRangeIterator(Eigen::Array2i(-7, -7), Eigen::Array2i(7, 7))) {
      int sum = 0;
      for (const Eigen::Array2i& cell : scan) {
        sum += values.GetValue(cell + offset);
      }
      best = std::max(best, sum);
    }
  }
  const float expected =
      values.ToScore(best / static_cast<float>(cloud.size()));
  for (const int depth : {1, 2, 3, 5, 7}) {
    const FastCorrelativeScanMatcher2D matcher(*grid_,
                                               Options(linear, angular, depth));
    float score = 0.f;
    transform::Rigid2d pose;
    ASSERT_TRUE(matcher.Match(initial, cloud, 0.1f, &score, &pose)) << depth;
    EXPECT_EQ(score, expected) << depth;
    // Only strictly better ones count.
    EXPECT_FALSE(matcher.Match(initial, cloud, expected, &score, &pose));
  }
}

TEST_F(FastCorrelativeScanMatcherTest, DegenerateInput) {
  const FastCorrelativeScanMatcher2D matcher(*grid_, Options(0.5, 0.1, 3));
  float score = 7.f;
  transform::Rigid2d pose;
  EXPECT_FALSE(
      matcher.Match(transform::Rigid2d::Identity(), {}, 0.f, &score, &pose));
  EXPECT_EQ(score, 7.f);
  // A map without content still scores 0.1, which beats 0.
  const ProbabilityGrid unknown(
      MapLimits(0.05, Eigen::Vector2d(1., 1.), CellLimits(100, 100)), &tables_);
  const FastCorrelativeScanMatcher2D blind(unknown, Options(0.5, 0.1, 3));
  const sensor::PointCloud point = test::Cloud({{0.1f, 0.2f}});
  ASSERT_TRUE(
      blind.Match(transform::Rigid2d::Identity(), point, 0.f, &score, &pose));
  EXPECT_NEAR(score, 0.1f, 1e-6);
  ASSERT_TRUE(blind.MatchFullSubmap(point, 0.f, &score, &pose));
  EXPECT_NEAR(score, 0.1f, 1e-6);
}

}  // namespace
}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
