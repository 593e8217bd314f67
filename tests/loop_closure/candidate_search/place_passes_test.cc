// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/place_passes.h"

#include "gtest/gtest.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Two trajectories of a node per metre; 2 m of path are one pass.
class PlacePassesTest : public testing::Test {
 protected:
  PlacePassesTest() : paths_(uncertainty::RandomWalk(), 1000) {
    for (const int trajectory : {0, 1}) {
      for (int i = 0; i <= 100; ++i) {
        paths_.Add(uncertainty::NodeId{trajectory, i}, Pose2(i, 0., 0.));
      }
    }
  }

  void Add(const int trajectory, const int node, const Pose2& pose) {
    passes_.Add(uncertainty::NodeId{trajectory, node}, pose, limits_, paths_);
  }

  bool Takes(const int trajectory, const int node, const Pose2& pose) const {
    return passes_.Takes(uncertainty::NodeId{trajectory, node}, pose, limits_,
                         paths_);
  }

  PassLimits limits_;
  uncertainty::PathUncertainty paths_;
  PlacePasses passes_;
};

TEST_F(PlacePassesTest, NodesNearAlongThePathAreOnePass) {
  const Pose2 place(0.5, 0.5, 0.);
  EXPECT_EQ(passes_.Count(place), 0);
  Add(0, 10, place);
  Add(0, 11, place);
  EXPECT_EQ(passes_.Count(place), 1);
  Add(0, 12, place);
  EXPECT_EQ(passes_.Count(place), 2);
  EXPECT_TRUE(Takes(1, 11, place));
  Add(1, 11, place);  // another trajectory
  EXPECT_EQ(passes_.Count(place), 3);
  // The limit, but for the passes that are there.
  EXPECT_FALSE(Takes(0, 80, place));
  EXPECT_TRUE(Takes(0, 13, place));
  Add(0, 80, place);
  EXPECT_EQ(passes_.Count(place), 3);
}

TEST_F(PlacePassesTest, PlacesAreCellsAndQuartersOfATurn) {
  Add(0, 10, Pose2(0.1, 0.1, 3.1));
  EXPECT_EQ(passes_.Count(Pose2(1.9, 1.9, -3.1)), 1);
  EXPECT_EQ(passes_.Count(Pose2(2.1, 0.1, 3.1)), 0);
  EXPECT_EQ(passes_.Count(Pose2(0.1, -0.1, 3.1)), 0);
  EXPECT_EQ(passes_.Count(Pose2(0.1, 0.1, 1.6)), 0);
  EXPECT_EQ(passes_.Count(Pose2(0.1, 0.1, 0.)), 0);
}

TEST_F(PlacePassesTest, ForgetsTheStartOfATrajectory) {
  const Pose2 place(0.5, 0.5, 0.);
  Add(0, 10, place);
  Add(0, 50, place);
  Add(1, 10, place);
  passes_.Forget(0, 10);
  EXPECT_EQ(passes_.Count(place), 2);
  passes_.Forget(1, 100);
  EXPECT_EQ(passes_.Count(place), 1);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
