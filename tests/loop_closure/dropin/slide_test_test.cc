// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/slide_test.h"

#include <cmath>
#include <limits>

#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::CellLimits;
using cartographer::mapping::MapLimits;
using cartographer::mapping::ProbabilityGrid;
using cartographer::sensor::PointCloud;

// A wall of p = 0.8 along y = 3 and free space of p = 0.2 on its near side.
class SlideTestTest : public testing::Test {
 protected:
  SlideTestTest()
      : grid_(MapLimits(0.05, Eigen::Vector2d(8., 8.), CellLimits(160, 160)),
              &tables_) {
    for (double x = 0.025; x < 8.; x += 0.05) {
      for (double y = 1.025; y < 3.; y += 0.05) Set(x, y, 0.2f);
    }
    // Along x nothing is known of the pose, across it and of its angle much is.
    information_ = Eigen::Vector3d(0., 1e4, 1e4).asDiagonal();
  }

  void Set(const double x, const double y, const float probability) {
    grid_.SetProbability(grid_.limits().GetCellIndex(Eigen::Vector2f(x, y)),
                         probability);
  }

  // With a door between two places, none where they are outside.
  void MakeWall(const double from, const double to) {
    for (double x = 0.025; x < 8.; x += 0.05) {
      Set(x, 3.025, x > from && x < to ? 0.2f : 0.8f);
    }
    if (to > 8.) return;
    for (double y = 3.075; y < 3.5; y += 0.05) {
      Set(from - 0.025, y, 0.8f);
      Set(to + 0.025, y, 0.8f);
    }
  }

  // What a laser at the pose sees of the wall, from x = 3 to 5.
  PointCloud Scan(const double door_from, const double door_to) const {
    PointCloud cloud;
    for (double x = 3.0125; x < 5.; x += 0.025) {
      if (x > door_from && x < door_to) continue;
      cloud.push_back({Eigen::Vector3f(x - pose_.x, 3.025 - pose_.y, 0.f)});
    }
    if (door_from < door_to) {
      for (double y = 3.0125; y < 3.5; y += 0.025) {
        for (const double x : {door_from - 0.025, door_to + 0.025}) {
          cloud.push_back({Eigen::Vector3f(x - pose_.x, y - pose_.y, 0.f)});
        }
      }
    }
    return cloud;
  }

  const Pose2 pose_{4., 1.5, 0.};
  Eigen::Matrix3d information_;
  cartographer::mapping::ValueConversionTables tables_;
  ProbabilityGrid grid_;
};

TEST_F(SlideTestTest, AStraightWallFitsElsewhere) {
  MakeWall(9., 9.);
  EXPECT_NEAR(
      SlideOdds(pose_, information_, absl::nullopt, Scan(9., 9.), grid_), 0.,
      0.1);
}

// Both jambs, 4 patches of them, and 4 patches of wall that would stand in the
// door or in the free space before it.
TEST_F(SlideTestTest, ADoorHoldsIt) {
  MakeWall(3.5, 4.5);
  const double odds =
      SlideOdds(pose_, information_, absl::nullopt, Scan(3.5, 4.5), grid_);
  EXPECT_GT(odds, 3.);
  EXPECT_LT(odds, 8. * std::log(4.));
}

// By hand: predicted at the pose with 0.2 m, a slide of 0.5 m costs 0.5 * 2.5^2.
TEST_F(SlideTestTest, APredictionHoldsItToo) {
  MakeWall(9., 9.);
  PredictedPosition predicted;
  predicted.position = pose_.translation();
  predicted.sigma = 0.2;
  EXPECT_NEAR(SlideOdds(pose_, information_, predicted, Scan(9., 9.), grid_),
              3.125, 0.1);
  // Found half a metre from there, it might as well be there.
  predicted.position.x() -= 0.5;
  EXPECT_NEAR(SlideOdds(pose_, information_, predicted, Scan(9., 9.), grid_),
              -3.125, 0.1);
}

TEST_F(SlideTestTest, DeterminedDirectionsAreNotTested) {
  MakeWall(9., 9.);
  information_(0, 0) = 2e3;
  EXPECT_EQ(SlideOdds(pose_, information_, absl::nullopt, Scan(9., 9.), grid_),
            std::numeric_limits<double>::infinity());
  information_(0, 0) = std::nan("");
  EXPECT_EQ(SlideOdds(pose_, information_, absl::nullopt, Scan(9., 9.), grid_),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
