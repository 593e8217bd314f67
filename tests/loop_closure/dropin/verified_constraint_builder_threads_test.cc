// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The constraint builder on several threads: the same results for any number,
// no call waits for verification that need not, calls in any order are safe.
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "absl/synchronization/notification.h"
#include "absl/time/time.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/dropin/random_order_pool.h"
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

class VerifiedConstraintBuilderThreadsTest
    : public test::VerifiedConstraintBuilderRoom {
 protected:
  struct Run {
    std::vector<Builder::Result> results;
    DecisionRecorder::Decisions records;
  };

  Run DriveAlone(const LoopOptions& options, const int num_threads) {
    const auto context = std::make_shared<PoseGraphContext>();
    const ScopedPoseGraphContext scope(context);
    DecisionRecorder* const recorder = context->Get<DecisionRecorder>();
    recorder->Start(100000);
    Run run;
    {
      cartographer::common::ThreadPool pool(num_threads);
      Builder builder(StockOptions(), options, &pool);
      run.results = Drive(&builder);
    }
    run.records = recorder->All();
    return run;
  }

  static void ExpectSame(const Run& run, const Run& expected) {
    ASSERT_EQ(run.records.size(), expected.records.size());
    for (size_t i = 0; i < run.records.size(); ++i) {
      EXPECT_EQ(run.records[i].SerializeAsString(),
                expected.records[i].SerializeAsString());
    }
    ASSERT_EQ(run.results.size(), expected.results.size());
    for (size_t r = 0; r < run.results.size(); ++r) {
      ASSERT_EQ(run.results[r].size(), expected.results[r].size());
      for (size_t i = 0; i < run.results[r].size(); ++i) {
        EXPECT_EQ(run.results[r][i].pose.zbar_ij.translation(),
                  expected.results[r][i].pose.zbar_ij.translation());
        EXPECT_EQ(run.results[r][i].node_id, expected.results[r][i].node_id);
      }
    }
  }

  // All calls from several threads at once, in any order; nothing is asked but
  // that everything is called back and counted, and that nothing of a submap
  // that is deleted meanwhile is missed.
  void MixAllCalls(cartographer::common::ThreadPoolInterface* const pool,
                   const uint64_t seed) {
    Builder builder(StockOptions(), LoopOptions(), pool);
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
};

TEST_F(VerifiedConstraintBuilderThreadsTest, TheSameForAnyNumberOfThreads) {
  const Run one = DriveAlone(LoopOptions(), 1);
  for (const int num_threads : {2, 8}) {
    ExpectSame(DriveAlone(LoopOptions(), num_threads), one);
  }
}

TEST_F(VerifiedConstraintBuilderThreadsTest, TheSameForAnyLimitOfTheCache) {
  const Run unlimited = DriveAlone(LoopOptions(), 2);
  EXPECT_FALSE(unlimited.records.empty());
  // Nothing, a view or two, a matcher or two.
  for (const size_t max_bytes : {0, 40000, 300000}) {
    LoopOptions options;
    options.max_cache_bytes = max_bytes;
    ExpectSame(DriveAlone(options, 2), unlimited);
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

TEST_F(VerifiedConstraintBuilderThreadsTest, VerificationHoldsUpNoProposals) {
  cartographer::common::ThreadPool pool(2);
  Builder builder(StockOptions(), LoopOptions(), &pool);
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

// The callback uses the builder again, from the pool.
TEST_F(VerifiedConstraintBuilderThreadsTest, CallbacksMayReenter) {
  for (const int num_threads : {1, 4}) {
    cartographer::common::ThreadPool pool(num_threads);
    Builder builder(StockOptions(), LoopOptions(), &pool);
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

TEST_F(VerifiedConstraintBuilderThreadsTest, SurvivesCallsFromManyThreads) {
  cartographer::common::ThreadPool pool(3);
  MixAllCalls(&pool, 1);
}

TEST_F(VerifiedConstraintBuilderThreadsTest, SurvivesTasksInAnyOrder) {
  for (const uint64_t seed : {2, 3}) {
    test::RandomOrderPool pool(3, seed);
    MixAllCalls(&pool, seed);
  }
}

TEST_F(VerifiedConstraintBuilderThreadsTest, OneThreadIsEnough) {
  cartographer::common::ThreadPool pool(1);
  MixAllCalls(&pool, 4);
  test::RandomOrderPool random_pool(1, 5);
  MixAllCalls(&random_pool, 5);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
