// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/relocalizer.h"

#include <vector>

#include "gtest/gtest.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

class RelocalizerTest : public testing::Test {
 protected:
  RelocalizerTest()
      : paths_(uncertainty::RandomWalk(), 1000),
        localization_(MapLocalizationOptions(), &paths_) {
    paths_.Add(uncertainty::NodeId{1, 5}, Pose2());
    for (int s = 0; s < 2; ++s) {
      jobs_[s].candidate.submap = uncertainty::SubmapId{0, s};
      jobs_[s].candidate.node = uncertainty::NodeId{1, 5};
      jobs_[s].candidate.predicted = Pose2(1., 0., 0.);
    }
  }

  PlaceQuery Query(Relocalizer* const relocalizer) {
    return relocalizer->MakeQuery({&jobs_[0], &jobs_[1]}, localization_);
  }

  uncertainty::PathUncertainty paths_;
  MapLocalization localization_;
  SearchJob jobs_[2];
};

TEST_F(RelocalizerTest, PlacesAreForgottenOnceWithTheNextQuery) {
  Relocalizer relocalizer(RelocalizationOptions(), 0.5);
  const PlaceQuery first = Query(&relocalizer);
  EXPECT_FALSE(first.is_known);
  EXPECT_EQ(first.forget_up_to, -1);
  relocalizer.DeleteNodes(1, 3);
  relocalizer.DeleteNodes(1, 2);
  relocalizer.DeleteNodes(2, 9);
  const PlaceQuery second = Query(&relocalizer);
  EXPECT_EQ(second.forget_up_to, 3);
  EXPECT_EQ(second.places, first.places);
  EXPECT_EQ(Query(&relocalizer).forget_up_to, -1);
  relocalizer.ForgetPlaces(1, 0, 4);
  EXPECT_EQ(Query(&relocalizer).forget_up_to, 4);
  relocalizer.DeleteTrajectory(1);
  EXPECT_NE(Query(&relocalizer).places, first.places);
}

TEST_F(RelocalizerTest, DecisionsForAnotherPlaceMakeARunLost) {
  Relocalizer relocalizer(RelocalizationOptions(), 0.5);
  const uncertainty::NodeId node{1, 5};
  localization_.AddAcceptedLoop(node, 0);
  PlaceQuery query = Query(&relocalizer);
  EXPECT_TRUE(query.is_known);
  query.result.decided = true;
  query.result.decided_submap = 1;
  query.result.decided_pose = Pose2(1.1, 0., 0.);
  for (int k = 0; k < 3; ++k) {
    relocalizer.ReportDecision(query, &localization_);
  }
  EXPECT_FALSE(localization_.PlanNode(node, 0, true).by_decisions);
  query.result.decided_pose = Pose2(9., 0., 0.);
  for (int k = 0; k < 3; ++k) {
    relocalizer.ReportDecision(query, &localization_);
  }
  EXPECT_TRUE(localization_.PlanNode(node, 0, true).by_decisions);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
