// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the constraint builder records, rejects and withdraws, and what it
// forgets with submaps.
#include <set>
#include <vector>

#include "cartographer/common/thread_pool.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/dropin/verified_constraint_builder_room.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

namespace host = cartographer::mapping;
using cartographer::transform::Rigid2d;
using cartographer::transform::Rigid3d;
using host::NodeId;
using host::Submap2D;
using host::SubmapId;
using proto::LoopDecision;
using test::Builder;
using test::Collect;
using test::StagesOff;
using test::StockOptions;

using VerifiedConstraintBuilderRecordsTest =
    test::VerifiedConstraintBuilderRoom;

TEST_F(VerifiedConstraintBuilderRecordsTest, EveryCandidateHasOneRecord) {
  recorder_->Start(100000);
  int64_t accepted = 0;
  {
    cartographer::common::ThreadPool pool(2);
    Builder builder(StockOptions(), LoopOptions(), &pool);
    for (const Builder::Result& result : Drive(&builder)) {
      accepted += static_cast<int64_t>(result.size());
    }
  }
  std::vector<int> seen;
  int64_t recorded = 0;
  for (const LoopDecision& decision : recorder_->All()) {
    const size_t number = static_cast<size_t>(decision.candidate());
    if (seen.size() <= number) seen.resize(number + 1, 0);
    ++seen[number];
    EXPECT_NE(decision.verdict(), LoopDecision::UNDECIDED);
    EXPECT_NE(decision.reason(), LoopDecision::NONE);
    recorded += decision.verdict() == LoopDecision::ACCEPTED;
    if (decision.verdict() == LoopDecision::ACCEPTED) {
      // In the robot's frame, whatever the gravity alignment.
      EXPECT_NEAR(
          NormalizeAngle(decision.search().refined().theta() -
                         Truth(decision.node_index()).normalized_angle()),
          0., 0.02);
      EXPECT_EQ(decision.information().matrix_size(), 6);
    }
  }
  EXPECT_GT(accepted, 0);
  EXPECT_EQ(recorded, accepted);
  EXPECT_GT(seen.size(), 20u);
  for (const int count : seen) EXPECT_EQ(count, 1);
}

// Two pose graphs in one process do not see each other's decisions.
TEST_F(VerifiedConstraintBuilderRecordsTest, RecordsBelongToOnePoseGraph) {
  recorder_->Start(100000);
  const auto other = std::make_shared<PoseGraphContext>();
  other->Get<DecisionRecorder>()->Start(100000);
  {
    const ScopedPoseGraphContext scope(other);
    cartographer::common::ThreadPool pool(1);
    Builder builder(StockOptions(), LoopOptions(), &pool);
    Drive(&builder);
  }
  EXPECT_TRUE(recorder_->All().empty());
  EXPECT_FALSE(other->Get<DecisionRecorder>()->All().empty());
}

TEST_F(VerifiedConstraintBuilderRecordsTest,
       DeletedSubmapsTakeTheirNodesAlong) {
  recorder_->Start(100000);
  LoopOptions options;
  // Nothing is ever confirmed, so everything waits.
  options.compatible_subset.min_revisits = 50;
  options.compatible_subset.single_strong_enabled = false;
  options.search.informative_sigma = 0.;
  cartographer::common::ThreadPool pool(2);
  Builder builder(StockOptions(), options, &pool);
  EXPECT_TRUE(Drive(&builder).back().empty());
  const auto undecided = [this]() {
    int count = 0;
    for (const LoopDecision& decision : recorder_->All()) {
      count += decision.verdict() == LoopDecision::UNDECIDED;
    }
    return count;
  };
  const int before = undecided();
  EXPECT_GT(before, 0);
  builder.DeleteScanMatcher(SubmapId{0, 0});
  const int after = undecided();
  EXPECT_LT(after, before);
  Collect(&builder);
  int deleted_submap = 0;
  for (const LoopDecision& decision : recorder_->All()) {
    if (decision.verdict() == LoopDecision::UNDECIDED) {
      EXPECT_NE(decision.submap_index(), 0);
      // First offered with node 0, met again with node 1.
      EXPECT_GT(decision.node_index(), 1);
    }
    deleted_submap += decision.reason() == LoopDecision::SUBMAP_DELETED;
  }
  EXPECT_GT(deleted_submap, 0);
}

TEST_F(VerifiedConstraintBuilderRecordsTest,
       ProbableLoopsAreAcceptedWhereNoNodeFollows) {
  recorder_->Start(100000);
  LoopOptions options;
  options.compatible_subset.min_revisits = 50;
  options.compatible_subset.single_strong_loops = 1000;
  options.compatible_subset.probability_at_end = 0.;
  cartographer::common::ThreadPool pool(2);
  Builder builder(StockOptions(), options, &pool);
  EXPECT_TRUE(Drive(&builder).back().empty());
  EXPECT_FALSE(Collect(&builder).empty());
  int accepted = 0;
  for (const LoopDecision& decision : recorder_->All()) {
    if (decision.verdict() != LoopDecision::ACCEPTED) continue;
    EXPECT_EQ(decision.reason(), LoopDecision::LIKELY_AT_END);
    ++accepted;
  }
  EXPECT_GT(accepted, 0);
}

