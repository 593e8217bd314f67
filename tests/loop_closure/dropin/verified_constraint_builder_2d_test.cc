// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/verified_constraint_builder_2d.h"

#include <memory>
#include <thread>
#include <vector>

#include "absl/memory/memory.h"
#include "absl/synchronization/notification.h"
#include "absl/time/time.h"
#include "cartographer/common/internal/testing/thread_pool_for_testing.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/internal/constraints/constraint_builder_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "cartographer_ext/loop_closure/decision_recorder.h"
#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"
#include "cartographer_ext/options/option_description.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"
#include "tests/host/slam_test_helpers.h"
#include "tests/loop_closure/dropin/random_order_pool.h"

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
using Builder = VerifiedConstraintBuilder2D;

host::constraints::proto::ConstraintBuilderOptions StockOptions() {
  auto options = host::test::LoadSlamOptions("")
                     .map_builder.pose_graph_options()
                     .constraint_builder_options();
  options.set_log_matches(false);
  return options;
}

proto::LoopClosureOptions Defaults() {
  proto::LoopClosureOptions options;
  options::SetDefaults(&options);
  return options;
}

// Nothing but Cartographer's search.
proto::LoopClosureOptions StagesOff() {
  proto::LoopClosureOptions options = Defaults();
  options.mutable_search()->set_enabled(false);
  options.mutable_temporal_verification()->set_enabled(false);
  options.mutable_dynamic_threshold()->set_enabled(false);
  options.mutable_fusion()->set_enabled(false);
  options.mutable_information()->set_enabled(false);
  options.mutable_compatible_subset()->set_enabled(false);
  options.mutable_innovation_veto()->set_enabled(false);
  return options;
}

Builder::Result Collect(Builder* const builder) {
  Builder::Result result;
  absl::Notification done;
  builder->WhenDone([&result, &done](const Builder::Result& found) {
    result = found;
    done.Notify();
  });
  done.WaitForNotification();
  return result;
}

// A room, seen by submaps whose origins are a little apart, and a robot that
// goes round and round in it.
class VerifiedConstraintBuilder2DTest : public testing::Test {
 protected:
  static constexpr int kNumNodes = 60;

  VerifiedConstraintBuilder2DTest() {
    for (int s = 0; s < 3; ++s) {
      submaps_.push_back(absl::make_unique<Submap2D>(
          Eigen::Vector2f(0.1f * s, 0.f),
          host::test::RoomGrid(&tables_, 0.05, 5), &tables_));
      submaps_.back()->Finish();
    }
    for (int i = 0; i < kNumNodes; ++i) {
      const Rigid2d pose = Truth(i);
      Builder::NodeData node;
      node.time = cartographer::common::FromUniversal(10000000LL * i);
      node.local_pose = cartographer::transform::Embed3D(pose);
      // Turned against the robot, as the host's gravity alignment may be.
      const double turn = 0.3 * i;
      node.gravity_alignment =
          Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
      node.filtered_gravity_aligned_point_cloud = host::test::Moved(
          host::test::Room(), (pose * Rigid2d::Rotation(-turn)).inverse());
      nodes_.push_back(node);
    }
  }

  ~VerifiedConstraintBuilder2DTest() override {
    DecisionRecorder::Global()->Stop();
  }

  static Rigid2d Truth(const int i) {
    const double angle = 0.2 * i;
    return Rigid2d({std::cos(angle), 0.5 * std::sin(angle)}, angle);
  }

  // (submap <- gravity-aligned node)
  Rigid2d Relative(const int s, const int i) const {
    return host::constraints::ComputeSubmapPose(*submaps_[s]).inverse() *
           Truth(i) * Rigid2d::Rotation(-0.3 * i);
  }

  void Offer(Builder* const builder, const int s, const int i) {
    builder->MaybeAddConstraint(SubmapId{0, s}, submaps_[s].get(), NodeId{0, i},
                                &nodes_[i], Relative(s, i));
  }

