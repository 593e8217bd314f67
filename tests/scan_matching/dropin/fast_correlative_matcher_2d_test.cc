// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Ours against the host's matcher: the same to the last bit. Of poses with
// equal scores the bundled host takes the first in the order of the search, as
// ours does; a real tree sorts with std::sort and may take another one.
#include "cartographer_ext/scan_matching/dropin/fast_correlative_matcher_2d.h"

#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"
#include "tests/scan_matching/dropin/random_worlds.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

namespace mapping = cartographer::mapping;
using cartographer::sensor::PointCloud;
using cartographer::transform::Rigid2d;
using mapping::CellLimits;
using mapping::Grid2D;
using mapping::MapLimits;
using mapping::ProbabilityGrid;
using mapping::scan_matching::FastCorrelativeScanMatcher2D;
using test::kResolution;
using test::RandomCloud;
using test::RandomGrid;
using test::RandomTsdf;
using Options =
    mapping::scan_matching::proto::FastCorrelativeScanMatcherOptions2D;

Options MakeOptions(const double linear, const double angular,
                    const int depth) {
  Options options;
  options.set_linear_search_window(linear);
  options.set_angular_search_window(angular);
  options.set_branch_and_bound_depth(depth);
  return options;
}

struct Found {
  bool found = false;
  float score = -1.f;
  Rigid2d pose = Rigid2d({7., 7.}, 7.);
};

template <typename Matcher>
Found Search(const Matcher& matcher, const bool full, const Rigid2d& initial,
             const PointCloud& cloud, const float min_score) {
  Found found;
  found.found =
      full
          ? matcher.MatchFullSubmap(cloud, min_score, &found.score, &found.pose)
          : matcher.Match(initial, cloud, min_score, &found.score, &found.pose);
  return found;
}

void ExpectSame(const Found& ours, const Found& stock) {
  EXPECT_EQ(ours.found, stock.found);
  EXPECT_EQ(ours.score, stock.score);
  EXPECT_EQ(ours.pose.translation().x(), stock.pose.translation().x());
  EXPECT_EQ(ours.pose.translation().y(), stock.pose.translation().y());
  EXPECT_EQ(ours.pose.rotation().angle(), stock.pose.rotation().angle());
}

#ifdef CARTOGRAPHER_EXT_TIES_DEPEND_ON_SORTING
// Whether the pose has the score, by the host's account. Points on the border
// of two cells fall into one or the other by the rounding of the search, which
// a search of this pose alone does not repeat: it may be moved a little.
bool HasScore(const Grid2D& grid, const PointCloud& cloud, const Rigid2d& pose,
              const float score) {
  const FastCorrelativeScanMatcher2D host(grid, MakeOptions(0., 0., 1));
  for (const double x : {0., -1e-5, 1e-5}) {
    for (const double y : {0., -1e-5, 1e-5}) {
      const Rigid2d moved(pose.translation() + Eigen::Vector2d(x, y),
                          pose.rotation());
      if (Search(host, false, moved, cloud, -1.f).score == score) return true;
    }
  }
  return false;
}

// Both poses are best ones.
void ExpectSameUpToTies(const Grid2D& grid, const PointCloud& cloud,
                        const Found& ours, const Found& stock) {
  ASSERT_EQ(ours.found, stock.found);
  EXPECT_EQ(ours.score, stock.score);
  if (!ours.found) return;
  EXPECT_TRUE(HasScore(grid, cloud, ours.pose, stock.score));
  EXPECT_TRUE(HasScore(grid, cloud, stock.pose, stock.score));
}
#else
void ExpectSameUpToTies(const Grid2D& /*grid*/, const PointCloud& /*cloud*/,
                        const Found& ours, const Found& stock) {
  ExpectSame(ours, stock);
}
#endif

class FastCorrelativeMatcherTest
    : public ::testing::TestWithParam<const SearchKernels*> {
 protected:
  void Compare(const Grid2D& grid, const Options& options, const bool full,
               const Rigid2d& initial, const PointCloud& cloud,
               const float min_score) {
    const FastCorrelativeScanMatcher2D stock(grid, options);
    FastCorrelativeSearchOptions ours_options = ToSearchOptions(options);
    ours_options.kernels = GetParam();
    const FastCorrelativeMatcher2D ours(grid, ours_options);
    const Found expected = Search(stock, full, initial, cloud, min_score);
    ExpectSameUpToTies(grid, cloud,
                       Search(ours, full, initial, cloud, min_score), expected);
    if (!expected.found) return;
    ++num_found_;
    // Only more than the minimum counts, and just less is enough.
    EXPECT_FALSE(Search(ours, full, initial, cloud, expected.score).found);
    const float less = std::nextafter(expected.score, 0.f);
    ExpectSameUpToTies(grid, cloud, Search(ours, full, initial, cloud, less),
                       expected);
  }

  mapping::ValueConversionTables tables_;
  Random random_{11};
  int num_found_ = 0;
};

