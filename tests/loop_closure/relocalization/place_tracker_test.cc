// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/relocalization/place_tracker.h"

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr int kAll = std::numeric_limits<int>::max();

// The run drives along x, two metres a node. The map has two corridors along x,
// at y = 0 and at y = 50, in which nodes score by `scores`.
class PlaceTrackerTest : public testing::Test {
 protected:
  static Pose2 Local(const int node) { return Pose2(2. * node, 0., 0.); }
  static Pose2 InMap(const int node, const double y) {
    return Pose2(10. + 2. * node, y, 0.);
  }

  PlaceMatch Match(const int node, const double y) const {
    PlaceMatch match;
    match.submap_index = y < 25. ? 0 : 1;
    match.pose = InMap(node, y);
    match.score = (y < 25. ? lower_ : upper_).at(node);
    return match;
  }

  PlaceTracker::Matcher Matcher() {
    return [this](const int node, const Pose2& guess) {
      ++num_matches_;
      absl::optional<PlaceMatch> match;
      const auto& scores = guess.y < 25. ? lower_ : upper_;
      if (scores.count(node) > 0) match = Match(node, guess.y < 25. ? 0. : 50.);
      return match;
    };
  }

  void Add(PlaceTracker* const tracker, const int node,
           const std::vector<PlaceMatch>& found) {
    tracker->AddNode(node, Local(node), found, Matcher());
  }

  PlaceTrackerOptions options_;
  std::map<int, double> lower_, upper_;
  int num_matches_ = 0;
};

TEST_F(PlaceTrackerTest, NothingFoundIsNothingDecided) {
  PlaceTracker tracker(options_);
  EXPECT_FALSE(tracker.Decide(kAll).decided);
  EXPECT_EQ(tracker.oldest_node(), -1);
  for (int i = 0; i < 5; ++i) Add(&tracker, i, {});
  EXPECT_EQ(tracker.num_nodes(), 5);
  EXPECT_EQ(tracker.num_tracks(), 0);
  EXPECT_FALSE(tracker.Decide(kAll).decided);
}

