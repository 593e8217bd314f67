// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/submap_matcher.h"

#include <cmath>
#include <memory>

#include "cartographer/mapping/2d/probability_grid.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

namespace host = cartographer::mapping;

class PlaceMatcherTest : public testing::Test {
 protected:
  PlaceMatcherTest()
      : grid_(host::test::RoomGrid(&tables_, 0.05, 5)),
        options_(host::test::LoadSlamOptions("")
                     .map_builder.pose_graph_options()
                     .constraint_builder_options()
                     .fast_correlative_scan_matcher_options()),
        places_(*grid_, options_) {}

  // The room as seen from a pose in it.
  static cartographer::sensor::PointCloud SeenFrom(const Pose2& pose) {
    const Pose2 from_room = pose.Inverse();
    cartographer::sensor::PointCloud cloud;
    for (const auto& point : host::test::Room()) {
      const Eigen::Vector2d seen =
          from_room * Eigen::Vector2d(point.position.head<2>().cast<double>());
      cloud.push_back({Eigen::Vector3f(static_cast<float>(seen.x()),
                                       static_cast<float>(seen.y()), 0.f)});
    }
    return cloud;
  }

  std::shared_ptr<const SubmapMatcher> Exact() {
    ++num_exact_;
    return std::make_shared<const SubmapMatcher>(*grid_, options_);
  }
  SubmapMatch Match(const cartographer::sensor::PointCloud& cloud,
                    const double min_score) {
    const absl::optional<Pose2> place = places_.Find(cloud, min_score);
    if (!place.has_value()) return SubmapMatch();
    const scan_matching::SearchWindow window = places_.WindowOf(cloud);
    return Exact()->Match(*place, window.linear, window.angular, cloud,
                          min_score);
  }

  host::ValueConversionTables tables_;
  const std::unique_ptr<host::ProbabilityGrid> grid_;
  const host::scan_matching::proto::FastCorrelativeScanMatcherOptions2D
      options_;
  const PlaceMatcher places_;
  int num_exact_ = 0;
};

TEST_F(PlaceMatcherTest, FindsTheMatchOfTheExactSearch) {
  for (int i = 0; i < 12; ++i) {
    const Pose2 pose(-1. + 0.3 * i, 0.1 * i - 0.5, 0.55 * i);
    const auto cloud = SeenFrom(pose);
    const SubmapMatch exact = Exact()->MatchFullSubmap(cloud, 0.5);
    const SubmapMatch found = Match(cloud, 0.5);
    ASSERT_TRUE(exact.found) << i;
    ASSERT_TRUE(found.found) << i;
    EXPECT_NEAR(found.score, exact.score, 1e-6) << i;
    const Pose2 error = Between(pose, found.pose);
    EXPECT_LT(error.translation().norm(), 0.06) << i;
    EXPECT_LT(std::abs(error.theta), 0.03) << i;
  }
}

TEST_F(PlaceMatcherTest, IsRoughWhereNothingCanMatch) {
  cartographer::sensor::PointCloud cloud;
  for (int i = 0; i < 200; ++i) {
    // Scattered over a place larger than the room.
    const float angle = 2.4f * static_cast<float>(i);
    const float range = 0.05f * static_cast<float>(i);
    cloud.push_back({Eigen::Vector3f(range * std::cos(angle),
                                     range * std::sin(angle), 0.f)});
  }
  const SubmapMatch match = Match(cloud, 0.8);
  EXPECT_FALSE(match.found);
  EXPECT_EQ(match.score, 0.);
  EXPECT_EQ(num_exact_, 0);
  EXPECT_FALSE(Match({}, 0.1).found);
}

// Points that are not finite fall outside the grid.
TEST_F(PlaceMatcherTest, TakesPointsThatAreNotFinite) {
  const Pose2 pose(0.4, 0.2, 1.);
  auto cloud = SeenFrom(pose);
  cloud.push_back({Eigen::Vector3f(std::nanf(""), 1.f, 0.f)});
  const SubmapMatch match = Match(cloud, 0.5);
  ASSERT_TRUE(match.found);
  EXPECT_LT(Between(pose, match.pose).translation().norm(), 0.06);
}

// Two cells of 0.2 m, and what they are at the range of the farthest point.
TEST_F(PlaceMatcherTest, TheWindowFollowsTheRange) {
  cartographer::sensor::PointCloud cloud;
  cloud.push_back({Eigen::Vector3f(3.f, 4.f, 0.f)});
  cloud.push_back({Eigen::Vector3f(1.f, 0.f, 0.f)});
  EXPECT_NEAR(places_.WindowOf(cloud).linear, 0.4, 1e-12);
  EXPECT_NEAR(places_.WindowOf(cloud).angular, 0.08, 1e-12);
  // Nearer than a cell.
  EXPECT_NEAR(places_.WindowOf({}).angular, 2., 1e-12);
}

TEST_F(PlaceMatcherTest, TakesAFractionOfTheMemory) {
  EXPECT_LT(5 * places_.MemoryBytes(), Exact()->MemoryBytes());
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