// A submap of a trajectory of which no node was ever offered: any node may
// have been part of it.
TEST_F(VerifiedConstraintBuilderRecordsTest, UnknownNodesAreAllGivenUp) {
  recorder_->Start(100000);
  LoopOptions options;
  options.compatible_subset.min_revisits = 50;
  options.compatible_subset.single_strong_enabled = false;
  cartographer::common::ThreadPool pool(1);
  Builder builder(StockOptions(), options, &pool);
  for (int i = 0; i < 10; ++i) {
    builder.MaybeAddGlobalConstraint(SubmapId{5, 0}, submaps_[0].get(),
                                     NodeId{1, i}, &nodes_[i]);
    builder.MaybeAddGlobalConstraint(SubmapId{1, 0}, submaps_[0].get(),
                                     NodeId{5, i}, &nodes_[i]);
    builder.NotifyEndOfNode();
  }
  Collect(&builder);
  builder.DeleteScanMatcher(SubmapId{5, 0});
  Collect(&builder);
  for (const LoopDecision& decision : recorder_->All()) {
    EXPECT_NE(decision.verdict(), LoopDecision::UNDECIDED);
  }
}

TEST_F(VerifiedConstraintBuilderRecordsTest, FreesDeletedTrajectories) {
  recorder_->Start(100000);
  LoopOptions options;
  options.compatible_subset.min_revisits = 50;
  options.compatible_subset.single_strong_enabled = false;
  cartographer::common::ThreadPool pool(2);
  Builder builder(StockOptions(), options, &pool);
  Drive(&builder);
  for (int s = 0; s < 3; ++s) builder.DeleteScanMatcher(SubmapId{0, s});
  // Another run goes on for long enough.
  for (int i = 0; i < 110; ++i) {
    builder.MaybeAddConstraint(SubmapId{1, 0}, submaps_[0].get(), NodeId{1, i},
                               &nodes_[i % kNumNodes],
                               Relative(0, i % kNumNodes));
    builder.NotifyEndOfNode();
    if (i % 10 == 9) Collect(&builder);
  }
  for (const LoopDecision& decision : recorder_->All()) {
    if (decision.verdict() == LoopDecision::UNDECIDED) {
      EXPECT_EQ(decision.node_trajectory_id(), 1);
    }
  }
  // The first run may go on all the same.
  for (int s = 0; s < 3; ++s) Offer(&builder, s, kNumNodes - 1);
  builder.NotifyEndOfNode();
  Collect(&builder);
}

// A run in the map of another one: located, lost over scans that fit nowhere,
// and located again. Submap 0 of its own trajectory is deleted when node 5 is
// the newest; later nodes were certainly no part of it.
TEST_F(VerifiedConstraintBuilderRecordsTest,
       WithdrawsTheLoopsOfARunThatWasLost) {
  constexpr int kLastBefore = 9, kFirstAfter = 30, kLastDeleted = 5;
  LoopOptions options = StagesOff();
  options.relocalization.enabled = true;
  options.relocalization.map.lost_distance = 1.;
  options.relocalization.map.query_spacing = 0.05;
  auto stock_options = StockOptions();
  stock_options.set_sampling_ratio(1.);
  for (const bool deletes : {false, true}) {
    const auto context = std::make_shared<PoseGraphContext>();
    const ScopedPoseGraphContext scope(context);
    cartographer::common::ThreadPool pool(2);
    Builder builder(stock_options, options, &pool);
    std::vector<Builder::NodeData> nodes = nodes_;
    Builder::Result all;
    for (int i = 0; i < kNumNodes; ++i) {
      if (i > kLastBefore && i < kFirstAfter) {
        nodes[i].filtered_gravity_aligned_point_cloud =
            host::test::Cloud({{40.f, 40.f}, {41.f, 43.f}});
      }
      for (int s = 0; s < 3; ++s) {
        builder.MaybeAddConstraint(SubmapId{0, s}, submaps_[s].get(),
                                   NodeId{1, i}, &nodes[i], Relative(s, i));
      }
      builder.NotifyEndOfNode();
      const Builder::Result result = Collect(&builder);
      all.insert(all.end(), result.begin(), result.end());
      if (deletes && i == kLastDeleted) {
        builder.DeleteScanMatcher(SubmapId{1, 0});
      }
    }
    int before = 0, after = 0;
    std::set<LoopId> marked;
    for (const Builder::Constraint& constraint : all) {
      const LoopDescription loop = DescribeConstraint(constraint);
      if (!loop.has_weight) {
        EXPECT_TRUE(marked.insert(loop.id).second);
        EXPECT_LE(loop.id.node_index, kLastBefore);
        EXPECT_GT(loop.id.node_index, deletes ? kLastDeleted : -1);
      } else if (loop.id.node_index <= kLastBefore) {
        ++before;
      } else {
        ++after;
      }
    }
    ASSERT_GT(before, 10);
    ASSERT_GT(after, 0);
    const std::set<LoopId> unmarked = context->Get<WithdrawnLoops>()->All();
    EXPECT_EQ(marked.size() + unmarked.size(), static_cast<size_t>(before));
    EXPECT_EQ(unmarked.empty(), !deletes);
    // All of them, and none of those after.
    EXPECT_EQ(FindWithdrawnLoops(all, DescribeConstraint<Builder::Constraint>,
                                 unmarked)
                  .size(),
              before + marked.size());
  }
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
