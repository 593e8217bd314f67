// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/real_time_correlative_scan_matcher_2d.h"

#include <algorithm>
#include <cmath>

#include "cartographer/mapping/internal/2d/scan_matching/rotated_cell_indices.h"
#include "cartographer/mapping/internal/2d/tsdf_2d.h"
#include "cartographer/mapping/internal/scan_matching/real_time_correlative_scan_matcher.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

proto::RealTimeCorrelativeScanMatcherOptions Options(const double linear,
                                                     const double angular,
                                                     const double weight) {
  proto::RealTimeCorrelativeScanMatcherOptions options;
  options.set_linear_search_window(linear);
  options.set_angular_search_window(angular);
  options.set_translation_delta_cost_weight(weight);
  options.set_rotation_delta_cost_weight(weight);
  return options;
}

TEST(RealTimeCorrelativeOptionsTest, ReadsEachKeyOnce) {
  const auto lua = test::Lua(
      "return { linear_search_window = 0.1, angular_search_window = 0.3,"
      " translation_delta_cost_weight = 1., rotation_delta_cost_weight = 2. }");
  const auto options = CreateRealTimeCorrelativeScanMatcherOptions(lua.get());
  EXPECT_EQ(options.linear_search_window(), 0.1);
  EXPECT_EQ(options.angular_search_window(), 0.3);
  EXPECT_EQ(options.translation_delta_cost_weight(), 1.);
  EXPECT_EQ(options.rotation_delta_cost_weight(), 2.);
}

class RealTimeCorrelativeScanMatcherTest : public ::testing::Test {
 protected:
  RealTimeCorrelativeScanMatcherTest()
      : grid_(test::RoomGrid(&tables_, 0.05, 3)), room_(test::Room()) {}

  // What the documentation of ScoreCandidates promises, candidate by candidate.
  Candidate2D BestOfAll(const RealTimeCorrelativeScanMatcher2D& matcher,
                        const transform::Rigid2d& initial,
                        const SearchParameters& parameters,
                        const sensor::PointCloud& rotated) {
    const Eigen::Vector2f translation = initial.translation().cast<float>();
    const auto scans = DiscretizeScans(
        grid_->limits(), GenerateRotatedScans(rotated, parameters),
        Eigen::Translation2f(translation));
    std::vector<Candidate2D> candidates;
    for (int scan = 0; scan != parameters.num_scans; ++scan) {
      const auto& bounds = parameters.linear_bounds[scan];
      for (int x = bounds.min_x; x <= bounds.max_x; ++x) {
        for (int y = bounds.min_y; y <= bounds.max_y; ++y) {
          candidates.emplace_back(scan, x, y, parameters);
        }
      }
    }
    matcher.ScoreCandidates(*grid_, scans, parameters, &candidates);
    return *std::max_element(candidates.begin(), candidates.end());
  }

  ValueConversionTables tables_;
  std::unique_ptr<ProbabilityGrid> grid_;
  sensor::PointCloud room_;
};

TEST_F(RealTimeCorrelativeScanMatcherTest, ScoresTheMeanProbability) {
  const RealTimeCorrelativeScanMatcher2D matcher(Options(0.6, 0.16, 0.));
  const SearchParameters parameters(12, 5, 0.03, 0.05);
  const Eigen::Array2i known = grid_->limits().GetCellIndex({1.7f, -0.5f});
  std::vector<Candidate2D> candidates = {Candidate2D(0, 0, 0, parameters),
                                         Candidate2D(0, 1, 2, parameters)};
  matcher.ScoreCandidates(*grid_, {{known, known + Eigen::Array2i(-1, -2)}},
                          parameters, &candidates);
  EXPECT_NEAR(candidates[0].score,
              0.5 * (grid_->GetProbability(known) +
                     grid_->GetProbability(known + Eigen::Array2i(-1, -2))),
              1e-6);
  EXPECT_NEAR(candidates[1].score,
              0.5 * (grid_->GetProbability(known + Eigen::Array2i(1, 2)) +
                     grid_->GetProbability(known)),
              1e-6);
}

TEST_F(RealTimeCorrelativeScanMatcherTest, DistanceCosts) {
  auto options = Options(0.6, 0.16, 0.);
  options.set_translation_delta_cost_weight(2.);
  options.set_rotation_delta_cost_weight(3.);
  const RealTimeCorrelativeScanMatcher2D matcher(options);
  const SearchParameters parameters(12, 5, 0.03, 0.05);
  // Outside the grid everything is as unlikely as can be.
  const DiscreteScan2D scan = {Eigen::Array2i(-1000, -1000)};
  std::vector<Candidate2D> candidates = {Candidate2D(5, 0, 0, parameters),
                                         Candidate2D(4, 3, 4, parameters)};
  matcher.ScoreCandidates(*grid_, std::vector<DiscreteScan2D>(11, scan),
                          parameters, &candidates);
  EXPECT_NEAR(candidates[0].score, 0.1, 1e-6);
  // 5 cells of 5 cm and one step of 0.03 rad.
  const double delta = 2. * 0.25 + 3. * 0.03;
  EXPECT_NEAR(candidates[1].score, 0.1 * std::exp(-delta * delta), 1e-6);
}

