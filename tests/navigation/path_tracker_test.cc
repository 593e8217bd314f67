// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/path_tracker.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(PathTrackerTest, KnowsWhatIsAhead) {
  PathTracker tracker({{0., 0.}, {2., 0.}, {2., 1.}});
  EXPECT_NEAR(tracker.Remaining(), 3., 1e-9);
  tracker.Advance({1., 0.3});
  EXPECT_NEAR(tracker.Remaining(), 2., 1e-9);
  EXPECT_NEAR((tracker.Ahead(1.5) - Eigen::Vector2d(2., 0.5)).norm(), 0., 0.1);
  EXPECT_EQ(tracker.Ahead(100.), Eigen::Vector2d(2., 1.));
  const auto ahead = tracker.PointsAhead(0.5);
  ASSERT_EQ(ahead.size(), 6u);
  EXPECT_NEAR(ahead.front().x(), 1., 1e-9);
  EXPECT_NEAR(ahead.back().x(), 1.5, 1e-9);
}

TEST(PathTrackerTest, DoesNotTakeAShortCut) {
  // There and back along two lines 0.4 m apart: stays on the first.
  PathTracker tracker({{0., 0.}, {5., 0.}, {5., 0.4}, {0., 0.4}});
  for (double x = 0.; x < 3.; x += 0.1) tracker.Advance({x, 0.25});
  EXPECT_NEAR(tracker.Remaining(), 10.4 - 2.9, 0.11);
}

TEST(PathTrackerTest, APointIsAPath) {
  PathTracker tracker({{1., 2.}});
  tracker.Advance({5., 5.});
  EXPECT_EQ(tracker.Remaining(), 0.);
  EXPECT_EQ(tracker.Ahead(1.), Eigen::Vector2d(1., 2.));
  EXPECT_TRUE(PathTracker().empty());
  EXPECT_EQ(PathTracker().Remaining(), 0.);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