  // As the pose graph does: each node against all submaps, a callback now and
  // then.
  std::vector<Builder::Result> Drive(Builder* const builder) {
    std::vector<Builder::Result> results;
    for (int i = 0; i < kNumNodes; ++i) {
      for (int s = 0; s < 3; ++s) Offer(builder, s, i);
      builder->NotifyEndOfNode();
      if (i % 10 == 9) results.push_back(Collect(builder));
    }
    return results;
  }

  // All calls from several threads at once, in any order; nothing is asked but
  // that everything is called back and counted, and that nothing of a submap
  // that is deleted meanwhile is missed.
  void MixAllCalls(cartographer::common::ThreadPoolInterface* const pool,
                   const uint64_t seed) {
    Builder builder(StockOptions(), Defaults(), pool);
    constexpr int kThreads = 3;
    constexpr int kNodesEach = 20;
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([this, &builder, seed, t]() {
        Random random(1000 * seed + t);
        for (int k = 0; k < kNodesEach; ++k) {
          const int i = static_cast<int>(random.Uniform() * kNumNodes);
          const int s = static_cast<int>(random.Uniform() * 3);
          const double choice = random.Uniform();
          if (choice < 0.3) {
            // Of another run: looked for everywhere.
            for (int other = 0; other < 3; ++other) {
              builder.MaybeAddGlobalConstraint(SubmapId{1, other},
                                               submaps_[other].get(),
                                               NodeId{0, i}, &nodes_[i]);
            }
          } else if (choice < 0.4) {
            builder.MaybeAddConstraint(SubmapId{1, s}, submaps_[s].get(),
                                       NodeId{0, i}, &nodes_[i],
                                       Relative(s, i));
          } else {
            Offer(&builder, s, i);
          }
          builder.NotifyEndOfNode();
          builder.GetNumFinishedNodes();
          if (random.Uniform() < 0.1) {
            builder.DeleteScanMatcher(
                SubmapId{static_cast<int>(random.Uniform() * 2), s});
          }
        }
      });
    }
    // Only one callback may be due at a time.
    threads.emplace_back([&builder]() {
      for (int k = 0; k < 5; ++k) Collect(&builder);
    });
    for (std::thread& thread : threads) thread.join();
    Collect(&builder);
    EXPECT_EQ(builder.GetNumFinishedNodes(), kThreads * kNodesEach);
    for (int s = 0; s < 3; ++s) builder.DeleteScanMatcher(SubmapId{0, s});
  }

  host::ValueConversionTables tables_;
  std::vector<std::unique_ptr<Submap2D>> submaps_;
  std::vector<Builder::NodeData> nodes_;
};

constexpr int VerifiedConstraintBuilder2DTest::kNumNodes;

TEST_F(VerifiedConstraintBuilder2DTest, CallsBackWithoutPairs) {
  cartographer::common::ThreadPool pool(1);
  Builder builder(StockOptions(), Defaults(), &pool);
  EXPECT_EQ(builder.GetNumFinishedNodes(), 0);
  EXPECT_TRUE(Collect(&builder).empty());
  builder.NotifyEndOfNode();
  EXPECT_TRUE(Collect(&builder).empty());
  EXPECT_EQ(builder.GetNumFinishedNodes(), 1);
}

