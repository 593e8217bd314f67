// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/pair_searcher.h"

#include <memory>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/2d/probability_grid_range_data_inserter_2d.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/dropin/verified_constraint_builder_room.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

namespace host = cartographer::mapping;

constexpr double kBay = 3.6;  // metres

// Equal bays between shelves along a wall, at x = 0, 3.6 and so on, as seen from
// the middle of bay 0.
class PairSearcherTest : public testing::Test {
 protected:
  PairSearcherTest() { options_.slide_test = false; }

  static cartographer::sensor::PointCloud Bay(const int number) {
    cartographer::sensor::PointCloud cloud;
    const auto add = [&](const double x, const double y) {
      cloud.push_back({Eigen::Vector3f(static_cast<float>(x + kBay * number),
                                       static_cast<float>(y), 0.f)});
    };
    for (double x = -1.4; x < 1.4; x += 0.04) add(x, 2.);
    for (double y = 1.; y < 2.; y += 0.04) {
      add(-1.4, y);
      add(1.4, y);
    }
    return cloud;
  }

  // Bay 0 was seen `times_0` times, bay 1 `times_1` times.
  void MakeSubmap(const int times_0, const int times_1) {
    auto grid = absl::make_unique<host::ProbabilityGrid>(
        host::MapLimits(0.05, Eigen::Vector2d(6., 6.),
                        host::CellLimits(240, 240)),
        &tables_);
    const host::ProbabilityGridRangeDataInserter2D inserter(
        host::test::InserterOptions(.6, .45));
    for (const int bay : {0, 1}) {
      for (int i = 0; i != (bay == 0 ? times_0 : times_1); ++i) {
        inserter.Insert(
            {Eigen::Vector3f(static_cast<float>(kBay * bay), 0.f, 0.f),
             Bay(bay),
             {}},
            grid.get());
      }
    }
    submap_ = absl::make_unique<host::Submap2D>(Eigen::Vector2f::Zero(),
                                                std::move(grid), &tables_);
    submap_->Finish();
  }

  // Where the scan of bay 0 is found; predicted there with this standard
  // deviation.
  double Search(const double sigma) {
    const auto stock = test::StockOptions();
    SubmapCache cache(stock.fast_correlative_scan_matcher_options(),
                      options_.temporal.comparison, size_t{1} << 26);
    const PairSearcher searcher(stock, options_, &cache);
    node_.filtered_gravity_aligned_point_cloud = Bay(0);
    SearchJob job;
    job.node = &node_;
    job.entry = std::make_shared<SubmapEntry>();
    job.entry->submap = submap_.get();
    job.entry->cached = absl::make_unique<CachedSubmap>(0, submap_.get());
    job.candidate.predicted = Pose2();
    SetWindow(options_.search,
              Eigen::Vector3d(sigma * sigma, sigma * sigma, 1e-3).asDiagonal(),
              &job.candidate.plan);
    job.candidate.plan.linear_window = 5.;
    searcher.Search(&job);
    EXPECT_TRUE(job.candidate.match.found);
    EXPECT_LT(job.candidate.match.refined.translation().y(), 0.1);
    return job.candidate.match.refined.x;
  }

  LoopOptions options_;
  host::ValueConversionTables tables_;
  std::unique_ptr<host::Submap2D> submap_;
  host::TrajectoryNode::Data node_;
};

TEST_F(PairSearcherTest, OfEqualPlacesTheExpectedOneIsTaken) {
  MakeSubmap(5, 6);
  EXPECT_NEAR(Search(0.8), 0., 0.1);
  // Where the prediction says nothing the score decides.
  EXPECT_NEAR(Search(5.), kBay, 0.1);
}

TEST_F(PairSearcherTest, AMuchBetterPlaceIsTakenWhereverItIs) {
  MakeSubmap(2, 6);
  EXPECT_NEAR(Search(0.8), kBay, 0.1);
}

TEST_F(PairSearcherTest, TheSearchOfStockTakesTheBestScore) {
  options_.search.enabled = false;
  MakeSubmap(5, 6);
  EXPECT_NEAR(Search(0.8), kBay, 0.1);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
