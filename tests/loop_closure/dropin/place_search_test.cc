// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/place_search.h"

#include <memory>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer_ext/loop_closure/dropin/node_geometry.h"
#include "cartographer_ext/loop_closure_options.pb.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

namespace host = cartographer::mapping;
using cartographer::sensor::PointCloud;
using host::Submap2D;

// A room as two submaps of a map have it, and a robot that goes round in it. It
// does not know where it is: its own frame is turned and far away.
class PlaceSearchTest : public testing::Test {
 protected:
  PlaceSearchTest() {
    const auto matcher_options = host::test::LoadSlamOptions("")
                                     .map_builder.pose_graph_options()
                                     .constraint_builder_options()
                                     .fast_correlative_scan_matcher_options();
    for (int s = 0; s < 2; ++s) {
      submaps_.push_back(absl::make_unique<Submap2D>(
          Eigen::Vector2f(0.1f * s, 0.f),
          host::test::RoomGrid(&tables_, 0.05, 5), &tables_));
      submaps_.back()->Finish();
      matchers_.push_back(absl::make_unique<SubmapMatcher>(
          *submaps_.back()->grid(), matcher_options));
    }
  }

  static Pose2 Truth(const int i) {
    const double angle = 0.4 * i;
    return Pose2(std::cos(angle), 0.5 * std::sin(angle), angle);
  }

  static PlaceNode Node(const int i) {
    PlaceNode node;
    node.node_index = i;
    node.time = 100 + i;
    node.local_pose = Pose2(70., -20., 2.) * Truth(i);
    node.cloud =
        host::test::Moved(host::test::Room(), ToRigid2d(Truth(i).Inverse()));
    return node;
  }

  std::vector<PlaceSubmap> Submaps() const {
    std::vector<PlaceSubmap> submaps(2);
    for (int s = 0; s < 2; ++s) {
      submaps[s].submap_index = s;
      submaps[s].matcher = [this, s]() { return matchers_[s]; };
      submaps[s].submap = submaps_[s].get();
      submaps[s].search = s == 0;
    }
    return submaps;
  }

  PlaceResult Search(PlaceSearch* const places, const int i,
                     const bool is_known) {
    return places->Search(Node(i), Submaps(), is_known,
                          [](const Submap2D&, const PointCloud&,
                             const Pose2& pose) { return pose; });
  }

  RelocalizationOptions options_;
  host::ValueConversionTables tables_;
  std::vector<std::unique_ptr<Submap2D>> submaps_;
  std::vector<std::shared_ptr<const SubmapMatcher>> matchers_;
};

TEST_F(PlaceSearchTest, DecidesAfterAFewNodesAndReturnsThemOnce) {
  PlaceSearch places(options_, 0.5);
  for (int i = 0; i < 3; ++i) {
    const PlaceResult result = Search(&places, i, false);
    ASSERT_EQ(result.scores.size(), 1u);
    EXPECT_GT(result.scores[0], 0.5);
    EXPECT_FALSE(result.outscored[0]);
    EXPECT_FALSE(result.decided);
    EXPECT_TRUE(result.placed.empty());
  }
  const PlaceResult result = Search(&places, 3, false);
  EXPECT_TRUE(result.decided);
  EXPECT_LT(Between(Truth(3), result.decided_pose).translation().norm(), 0.1);
  // Each in both submaps.
  ASSERT_EQ(result.placed.size(), 8u);
  for (int k = 0; k < 8; ++k) {
    const LoopCandidate& placed = result.placed[k];
    const int i = k / 2;
    EXPECT_EQ(placed.node.node_index, i);
    EXPECT_NE(placed.submap.submap_index,
              result.placed[k ^ 1].submap.submap_index);
    EXPECT_EQ(placed.first_node_index, 0);
    EXPECT_EQ(placed.node_time, 100 + i);
    EXPECT_GT(placed.match.score, 0.5);
    EXPECT_LT(Between(Truth(i), placed.submap_local_pose * placed.match.refined)
                  .translation()
                  .norm(),
              0.1);
    EXPECT_GT(placed.match.information(0, 0), 0.);
  }
  const PlaceResult next = Search(&places, 4, false);
  ASSERT_EQ(next.placed.size(), 2u);
  EXPECT_EQ(next.placed[0].node.node_index, 4);
}

TEST_F(PlaceSearchTest, NothingIsReturnedWhereThePlaceIsKnown) {
  PlaceSearch places(options_, 0.5);
  for (int i = 0; i < 5; ++i) {
    const PlaceResult result = Search(&places, i, true);
    EXPECT_EQ(result.decided, i >= 3);
    EXPECT_TRUE(result.placed.empty());
  }
}

TEST_F(PlaceSearchTest, ForgottenNodesDoNotCount) {
  PlaceSearch places(options_, 0.5);
  for (int i = 0; i < 4; ++i) Search(&places, i, false);
  places.DeleteNodes(3);
  const PlaceResult result = Search(&places, 4, false);
  EXPECT_FALSE(result.decided);
}

TEST_F(PlaceSearchTest, WhatFitsNowhereIsNotFound) {
  PlaceSearch places(options_, 0.5);
  PlaceNode node = Node(0);
  // A single wall of points far beyond any in the room.
  node.cloud = PointCloud();
  for (int k = 0; k < 50; ++k) {
    node.cloud.push_back(
        {Eigen::Vector3f(0.3f * static_cast<float>(k) - 7.5f,
                         9.f * static_cast<float>(k % 2), 0.f)});
  }
  const PlaceResult result =
      places.Search(node, Submaps(), false,
                    [](const Submap2D&, const PointCloud&, const Pose2& pose) {
                      return pose;
                    });
  EXPECT_EQ(result.scores[0], 0.);
  EXPECT_FALSE(result.decided);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