// What Cartographer's own test asks of its builder.
TEST_F(VerifiedConstraintBuilder2DTest, StagesOffLetDegenerateDataThrough) {
  cartographer::common::testing::ThreadPoolForTesting pool;
  auto options = StockOptions();
  options.set_min_score(0.);
  options.set_global_localization_min_score(0.);
  options.set_sampling_ratio(1.);
  Builder builder(options, StagesOff(), &pool);
  Builder::NodeData node;
  node.filtered_gravity_aligned_point_cloud = host::test::Cloud({{0.1f, 0.2f}});
  node.gravity_alignment = Eigen::Quaterniond::Identity();
  const Submap2D submap(Eigen::Vector2f(4.f, 5.f),
                        absl::make_unique<host::ProbabilityGrid>(
                            host::MapLimits(1., Eigen::Vector2d(2., 3.),
                                            host::CellLimits(100, 110)),
                            &tables_),
                        &tables_);
  for (int round = 1; round <= 2; ++round) {
    for (int i = 0; i < 2; ++i) {
      builder.MaybeAddConstraint(SubmapId{0, 1}, &submap, NodeId{0, 0}, &node,
                                 Rigid2d::Identity());
    }
    builder.MaybeAddGlobalConstraint(SubmapId{0, 1}, &submap, NodeId{0, 0},
                                     &node);
    builder.NotifyEndOfNode();
    builder.NotifyEndOfNode();
    const Builder::Result result = Collect(&builder);
    EXPECT_EQ(builder.GetNumFinishedNodes(), 2 * round);
    ASSERT_EQ(result.size(), 3u);
    for (const Builder::Constraint& constraint : result) {
      EXPECT_EQ(constraint.tag, Builder::Constraint::INTER_SUBMAP);
      EXPECT_EQ(constraint.pose.translation_weight, 1.1e4);
      EXPECT_EQ(constraint.pose.rotation_weight, 1e5);
    }
    builder.DeleteScanMatcher(SubmapId{0, 1});
  }
  pool.WaitUntilIdle();
}

TEST_F(VerifiedConstraintBuilder2DTest, FindsThePoseOfTheGravityAlignedNode) {
  cartographer::common::ThreadPool pool(2);
  Builder builder(StockOptions(), StagesOff(), &pool);
  for (int i = 0; i < 20; ++i) {
    Offer(&builder, 0, i);
    builder.NotifyEndOfNode();
  }
  const Builder::Result result = Collect(&builder);
  ASSERT_GE(result.size(), 5u);
  for (const Builder::Constraint& constraint : result) {
    const Rigid2d error =
        cartographer::transform::Project2D(constraint.pose.zbar_ij).inverse() *
        Relative(0, constraint.node_id.node_index);
    EXPECT_LT(error.translation().norm(), 0.03);
    EXPECT_LT(std::abs(error.normalized_angle()), 0.02);
  }
}

// Scans of which half hits things that are not in the map, as between bushes.
TEST_F(VerifiedConstraintBuilder2DTest, FloorFollowsWhatScansReach) {
  for (Builder::NodeData& node : nodes_) {
    cartographer::sensor::PointCloud half;
    for (size_t i = 0; i < node.filtered_gravity_aligned_point_cloud.size();
         ++i) {
      cartographer::sensor::RangefinderPoint point =
          node.filtered_gravity_aligned_point_cloud[i];
      if (i % 2 == 0) point.position *= 3.f;
      half.push_back(point);
    }
    node.filtered_gravity_aligned_point_cloud = half;
  }
  auto stock_options = StockOptions();
  auto options = StagesOff();
  options.mutable_search()->set_enabled(true);
  options.mutable_search()->set_informative_sigma(0.);
  options.mutable_search()->set_search_spacing(0.);
  std::vector<size_t> found;
  for (const double reference : {0., 0.65}) {
    cartographer::common::ThreadPool pool(2);
    options.mutable_search()->set_fit_reference(reference);
    Builder builder(stock_options, options, &pool);
    found.push_back(0);
    for (const Builder::Result& result : Drive(&builder)) {
      found.back() += result.size();
      for (const Builder::Constraint& constraint : result) {
        const Rigid2d error =
            cartographer::transform::Project2D(constraint.pose.zbar_ij)
                .inverse() *
            Relative(constraint.submap_id.submap_index,
                     constraint.node_id.node_index);
        EXPECT_LT(error.translation().norm(), 0.05);
      }
    }
  }
  EXPECT_EQ(found[0], 0u);
  EXPECT_GT(found[1], 50u);
}

