// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/latency_meter.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

TEST(LatencyMeterTest, NothingYet) {
  const LatencySummary summary = LatencyMeter().Summary();
  EXPECT_EQ(summary.scans, 0);
  EXPECT_EQ(summary.local_slam_max, 0.);
  EXPECT_EQ(summary.max_backlog, 0.);
}

TEST(LatencyMeterTest, ReadingsSinceTheScanBeforeCountForAScan) {
  LatencyMeter meter;
  meter.AddReading(0.002, false);
  meter.AddReading(0.001, true);
  meter.AddReading(0.004, true);
  meter.AddReading(0.5, false);  // for a scan that does not come
  const LatencySummary summary = meter.Summary();
  EXPECT_EQ(summary.scans, 2);
  EXPECT_NEAR(summary.local_slam_p50, 3., 1e-5);
  EXPECT_NEAR(summary.local_slam_max, 4., 1e-5);
}

TEST(LatencyMeterTest, PercentilesByHand) {
  LatencyMeter meter;
  for (int i = 200; i >= 1; --i) meter.AddReading(1e-3 * i, true);
  const LatencySummary summary = meter.Summary();
  EXPECT_NEAR(summary.local_slam_p50, 100., 1e-4);
  EXPECT_NEAR(summary.local_slam_p99, 198., 1e-4);
  EXPECT_NEAR(summary.local_slam_max, 200., 1e-4);
}

TEST(LatencyMeterTest, TheBackEndIsBehindByItsOldestNode) {
  LatencyMeter meter;
  meter.AddNode(1.);
  meter.AddNode(2.);
  meter.AddNode(4.);
  meter.SetQueueLength(2, 4.5);  // that of 2 waits first
  EXPECT_EQ(meter.Summary().max_backlog, 2.5);
  meter.SetQueueLength(1, 5.);
  EXPECT_EQ(meter.Summary().max_backlog, 2.5);
  meter.SetQueueLength(0, 100.);
  EXPECT_EQ(meter.Summary().max_backlog, 2.5);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