TEST_F(RealTimeCorrelativeScanMatcherTest, SameAsTryingEachCandidate) {
  cartographer_ext::Random random(5);
  for (const double weight : {0., 0.1, 3.}) {
    for (const double linear : {0., 0.1, 0.33}) {
      const RealTimeCorrelativeScanMatcher2D matcher(
          Options(linear, 0.2, weight));
      const transform::Rigid2d initial(
          {random.Uniform(-0.2, 0.2), random.Uniform(-0.2, 0.2)},
          random.Uniform(-0.1, 0.1));
      const sensor::PointCloud rotated = RotateCloud(room_, initial);
      const SearchParameters parameters(linear, 0.2, rotated, 0.05);
      const Candidate2D expected =
          BestOfAll(matcher, initial, parameters, rotated);
      transform::Rigid2d pose;
      const double score = matcher.Match(initial, room_, *grid_, &pose);
      EXPECT_EQ(score, expected.score);
      EXPECT_EQ(pose.translation().x(), initial.translation().x() + expected.x);
      EXPECT_EQ(pose.translation().y(), initial.translation().y() + expected.y);
      EXPECT_NEAR((initial.inverse() * pose).normalized_angle(),
                  expected.orientation, 1e-12);
    }
  }
}

TEST_F(RealTimeCorrelativeScanMatcherTest, FindsKnownPoses) {
  const RealTimeCorrelativeScanMatcher2D matcher(Options(0.3, 0.3, 0.1));
  const transform::Rigid2d expected({0.21, -0.13}, 0.11);
  const sensor::PointCloud seen = test::Moved(room_, expected.inverse());
  transform::Rigid2d pose;
  EXPECT_GT(matcher.Match(transform::Rigid2d::Identity(), seen, *grid_, &pose),
            0.5);
  EXPECT_NEAR((pose.translation() - expected.translation()).norm(), 0., 0.05);
  EXPECT_NEAR((pose.inverse() * expected).normalized_angle(), 0., 0.02);
}

TEST_F(RealTimeCorrelativeScanMatcherTest, OutsideTheGridTheFirstBestIsKept) {
  const RealTimeCorrelativeScanMatcher2D matcher(Options(0.1, 0.1, 1.));
  const transform::Rigid2d initial({500., 500.}, 1.);
  transform::Rigid2d pose;
  // Only the factor for the difference decides.
  EXPECT_NEAR(matcher.Match(initial, room_, *grid_, &pose), 0.1, 1e-5);
  EXPECT_NEAR((pose.translation() - initial.translation()).norm(), 0., 1e-9);
  EXPECT_NEAR(matcher.Match(initial, {}, *grid_, &pose), 0., 0.);
  EXPECT_EQ(pose.translation(), initial.translation());
}

TEST(RealTimeCorrelativeTSDFTest, FindsTheSurface) {
  ValueConversionTables tables;
  const CellLimits size(80, 80);
  TSDF2D tsdf(MapLimits(0.05, Eigen::Vector2d(2., 2.), size), 0.3f, 10.f,
              &tables);
  // Walls at x = 1 and y = -0.5.
  for (const Eigen::Array2i& index : XYIndexRangeIterator(size)) {
    const Eigen::Vector2f center = tsdf.limits().GetCellCenter(index);
    tsdf.SetCell(index, std::min(1.f - center.x(), center.y() + 0.5f), 5.f);
  }
  tsdf.FinishUpdate();
  sensor::PointCloud corner;
  for (int i = 0; i != 20; ++i) {
    corner.push_back({Eigen::Vector3f(1.f, -0.45f + 0.05f * i, 0.f)});
    corner.push_back({Eigen::Vector3f(0.95f - 0.05f * i, -0.5f, 0.f)});
  }
  const RealTimeCorrelativeScanMatcher2D matcher(Options(0.2, 0.1, 0.1));
  const transform::Rigid2d expected({0.1, -0.15}, 0.);
  transform::Rigid2d pose;
  EXPECT_GT(matcher.Match(transform::Rigid2d::Identity(),
                          test::Moved(corner, expected.inverse()), tsdf, &pose),
            0.85);
  EXPECT_NEAR((pose.translation() - expected.translation()).norm(), 0., 0.06);
}

}  // namespace
}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