TEST_F(PlaceTrackerTest, OnePlaceIsDecidedForAfterEnoughNodes) {
  PlaceTracker tracker(options_);
  for (int i = 0; i < 4; ++i) {
    lower_[i] = 0.8;
    Add(&tracker, i, {Match(i, 0.)});
    EXPECT_EQ(tracker.num_tracks(), 1);
    EXPECT_EQ(tracker.Decide(kAll).decided, i == 3) << i;
  }
  const auto decision = tracker.Decide(kAll);
  EXPECT_THAT(decision.nodes, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(decision.matches.back().submap_index, 0);
  EXPECT_TRUE(tracker.IsSamePlace(decision.matches.back().pose, InMap(3, 0.)));
  EXPECT_EQ(decision.lead, std::numeric_limits<double>::infinity());
  // Of fewer nodes than are needed nothing follows.
  EXPECT_FALSE(tracker.Decide(3).decided);
}

TEST_F(PlaceTrackerTest, PlacesThatLookAlikeAreComparedNodeByNode) {
  PlaceTracker tracker(options_);
  // Scores go up and down together; the upper corridor is better by 0.02 and
  // 0.04 in turn: mean 0.03, standard deviation 0.01 n / (n - 1).
  for (int i = 0; i < 4; ++i) {
    lower_[i] = i % 2 == 0 ? 0.6 : 0.8;
    upper_[i] = lower_[i] + (i / 2 % 2 == 0 ? 0.02 : 0.04);
    Add(&tracker, i, {Match(i, 0.), Match(i, 50.)});
    EXPECT_EQ(tracker.num_tracks(), 2);
  }
  const auto decision = tracker.Decide(kAll);
  EXPECT_NEAR(decision.lead, 0.03, 1e-12);
  EXPECT_NEAR(decision.significance, 0.03 * 2. / std::sqrt(4e-4 / 3.), 1e-9);
  EXPECT_TRUE(decision.decided);
  EXPECT_EQ(decision.matches[0].submap_index, 1);
}

TEST_F(PlaceTrackerTest, ASmallLeadHasToLast) {
  options_.significance = 2.9;
  PlaceTracker tracker(options_);
  // Ahead by 0.01; with the floor of 0.01 that takes nine nodes.
  for (int i = 0; i < 9; ++i) {
    lower_[i] = 0.7;
    upper_[i] = 0.71;
    Add(&tracker, i, {Match(i, 0.), Match(i, 50.)});
    EXPECT_EQ(tracker.Decide(kAll).decided, i == 8) << i;
  }
}

TEST_F(PlaceTrackerTest, APlaceFoundLateIsFollowedBack) {
  PlaceTracker tracker(options_);
  for (int i = 0; i < 4; ++i) {
    lower_[i] = 0.7;
    upper_[i] = 0.9;
    Add(&tracker, i, {Match(i, 0.)});
  }
  EXPECT_TRUE(tracker.Decide(kAll).decided);
  lower_[4] = 0.7;
  upper_[4] = 0.9;
  num_matches_ = 0;
  Add(&tracker, 4, {Match(4, 50.)});
  // One on, four back.
  EXPECT_EQ(num_matches_, 5);
  const auto decision = tracker.Decide(kAll);
  EXPECT_TRUE(decision.decided);
  EXPECT_THAT(decision.nodes, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_NEAR(decision.matches[0].score, 0.9, 1e-12);
}

TEST_F(PlaceTrackerTest, AMotionThatFitsNowhereEndsWhatWasBefore) {
  PlaceTracker tracker(options_);
  for (int i = 0; i < 6; ++i) {
    lower_[i] = 0.8;
    Add(&tracker, i, {Match(i, 0.)});
  }
  // Nothing is where the corridor goes on; the other one fits well, but not the
  // node before.
  lower_[6] = 0.74;
  for (int i = 6; i < 9; ++i) upper_[i] = 0.85;
  Add(&tracker, 6, {Match(6, 50.)});
  EXPECT_EQ(tracker.num_nodes(), 1);
  EXPECT_FALSE(tracker.Decide(kAll).decided);
  // A little worse is no break.
  lower_[7] = 0.76;
  Add(&tracker, 7, {Match(7, 50.)});
  EXPECT_EQ(tracker.num_nodes(), 2);
}

TEST_F(PlaceTrackerTest, WhereThereIsNoMatchAPlaceLoses) {
  PlaceTracker tracker(options_);
  for (int i = 0; i < 6; ++i) {
    lower_[i] = 0.7;
    // The upper corridor ends.
    if (i < 3) upper_[i] = 0.75;
    std::vector<PlaceMatch> found = {Match(i, 0.)};
    if (i < 3) found.push_back(Match(i, 50.));
    Add(&tracker, i, found);
  }
  const auto decision = tracker.Decide(3);
  EXPECT_FALSE(decision.decided);
  EXPECT_NEAR(decision.lead, 0.7 - options_.score_without_match, 1e-12);
  EXPECT_EQ(decision.matches.back().submap_index, 0);
}

TEST_F(PlaceTrackerTest, TheSamePlaceIsFollowedOnce) {
  PlaceTracker tracker(options_);
  lower_[0] = 0.7;
  PlaceMatch near = Match(0, 0.);
  near.pose.x += 1.;
  near.score = 0.8;
  Add(&tracker, 0, {Match(0, 0.), near});
  EXPECT_EQ(tracker.num_tracks(), 1);
  EXPECT_NEAR(tracker.Decide(kAll).matches.at(0).score, 0.8, 1e-12);
  PlaceMatch turned = Match(0, 0.);
  turned.pose.theta = 3.;
  EXPECT_FALSE(tracker.IsSamePlace(turned.pose, near.pose));
}

TEST_F(PlaceTrackerTest, IsBoundedAndForgets) {
  options_.max_nodes = 5;
  options_.max_tracks = 2;
  PlaceTracker tracker(options_);
  for (int i = 0; i < 20; ++i) {
    lower_[i] = 0.7;
    std::vector<PlaceMatch> found;
    for (int k = 0; k < 6; ++k) {
      PlaceMatch match = Match(i, 0.);
      match.pose.y = -5. * k;
      match.score = 0.7 - 0.01 * k;
      found.push_back(match);
    }
    Add(&tracker, i, found);
  }
  EXPECT_EQ(tracker.num_nodes(), 5);
  EXPECT_EQ(tracker.oldest_node(), 15);
  EXPECT_LE(tracker.num_tracks(), 2);
  tracker.DeleteNodes(17);
  EXPECT_EQ(tracker.num_nodes(), 2);
  EXPECT_THAT(tracker.Decide(kAll).nodes, ElementsAre(18, 19));
  tracker.DeleteNodes(100);
  EXPECT_EQ(tracker.num_nodes(), 0);
  EXPECT_EQ(tracker.num_tracks(), 0);
  EXPECT_THAT(tracker.Decide(kAll).nodes, IsEmpty());
  lower_[50] = 0.7;
  Add(&tracker, 50, {Match(50, 0.)});
  EXPECT_EQ(tracker.num_tracks(), 1);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