TEST_P(FastCorrelativeMatcherTest, RandomWorlds) {
  for (int i = 0; i != 250; ++i) {
    SCOPED_TRACE(i);
    const auto grid = i % 5 == 4 ? RandomTsdf(&tables_, &random_)
                                 : RandomGrid(&tables_, &random_);
    const Eigen::Vector2d middle =
        grid->limits()
            .GetCellCenter({grid->limits().cell_limits().num_x_cells / 2,
                            grid->limits().cell_limits().num_y_cells / 2})
            .cast<double>();
    const Rigid2d truth(middle + Eigen::Vector2d(random_.Uniform(-1., 1.),
                                                 random_.Uniform(-1., 1.)),
                        random_.Uniform(-kPi, kPi));
    // More than 257 points sometimes: sums need more than 16 bits then.
    const int num_points = static_cast<int>(
        i % 10 == 0 ? random_.UniformInt(258, 600) : random_.UniformInt(1, 90));
    const PointCloud cloud = RandomCloud(*grid, truth, num_points, &random_);
    const Rigid2d initial = truth * Rigid2d({random_.Uniform(-0.8, 0.8),
                                             random_.Uniform(-0.8, 0.8)},
                                            random_.Uniform(-0.2, 0.2));
    const Options options =
        MakeOptions(random_.Uniform(0., 1.2), random_.Uniform(0., 0.3),
                    static_cast<int>(random_.UniformInt(1, 8)));
    Compare(*grid, options, false, initial, cloud,
            static_cast<float>(random_.Uniform(0., 0.7)));
  }
  EXPECT_GT(num_found_, 100);
}

TEST_P(FastCorrelativeMatcherTest, FullSubmaps) {
  for (int i = 0; i != 25; ++i) {
    SCOPED_TRACE(i);
    const auto grid = RandomGrid(&tables_, &random_);
    const Rigid2d truth(grid->limits().GetCellCenter({9, 9}).cast<double>(),
                        random_.Uniform(-kPi, kPi));
    const PointCloud cloud = RandomCloud(
        *grid, truth, static_cast<int>(random_.UniformInt(1, 60)), &random_);
    Compare(*grid, MakeOptions(0.1, 0.1, 6), true, Rigid2d::Identity(), cloud,
            static_cast<float>(random_.Uniform(0.2, 0.7)));
  }
  EXPECT_GT(num_found_, 5);
}

// Nearly all poses score the same; the order of the stock search decides.
TEST_P(FastCorrelativeMatcherTest, Ties) {
  const CellLimits size(50, 40);
  for (int i = 0; i != 60; ++i) {
    SCOPED_TRACE(i);
    ProbabilityGrid grid(MapLimits(kResolution, Eigen::Vector2d(1., 1.), size),
                         &tables_);
    for (int k = 0; k != i / 4; ++k) {
      const Eigen::Array2i cell(static_cast<int>(random_.UniformInt(0, 49)),
                                static_cast<int>(random_.UniformInt(0, 39)));
      if (!grid.IsKnown(cell)) grid.SetProbability(cell, 0.9f);
    }
    const PointCloud cloud =
        RandomCloud(grid, Rigid2d({0., 0.}, 0.3),
                    static_cast<int>(random_.UniformInt(1, 3)), &random_);
    // The stock search of all poses without coarse levels takes long.
    const bool full = i % 3 == 0;
    const Options options =
        MakeOptions(random_.Uniform(0.1, 1.5), 0.1,
                    static_cast<int>(random_.UniformInt(full ? 4 : 1, 7)));
    Compare(grid, options, full, Rigid2d({0.1, -0.2}, 0.3), cloud,
            i % 2 ? 0.f : 0.3f);
  }
  EXPECT_GT(num_found_, 30);
}

TEST_P(FastCorrelativeMatcherTest, FarFromEverything) {
  const auto grid = RandomGrid(&tables_, &random_);
  const PointCloud cloud =
      RandomCloud(*grid, Rigid2d::Identity(), 20, &random_);
  const Rigid2d initial({1000., -1000.}, 1.);
  for (const float min_score : {0.f, 0.05f, 0.1f, 0.5f}) {
    Compare(*grid, MakeOptions(1., 0.2, 4), false, initial, cloud, min_score);
  }
}

TEST_P(FastCorrelativeMatcherTest, NothingIsWrittenWithoutAMatch) {
  const auto grid = RandomGrid(&tables_, &random_);
  const FastCorrelativeMatcher2D ours(*grid, MakeOptions(1., 0.2, 4));
  EXPECT_LT(Search(ours, false, Rigid2d::Identity(), {}, 0.f).score, 0.f);
  EXPECT_LT(Search(ours, true, Rigid2d::Identity(), {}, 0.f).score, 0.f);
  const PointCloud cloud =
      RandomCloud(*grid, Rigid2d::Identity(), 20, &random_);
  const Found found = Search(ours, false, Rigid2d::Identity(), cloud, 1.f);
  EXPECT_FALSE(found.found);
  EXPECT_EQ(found.score, -1.f);
  EXPECT_EQ(found.pose.rotation().angle(), 7.);
}

INSTANTIATE_TEST_SUITE_P(
    Sets, FastCorrelativeMatcherTest, ::testing::ValuesIn(AllSearchKernels()),
    [](const ::testing::TestParamInfo<const SearchKernels*>& info) {
      return std::string(info.param->name);
    });

TEST(FastCorrelativeMatcherThreadsTest, ManyThreadsUseOneMatcher) {
  mapping::ValueConversionTables tables;
  Random random(5);
  const auto grid = RandomGrid(&tables, &random);
  const Rigid2d truth(grid->limits().GetCellCenter({9, 9}).cast<double>(), 0.2);
  const PointCloud cloud = RandomCloud(*grid, truth, 50, &random);
  const FastCorrelativeMatcher2D matcher(*grid, MakeOptions(1., 0.3, 5));
  const Found expected = Search(matcher, false, truth, cloud, 0.2f);
  std::vector<Found> found(16);
  std::vector<std::thread> threads;
  for (int i = 0; i != 4; ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k != 4; ++k) {
        found[4 * i + k] = Search(matcher, false, truth, cloud, 0.2f);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const Found& one : found) ExpectSame(one, expected);
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