TEST_F(VerifiedConstraintBuilder2DTest, EveryCandidateHasOneRecord) {
  DecisionRecorder::Global()->Start(100000);
  int64_t accepted = 0;
  {
    cartographer::common::ThreadPool pool(2);
    Builder builder(StockOptions(), Defaults(), &pool);
    for (const Builder::Result& result : Drive(&builder)) {
      accepted += static_cast<int64_t>(result.size());
    }
  }
  std::vector<int> seen;
  int64_t recorded = 0;
  for (const LoopDecision& decision : DecisionRecorder::Global()->All()) {
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

TEST_F(VerifiedConstraintBuilder2DTest, TheSameForAnyNumberOfThreads) {
  std::vector<std::vector<Builder::Result>> runs;
  std::vector<DecisionRecorder::Decisions> records;
  for (const int num_threads : {1, 2, 8}) {
    DecisionRecorder::Global()->Start(100000);
    {
      cartographer::common::ThreadPool pool(num_threads);
      Builder builder(StockOptions(), Defaults(), &pool);
      runs.push_back(Drive(&builder));
    }
    records.push_back(DecisionRecorder::Global()->All());
  }
  for (size_t k = 1; k < runs.size(); ++k) {
    ASSERT_EQ(records[k].size(), records[0].size());
    for (size_t i = 0; i < records[0].size(); ++i) {
      EXPECT_EQ(records[k][i].SerializeAsString(),
                records[0][i].SerializeAsString());
    }
    ASSERT_EQ(runs[k].size(), runs[0].size());
    for (size_t r = 0; r < runs[0].size(); ++r) {
      ASSERT_EQ(runs[k][r].size(), runs[0][r].size());
      for (size_t i = 0; i < runs[0][r].size(); ++i) {
        EXPECT_EQ(runs[k][r][i].pose.zbar_ij.translation(),
                  runs[0][r][i].pose.zbar_ij.translation());
        EXPECT_EQ(runs[k][r][i].node_id, runs[0][r][i].node_id);
      }
    }
  }
}

TEST_F(VerifiedConstraintBuilder2DTest, DeletedSubmapsTakeTheirNodesAlong) {
  DecisionRecorder::Global()->Start(100000);
  proto::LoopClosureOptions options = Defaults();
  // Nothing is ever confirmed, so everything waits.
  options.mutable_compatible_subset()->set_min_revisits(50);
  options.mutable_compatible_subset()->set_single_strong(false);
  options.mutable_search()->set_informative_sigma(0.);
  cartographer::common::ThreadPool pool(2);
  Builder builder(StockOptions(), options, &pool);
  EXPECT_TRUE(Drive(&builder).back().empty());
  const auto undecided = []() {
    int count = 0;
    for (const LoopDecision& decision : DecisionRecorder::Global()->All()) {
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
  for (const LoopDecision& decision : DecisionRecorder::Global()->All()) {
    if (decision.verdict() == LoopDecision::UNDECIDED) {
      EXPECT_NE(decision.submap_index(), 0);
      // First offered with node 0, met again with node 1.
      EXPECT_GT(decision.node_index(), 1);
    }
    deleted_submap += decision.reason() == LoopDecision::SUBMAP_DELETED;
  }
  EXPECT_GT(deleted_submap, 0);
}

// A submap of a trajectory of which no node was ever offered: any node may
// have been part of it.
TEST_F(VerifiedConstraintBuilder2DTest, UnknownNodesAreAllGivenUp) {
  DecisionRecorder::Global()->Start(100000);
  proto::LoopClosureOptions options = Defaults();
  options.mutable_compatible_subset()->set_min_revisits(50);
  options.mutable_compatible_subset()->set_single_strong(false);
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
  for (const LoopDecision& decision : DecisionRecorder::Global()->All()) {
    EXPECT_NE(decision.verdict(), LoopDecision::UNDECIDED);
  }
}

// A gauge that verification sets at its end and that holds it there.
class BlockingGauge : public cartographer::metrics::Gauge {
 public:
  void Increment() override {}
  void Increment(double) override {}
  void Decrement() override {}
  void Decrement(double) override {}
  void Set(double) override {
    reached_.Notify();
    released_.WaitForNotification();
  }

  void WaitUntilReached() { reached_.WaitForNotification(); }
  void Release() { released_.Notify(); }

 private:
  absl::Notification reached_;
  absl::Notification released_;
};

TEST_F(VerifiedConstraintBuilder2DTest, VerificationHoldsUpNoProposals) {
  cartographer::common::ThreadPool pool(2);
  Builder builder(StockOptions(), Defaults(), &pool);
  Offer(&builder, 0, 0);
  builder.NotifyEndOfNode();
  BlockingGauge gauge;
  auto* const before = ConstraintMetrics::Global()->undecided;
  ConstraintMetrics::Global()->undecided = &gauge;
  absl::Notification called_back;
  builder.WhenDone([&](const Builder::Result&) { called_back.Notify(); });
  gauge.WaitUntilReached();
  absl::Notification returned;
  std::thread thread([&]() {
    EXPECT_EQ(builder.GetNumFinishedNodes(), 1);
    Offer(&builder, 0, 1);
    builder.MaybeAddGlobalConstraint(SubmapId{0, 1}, submaps_[1].get(),
                                     NodeId{0, 1}, &nodes_[1]);
    returned.Notify();
  });
  EXPECT_TRUE(returned.WaitForNotificationWithTimeout(absl::Seconds(60)));
  EXPECT_FALSE(called_back.HasBeenNotified());
  gauge.Release();
  thread.join();
  called_back.WaitForNotification();
  ConstraintMetrics::Global()->undecided = before;
  builder.NotifyEndOfNode();
  Collect(&builder);
  EXPECT_EQ(builder.GetNumFinishedNodes(), 2);
}

TEST_F(VerifiedConstraintBuilder2DTest, FreesDeletedTrajectories) {
  DecisionRecorder::Global()->Start(100000);
  proto::LoopClosureOptions options = Defaults();
  options.mutable_compatible_subset()->set_min_revisits(50);
  options.mutable_compatible_subset()->set_single_strong(false);
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
  for (const LoopDecision& decision : DecisionRecorder::Global()->All()) {
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
TEST_F(VerifiedConstraintBuilder2DTest, WithdrawsTheLoopsOfARunThatWasLost) {
  constexpr int kLastBefore = 9, kFirstAfter = 30, kLastDeleted = 5;
  proto::LoopClosureOptions options = StagesOff();
  options.mutable_localization()->set_enabled(true);
  options.mutable_localization()->set_lost_distance(1.);
  options.mutable_localization()->set_query_spacing(0.05);
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

// The callback uses the builder again, from the pool.
TEST_F(VerifiedConstraintBuilder2DTest, CallbacksMayReenter) {
  for (const int num_threads : {1, 4}) {
    cartographer::common::ThreadPool pool(num_threads);
    Builder builder(StockOptions(), Defaults(), &pool);
    absl::Notification done;
    int next = 0;
    std::function<void(const Builder::Result&)> callback =
        [&](const Builder::Result&) {
          if (next == kNumNodes) {
            builder.DeleteScanMatcher(SubmapId{0, 1});
            done.Notify();
            return;
          }
          for (int k = 0; k < 6; ++k, ++next) {
            for (int s = 0; s < 3; ++s) Offer(&builder, s, next);
            builder.NotifyEndOfNode();
          }
          builder.WhenDone(callback);
        };
    builder.WhenDone(callback);
    done.WaitForNotification();
    EXPECT_EQ(builder.GetNumFinishedNodes(), kNumNodes);
  }
}

TEST_F(VerifiedConstraintBuilder2DTest, SurvivesCallsFromManyThreads) {
  cartographer::common::ThreadPool pool(3);
  MixAllCalls(&pool, 1);
}

TEST_F(VerifiedConstraintBuilder2DTest, SurvivesTasksInAnyOrder) {
  for (const uint64_t seed : {2, 3}) {
    test::RandomOrderPool pool(3, seed);
    MixAllCalls(&pool, seed);
  }
}

TEST_F(VerifiedConstraintBuilder2DTest, OneThreadIsEnough) {
  cartographer::common::ThreadPool pool(1);
  MixAllCalls(&pool, 4);
  test::RandomOrderPool random_pool(1, 5);
  MixAllCalls(&random_pool, 5);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
