// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tools/slam_progress.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace tools {
namespace {

TEST(SlamProgressTest, CountsWhatTheBackEndIsThroughWith) {
  SlamWork work;
  EXPECT_EQ(EstimateSecondsLeft(work, 3.), 0.);
  work.total_scans = 1000;
  work.scans = 250;
  // 10 s for a quarter: 80 s of mapping, a fifth more for the rest.
  EXPECT_NEAR(EstimateSecondsLeft(work, 10.), 86., 1e-9);
  work.judges_map = true;
  EXPECT_NEAR(EstimateSecondsLeft(work, 10.), 122., 1e-9);
  work.scans = 500;
  work.readings_a_scan = 1.;
  work.queue_length = 400;  // 250 scans with their readings
  EXPECT_NEAR(EstimateSecondsLeft(work, 10.), 122., 1e-9);
  // However long the queue, something is done.
  work.queue_length = 1000000;
  EXPECT_LT(EstimateSecondsLeft(work, 10.), 2000.);
  work.queue_length = 0;
  work.scans = 1000;
  EXPECT_NEAR(EstimateSecondsLeft(work, 10.), 6.5, 1e-9);
}

// As recorded: with the back end behind, counting what is fed said 4 s.
TEST(SlamProgressTest, WithinAFactorOfOneAndAHalfOnARecordedRun) {
  SlamWork aces;
  aces.total_scans = 7374;
  aces.readings_a_scan = 1.;
  aces.judges_map = true;
  const struct {
    double elapsed, total;
    int64_t scans, queue;
  } samples[] = {{11.1, 30.1, 5221, 999},
                 {13.6, 30.1, 6290, 999},
                 {16.2, 30.1, 7103, 999}};
  for (const auto& sample : samples) {
    aces.scans = sample.scans;
    aces.queue_length = sample.queue;
    const double left = EstimateSecondsLeft(aces, sample.elapsed);
    EXPECT_LT(left, 1.5 * (sample.total - sample.elapsed)) << sample.elapsed;
    EXPECT_GT(left, (sample.total - sample.elapsed) / 1.5) << sample.elapsed;
  }
}

}  // namespace
}  // namespace tools
}  // namespace cartographer_ext
