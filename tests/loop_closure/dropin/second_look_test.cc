// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/second_look.h"

#include <cmath>
#include <memory>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer_ext/loop_closure/consensus/candidate_edge.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"
#include "tests/loop_closure/dropin/verified_constraint_builder_room.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

namespace host = cartographer::mapping;
using proto::LoopDecision;
using testing::IsEmpty;
using uncertainty::NodeId;
using uncertainty::SubmapId;

// A robot goes round and round in a room, 0.15 m from node to node. Local SLAM
// loses its way after the first round, which is the only submap.
class SecondLookTest : public testing::Test {
 protected:
  static constexpr int kNumNodes = 300;
  static constexpr int kEndOfSubmap = 30;
  static constexpr int kNode = 200;

  SecondLookTest()
      : submap_(Eigen::Vector2f::Zero(),
                host::test::RoomGrid(&tables_, 0.05, 5), &tables_),
        options_(test::StagesOff()) {
    submap_.Finish();
    options_.search.enabled = true;
    options_.temporal.enabled = true;
    options_.compatible_subset.enabled = true;
  }

  static Pose2 Truth(const int i) {
    const double angle = 0.2 * i;
    return Pose2(std::cos(angle), 0.5 * std::sin(angle), angle);
  }
  // (gravity-aligned <- tracking frame)
  static Pose2 Aligned(const int i) {
    return Pose2(0., 0., NormalizeAngle(0.3 * i));
  }
  static Pose2 Local(const int i) {
    return i <= kEndOfSubmap ? Truth(i) : Pose2(7., -4., 1.) * Truth(i);
  }

  void Make() {
    const auto stock = test::StockOptions();
    pipeline_ = absl::make_unique<LoopPipeline>(options_, ConstraintWeights());
    store_ = absl::make_unique<SubmapStore>(stock, options_);
    searcher_ =
        absl::make_unique<PairSearcher>(stock, options_, store_->cache());
    planner_ =
        absl::make_unique<PairPlanner>(stock, options_, &pipeline_->paths());
    look_ = absl::make_unique<SecondLook>(options_, searcher_.get(),
                                          &typical_fit_, store_.get(),
                                          planner_.get(), pipeline_.get());
    for (int i = 0; i < kNumNodes; ++i) {
      HistoryNode node;
      node.node_index = i;
      node.time = 10000000LL * i;
      node.local_pose = Local(i);
      node.aligned_theta = Aligned(i).theta;
      const Pose2 from_room = Truth(i).Inverse();
      std::vector<Eigen::Vector2f> points;
      for (const auto& point : host::test::Room()) {
        points.push_back(
            (from_room *
             Eigen::Vector2d(point.position.head<2>().cast<double>()))
                .cast<float>());
      }
      DescribeScan(pipeline_->temporal_options(), points, &node);
      pipeline_->AddNode(0, node);
      store_->AddNode(NodeId{0, i}, node.time);
      if (i == kEndOfSubmap) store_->AddPair(SubmapId{0, 0}, &submap_, 0);
    }
  }

  // A match of a node, found `offset` (frame of the submap) from its place.
  LoopCandidate Match(const Pose2& offset, const int node = kNode) {
    LoopCandidate candidate = store_->MakeCandidate(
        SubmapId{0, 0}, *store_->Find(SubmapId{0, 0}), 0, pipeline_->paths());
    candidate.node = NodeId{0, node};
    candidate.node_time = 10000000LL * node;
    candidate.aligned_from_tracking = Aligned(node);
    candidate.predicted = Pose2();
    candidate.plan.translation_sigma = 5.;
    candidate.plan.linear_window = 15.;
    candidate.match.found = true;
    candidate.match.has_pose = true;
    candidate.match.score = 0.8;
    candidate.match.refined = offset * Truth(node) * Aligned(node).Inverse();
    candidate.match.matched = candidate.match.refined;
    return candidate;
  }

  void Accept(const LoopCandidate& candidate) {
    uncertainty::LoopEdge loop =
        CandidateEdge(options_, pipeline_->paths(), candidate);
    loop.pose.covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal();
    planner_->AddAcceptedLoop(candidate, loop);
    look_->AddAccepted(candidate);
  }

  host::ValueConversionTables tables_;
  host::Submap2D submap_;
  LoopOptions options_;
  const TypicalFit typical_fit_{TypicalFitOptions()};
  std::unique_ptr<LoopPipeline> pipeline_;
  std::unique_ptr<SubmapStore> store_;
  std::unique_ptr<PairSearcher> searcher_;
  std::unique_ptr<PairPlanner> planner_;
  std::unique_ptr<SecondLook> look_;
};

