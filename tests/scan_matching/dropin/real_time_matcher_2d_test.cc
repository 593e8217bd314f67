// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Ours against the host's matcher: the same to the last bit.
#include "cartographer_ext/scan_matching/dropin/real_time_matcher_2d.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "gtest/gtest.h"
#include "tests/scan_matching/dropin/random_worlds.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

namespace mapping = cartographer::mapping;
using cartographer::sensor::PointCloud;
using cartographer::transform::Rigid2d;
using mapping::Grid2D;
using mapping::scan_matching::RealTimeCorrelativeScanMatcher2D;
using Options =
    mapping::scan_matching::proto::RealTimeCorrelativeScanMatcherOptions;

Options MakeOptions(const double linear, const double angular,
                    const double translation_weight,
                    const double rotation_weight) {
  Options options;
  options.set_linear_search_window(linear);
  options.set_angular_search_window(angular);
  options.set_translation_delta_cost_weight(translation_weight);
  options.set_rotation_delta_cost_weight(rotation_weight);
  return options;
}

class RealTimeMatcherTest
    : public ::testing::TestWithParam<const SearchKernels*> {
 protected:
  void Compare(const Options& options, const Grid2D& grid,
               const Rigid2d& initial, const PointCloud& cloud) {
    Rigid2d expected({7., 7.}, 7.);
    const double expected_score =
        RealTimeCorrelativeScanMatcher2D(options).Match(initial, cloud, grid,
                                                        &expected);
    Rigid2d pose({8., 8.}, 8.);
    const double score = RealTimeMatcher2D(options, GetParam())
                             .Match(initial, cloud, grid, &pose);
    EXPECT_EQ(score, expected_score);
    EXPECT_EQ(pose.translation().x(), expected.translation().x());
    EXPECT_EQ(pose.translation().y(), expected.translation().y());
    EXPECT_EQ(pose.rotation().angle(), expected.rotation().angle());
  }

  mapping::ValueConversionTables tables_;
  Random random_{13};
};

TEST_P(RealTimeMatcherTest, RandomWorlds) {
  for (int i = 0; i != 200; ++i) {
    SCOPED_TRACE(i);
    const auto grid = i % 10 == 9 ? test::RandomTsdf(&tables_, &random_)
                                  : test::RandomGrid(&tables_, &random_);
    const Eigen::Vector2d middle =
        grid->limits()
            .GetCellCenter({grid->limits().cell_limits().num_x_cells / 2,
                            grid->limits().cell_limits().num_y_cells / 2})
            .cast<double>();
    const Rigid2d truth(middle + Eigen::Vector2d(random_.Uniform(-1., 1.),
                                                 random_.Uniform(-1., 1.)),
                        random_.Uniform(-kPi, kPi));
    const PointCloud cloud = test::RandomCloud(
        *grid, truth,
        static_cast<int>(i % 10 == 0 ? random_.UniformInt(258, 600)
                                     : random_.UniformInt(1, 90)),
        &random_);
    const Rigid2d initial = truth * Rigid2d({random_.Uniform(-0.2, 0.2),
                                             random_.Uniform(-0.2, 0.2)},
                                            random_.Uniform(-0.2, 0.2));
    // Windows of less and more than a block of offsets.
    const Options options = MakeOptions(
        random_.Uniform(0., i % 4 == 0 ? 0.7 : 0.2), random_.Uniform(0., 0.4),
        i % 3 == 0 ? 0. : random_.Uniform(0., 10.),
        i % 5 == 0 ? 0. : random_.Uniform(0., 10.));
    Compare(options, *grid, initial, cloud);
  }
}

// Many poses score the same; the first in order wins.
TEST_P(RealTimeMatcherTest, Ties) {
  for (int i = 0; i != 40; ++i) {
    SCOPED_TRACE(i);
    mapping::ProbabilityGrid grid(
        mapping::MapLimits(0.05, Eigen::Vector2d(1., 1.),
                           mapping::CellLimits(50, 40)),
        &tables_);
    for (int k = 0; k != i / 4; ++k) {
      const Eigen::Array2i cell(static_cast<int>(random_.UniformInt(0, 49)),
                                static_cast<int>(random_.UniformInt(0, 39)));
      if (!grid.IsKnown(cell)) grid.SetProbability(cell, 0.8f);
    }
    const PointCloud cloud =
        test::RandomCloud(grid, Rigid2d({0., 0.}, 0.3),
                          static_cast<int>(random_.UniformInt(1, 3)), &random_);
    Compare(MakeOptions(0.3, 0.1, i % 2, 0.), grid, Rigid2d({0.1, -0.2}, 0.3),
            cloud);
  }
}

TEST_P(RealTimeMatcherTest, OutsideTheGridAndEmpty) {
  const auto grid = test::RandomGrid(&tables_, &random_);
  const Options options = MakeOptions(0.1, 0.3, 0.1, 0.1);
  const PointCloud cloud =
      test::RandomCloud(*grid, Rigid2d::Identity(), 20, &random_);
  Compare(options, *grid, Rigid2d({2000., -3000.}, 1.), cloud);
  Rigid2d pose;
  EXPECT_EQ(RealTimeMatcher2D(options, GetParam())
                .Match(Rigid2d({1., 2.}, 3.), {}, *grid, &pose),
            0.);
  EXPECT_EQ(pose.translation().x(), 1.);
  EXPECT_EQ(pose.rotation().angle(), 3.);
}

INSTANTIATE_TEST_SUITE_P(
    Sets, RealTimeMatcherTest, ::testing::ValuesIn(AllSearchKernels()),
    [](const ::testing::TestParamInfo<const SearchKernels*>& info) {
      return std::string(info.param->name);
    });

TEST(RealTimeSearchTest, ScoresFewPosesAndRefusesBadInput) {
  mapping::ValueConversionTables tables;
  Random random(3);
  const auto grid = test::RandomGrid(&tables, &random);
  const ProbabilityGridView view(
      static_cast<const mapping::ProbabilityGrid&>(*grid));
  const Rigid2d truth(grid->limits().GetCellCenter({9, 9}).cast<double>(), 0.2);
  const PlanarCloud cloud =
      ToPlanarCloud(test::RandomCloud(*grid, truth, 80, &random));
  RealTimeSearchOptions options;
  const Pose2 initial = ToUnwrappedPose2(truth);
  const RealTimeSearchResult result =
      SearchInRealTime(options, view, initial, cloud);
  EXPECT_TRUE(result.complete);
  EXPECT_GT(result.poses_scored, 0);
  EXPECT_LT(result.poses_scored, result.poses_in_window);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(
      SearchInRealTime(options, view, Pose2(nan, 0., 0.), cloud).complete);
  options.window.linear = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(SearchInRealTime(options, view, initial, cloud).complete);
  PlanarCloud uneven = cloud;
  uneven.y.pop_back();
  EXPECT_EQ(SearchInRealTime(RealTimeSearchOptions(), view, initial, uneven)
                .poses_scored,
            0);
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
