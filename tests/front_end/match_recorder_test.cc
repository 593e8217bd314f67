// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/match_recorder.h"

#include <thread>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

proto::MatchRecord Record(const int64_t time) {
  proto::MatchRecord record;
  record.set_time(time);
  return record;
}

TEST(MatchRecorderTest, KeepsNothingUntilStarted) {
  MatchRecorder recorder;
  EXPECT_FALSE(recorder.started());
  recorder.Record(Record(1));
  EXPECT_TRUE(recorder.All().empty());
  EXPECT_EQ(recorder.num_dropped(), 0);
}

TEST(MatchRecorderTest, KeepsUpToItsCapacityAndCountsTheRest) {
  MatchRecorder recorder;
  recorder.Start(2);
  for (int i = 0; i < 5; ++i) recorder.Record(Record(i));
  const std::vector<proto::MatchRecord> all = recorder.All();
  ASSERT_EQ(all.size(), 2);
  EXPECT_EQ(all[1].time(), 1);
  EXPECT_EQ(recorder.num_dropped(), 3);
  recorder.Stop();
  EXPECT_TRUE(recorder.All().empty());
  recorder.Start(10);
  EXPECT_EQ(recorder.num_dropped(), 0);
}

TEST(MatchRecorderTest, NumbersBuilders) {
  MatchRecorder recorder;
  EXPECT_EQ(recorder.AddBuilder(), 0);
  EXPECT_EQ(recorder.AddBuilder(), 1);
  EXPECT_EQ(MatchRecorder().AddBuilder(), 0);
}

TEST(MatchRecorderTest, SeveralThreads) {
  MatchRecorder recorder;
  recorder.Start(1000);
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&recorder] {
      for (int j = 0; j < 100; ++j) recorder.Record(Record(j));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(recorder.All().size(), 400);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