TEST_F(SecondLookTest, SearchesAroundALoopThatWasAcceptedLate) {
  options_.temporal.enabled = false;
  options_.compatible_subset.enabled = false;
  // With the beams that the history keeps.
  Make();
  Accept(Match(Pose2()));
  EXPECT_TRUE(look_->SearchAroundAccepted());
  const std::vector<LoopCandidate> found = pipeline_->Decide();
  EXPECT_GE(found.size(), 12u);
  EXPECT_LE(found.size(), 20u);
  bool is_before = false;
  bool is_after = false;
  for (const LoopCandidate& candidate : found) {
    const int i = candidate.node.node_index;
    EXPECT_EQ(candidate.reason, LoopDecision::ALL_STAGES_PASSED) << i;
    const double travelled =
        *pipeline_->paths().Travelled(NodeId{0, kNode}, candidate.node);
    EXPECT_LE(travelled, 10.);
    EXPECT_GE(travelled, 1.);
    is_before |= i < kNode;
    is_after |= i > kNode;
    const Pose2 error = Between(Truth(i), candidate.RefinedInTrackingFrame());
    EXPECT_LT(error.translation().norm(), 0.05) << i;
    EXPECT_LT(std::abs(error.theta), 0.02) << i;
    EXPECT_LE(candidate.plan.linear_window, 3.);
  }
  EXPECT_TRUE(is_before);
  EXPECT_TRUE(is_after);
  // Once.
  EXPECT_FALSE(look_->SearchAroundAccepted());
  Accept(Match(Pose2()));
  EXPECT_FALSE(look_->SearchAroundAccepted());
}

TEST_F(SecondLookTest, ALoopNearItsPredictionHadItsNeighboursSearched) {
  Make();
  LoopCandidate candidate = Match(Pose2());
  candidate.plan.translation_sigma = 0.5;
  Accept(candidate);
  EXPECT_FALSE(look_->SearchAroundAccepted());
}

TEST_F(SecondLookTest, NodesThatTheHostDeletedAreLeftAlone) {
  Make();
  look_->DeleteNodes(0, kNode);
  look_->DeleteNodes(0, 3);
  Accept(Match(Pose2()));
  EXPECT_TRUE(look_->SearchAroundAccepted());
  std::vector<LoopCandidate> found = pipeline_->Decide(true);
  for (LoopCandidate& rest : pipeline_->Flush()) found.push_back(rest);
  EXPECT_GE(found.size(), 5u);
  for (const LoopCandidate& candidate : found) {
    EXPECT_GT(candidate.node.node_index, kNode);
  }
  // Nor those of a trajectory.
  Accept(Match(Pose2()));
  look_->DeleteTrajectory(0);
  EXPECT_FALSE(look_->SearchAroundAccepted());
}

TEST_F(SecondLookTest, TheNeighboursTellARightMatchFromAWrongOne) {
  Make();
  pipeline_->Process(Match(Pose2()));
  pipeline_->Process(Match(Pose2(0.3, 0.6, kPi)));
  EXPECT_THAT(pipeline_->Decide(), IsEmpty());
  EXPECT_TRUE(look_->FollowUndecided(true));
  const std::vector<LoopCandidate> undecided = pipeline_->Undecided();
  ASSERT_EQ(undecided.size(), 2u);
  ASSERT_TRUE(undecided[0].followed.has_value());
  ASSERT_TRUE(undecided[1].followed.has_value());
  EXPECT_GE(undecided[0].followed->num_found, 10);
  EXPECT_LE(undecided[0].followed->num_missed, 2);
  EXPECT_LE(undecided[1].followed->num_found, 2);
  EXPECT_GE(undecided[1].followed->num_missed, 8);
  // Nothing was added, and it is not done twice.
  EXPECT_FALSE(look_->FollowUndecided(true));
}

TEST_F(SecondLookTest, BeforeTheEndFarMatchesThatWereLeftBehindAreFollowed) {
  // They must not decide about each other.
  options_.compatible_subset.min_revisits = 10;
  options_.compatible_subset.single_strong_score = 2.;
  Make();
  LoopCandidate near = Match(Pose2());
  near.plan.translation_sigma = 0.5;
  pipeline_->Process(near);
  pipeline_->Process(Match(Pose2(), kNumNodes - 10));
  EXPECT_THAT(pipeline_->Decide(), IsEmpty());
  EXPECT_FALSE(look_->FollowUndecided(false));
  pipeline_->Process(Match(Pose2(), kNode - 5));
  EXPECT_THAT(pipeline_->Decide(), IsEmpty());
  EXPECT_TRUE(look_->FollowUndecided(false));
  const std::vector<LoopCandidate> undecided = pipeline_->Undecided();
  ASSERT_EQ(undecided.size(), 3u);
  EXPECT_FALSE(undecided[0].followed.has_value());
  EXPECT_FALSE(undecided[1].followed.has_value());
  ASSERT_TRUE(undecided[2].followed.has_value());
  EXPECT_GE(undecided[2].followed->num_found, 10);
  // The others at the end.
  EXPECT_TRUE(look_->FollowUndecided(true));
  EXPECT_TRUE(pipeline_->Undecided()[1].followed.has_value());
}

TEST_F(SecondLookTest, TheModesOfThePapersLookOnce) {
  options_.compatible_subset.single_strong_enabled = false;
  Make();
  Accept(Match(Pose2()));
  EXPECT_FALSE(look_->SearchAroundAccepted());
  pipeline_->Process(Match(Pose2()));
  EXPECT_THAT(pipeline_->Decide(), IsEmpty());
  EXPECT_FALSE(look_->FollowUndecided(true));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
