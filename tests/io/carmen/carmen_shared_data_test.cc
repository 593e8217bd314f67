// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The benchmark logs as they are.
#include <algorithm>
#include <cmath>
#include <string>

#include "cartographer_ext/io/sensor_source.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

struct Totals {
  SensorSourceInfo info;
  int64_t scans = 0;
  int64_t odometry = 0;
  int64_t inside_scan = 0;
  int64_t no_return = 0;
  LaserScan first_scan;
  LaserScan last_scan;
  bool ordered = true;
};

Totals ReadAll(const std::string& filename,
               const std::string& odometry_source) {
  SensorSourceOptions options;
  options.odometry_source = odometry_source;
  auto source = OpenSensorSource(filename, options);
  Totals totals;
  if (!source.ok()) {
    ADD_FAILURE() << source.status();
    return totals;
  }
  totals.info = (*source)->info();
  SensorEvent event;
  TimeNs last = 0;
  bool last_was_scan = false;
  while (true) {
    const auto more = (*source)->Next(&event);
    EXPECT_TRUE(more.ok()) << more.status();
    if (!more.ok() || !*more) return totals;
    const TimeNs time = EventTime(event);
    const bool is_scan = absl::holds_alternative<LaserScan>(event);
    if (time < last || (time == last && last_was_scan && !is_scan)) {
      totals.ordered = false;
    }
    last = time;
    last_was_scan = is_scan;
    if (is_scan) {
      const LaserScan& scan = absl::get<LaserScan>(event);
      if (totals.scans++ == 0) totals.first_scan = scan;
      totals.last_scan = scan;
      for (const float range : scan.ranges) {
        if (range > scan.range_max) ++totals.no_return;
      }
    } else {
      ++totals.odometry;
      if (absl::get<OdometryReading>(event).inside_scan) ++totals.inside_scan;
    }
  }
}

TEST(CarmenSharedDataTest, Aces) {
  const std::string file = test::SharedData("carmen/aces.clf.xz");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(file);
  const Totals totals = ReadAll(file, "auto");
  EXPECT_TRUE(totals.ordered);
  EXPECT_EQ(totals.scans, 7374);
  EXPECT_EQ(totals.odometry, 7375);
  EXPECT_EQ(totals.inside_scan, 0);
  EXPECT_EQ(totals.info.num_scans, 7374);
  EXPECT_EQ(totals.info.num_odometry, 7375);
  EXPECT_EQ(totals.info.num_out_of_order, 0);
  EXPECT_TRUE(totals.info.warnings.empty());
  EXPECT_EQ(totals.info.begin, 70179699000);
  EXPECT_EQ(totals.info.end, 1435900000000);
  EXPECT_EQ(totals.no_return, 11139);  // Readings of exactly 50 m.
  ASSERT_EQ(totals.first_scan.ranges.size(), 180);
  EXPECT_FLOAT_EQ(totals.first_scan.ranges[0], 46.56f);
  EXPECT_EQ(totals.first_scan.time, 70289900000);
  EXPECT_NEAR(totals.first_scan.angle_min, -M_PI / 2., 1e-12);
  EXPECT_NEAR(totals.first_scan.angle_increment, M_PI / 180., 1e-12);
  EXPECT_FLOAT_EQ(totals.last_scan.ranges.back(), 1.02f);
  EXPECT_EQ(totals.first_scan.laser_pose.x, 0.);
}

TEST(CarmenSharedDataTest, Intel) {
  const std::string file = test::SharedData("carmen/intel.clf.xz");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(file);
  // Stamps out of order: the poses of the scan lines are taken.
  const Totals totals = ReadAll(file, "auto");
  EXPECT_TRUE(totals.ordered);
  EXPECT_EQ(totals.scans, 13631);
  EXPECT_EQ(totals.odometry, 13631);
  EXPECT_EQ(totals.inside_scan, 13631);
  EXPECT_EQ(totals.info.num_out_of_order, 631);
  EXPECT_EQ(totals.no_return, 68313);  // 81.83 m
  const Totals odom = ReadAll(file, "odom");
  EXPECT_TRUE(odom.ordered);
  EXPECT_EQ(odom.odometry, 26915);
  EXPECT_EQ(odom.inside_scan, 0);
  EXPECT_EQ(odom.info.num_out_of_order, 631 + 602);
  const Totals both = ReadAll(file, "both");
  EXPECT_TRUE(both.ordered);
  EXPECT_EQ(both.odometry, 13631 + 26915);
}

TEST(CarmenSharedDataTest, Csail) {
  const std::string file = test::SharedData("carmen/mit-csail.clf.xz");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(file);
  const Totals totals = ReadAll(file, "auto");
  EXPECT_TRUE(totals.ordered);
  EXPECT_EQ(totals.scans, 1988);
  EXPECT_EQ(totals.odometry, 1988);
  EXPECT_EQ(totals.inside_scan, 1988);
  EXPECT_EQ(totals.no_return, 23711);  // 81.91 m
  EXPECT_EQ(totals.first_scan.time, 1134864629895182000);
  ASSERT_EQ(totals.first_scan.ranges.size(), 361);
  EXPECT_NEAR(totals.first_scan.angle_increment, M_PI / 360., 1e-12);
  const Totals odom = ReadAll(file, "odom");
  EXPECT_EQ(odom.scans, 1988);
  EXPECT_EQ(odom.odometry, 0);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
