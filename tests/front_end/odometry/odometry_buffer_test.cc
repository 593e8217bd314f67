// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_buffer.h"

#include <limits>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

TEST(OdometryBufferTest, NothingWithoutReadings) {
  OdometryBuffer buffer(10., 100, 0.3);
  OdometrySample sample;
  EXPECT_FALSE(buffer.Lookup(1., &sample));
}

TEST(OdometryBufferTest, InterpolatesTheShortWay) {
  OdometryBuffer buffer(10., 100, 0.3);
  EXPECT_TRUE(buffer.Add(1., Pose2(0., 0., 3.)));
  EXPECT_TRUE(buffer.Add(2., Pose2(4., -2., -3.)));
  OdometrySample sample;
  ASSERT_TRUE(buffer.Lookup(1.25, &sample));
  EXPECT_DOUBLE_EQ(sample.pose.x, 1.);
  EXPECT_DOUBLE_EQ(sample.pose.y, -0.5);
  // From 3 to -3 it is 0.2832 rad over pi, not 6 in the other direction.
  EXPECT_NEAR(sample.pose.theta, 3. + 0.25 * (2. * kPi - 6.), 1e-12);
  EXPECT_EQ(sample.extrapolated, 0.);
  EXPECT_FALSE(sample.frozen);
}

TEST(OdometryBufferTest, GoesOnWithTheLastVelocityForABoundedTime) {
  OdometryBuffer buffer(10., 100, 0.3);
  buffer.Add(0., Pose2(0., 0., 0.));
  buffer.Add(0.1, Pose2(0.1, 0., 0.));
  OdometrySample sample;
  ASSERT_TRUE(buffer.Lookup(0.2, &sample));
  EXPECT_NEAR(sample.pose.x, 0.2, 1e-12);
  EXPECT_NEAR(sample.extrapolated, 0.1, 1e-12);
  ASSERT_TRUE(buffer.Lookup(5., &sample));
  EXPECT_NEAR(sample.pose.x, 0.4, 1e-12);  // 0.3 s at 1 m/s
  EXPECT_NEAR(sample.extrapolated, 4.9, 1e-12);
}

TEST(OdometryBufferTest, StepsLeadFromTheStartToTheEnd) {
  OdometryBuffer buffer(100., 1000, 0.3);
  EXPECT_TRUE(buffer.Steps(0., 1.).empty());
  for (int i = 0; i <= 4; ++i) buffer.Add(i, Pose2(i, 0., 0.));
  const std::vector<Pose2> steps = buffer.Steps(0.75, 3.5);
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_NEAR(steps[0].x, 0.25, 1e-12);
  EXPECT_NEAR(steps[1].x, 1., 1e-12);
  EXPECT_NEAR(steps[2].x, 1., 1e-12);
  EXPECT_NEAR(steps[3].x, 0.5, 1e-12);
  // Between two readings.
  ASSERT_EQ(buffer.Steps(1.25, 1.5).size(), 1u);
  EXPECT_NEAR(buffer.Steps(1.25, 1.5).front().x, 0.25, 1e-12);
}

TEST(OdometryBufferTest, AJumpIsFarAndFast) {
  OdometryBuffer buffer(10., 100, 0.3);
  buffer.Add(1., Pose2(0., 0., 0.));
  buffer.Add(2., Pose2(1., 0., 0.));
  buffer.Add(2.1, Pose2(1.2, 0., 0.));
  buffer.Add(2.2, Pose2(1.2, 0., 0.5));
  const OdometryJump jump = {0.3, 0.3, 1.1, 1.};
  // 1 m in a second is slow enough, 0.2 m in a tenth too near.
  EXPECT_FALSE(buffer.HasJump(0., 2.1, jump));
  EXPECT_TRUE(buffer.HasJump(0., 2.15, jump));
  EXPECT_TRUE(buffer.HasJump(2.15, 2.18, jump));
  EXPECT_FALSE(buffer.HasJump(2.2, 5., jump));
  EXPECT_TRUE(buffer.HasJump(1.5, 1.6, {0.3, 0.3, 0.9, 1.}));
  EXPECT_FALSE(OdometryBuffer(10., 100, 0.3).HasJump(0., 1., jump));
}

TEST(OdometryBufferTest, TellsHowOftenAReadingComes) {
  OdometryBuffer buffer(100., 100, 0.3);
  EXPECT_EQ(buffer.MedianInterval(), 0.);
  buffer.Add(0., Pose2());
  EXPECT_EQ(buffer.MedianInterval(), 0.);
  buffer.Add(3., Pose2());
  EXPECT_DOUBLE_EQ(buffer.MedianInterval(), 3.);
  // One gap among many does not count.
  for (int i = 1; i <= 20; ++i)
    buffer.Add(3. + 0.4 * i, Pose2(0.2 * i, 0., 0.));
  EXPECT_NEAR(buffer.MedianInterval(), 0.4, 1e-9);
  // Readings that are that rare are extrapolated by one interval.
  OdometrySample sample;
  ASSERT_TRUE(buffer.Lookup(11.4, &sample));
  EXPECT_NEAR(sample.pose.x, 4.2, 1e-9);
}

TEST(OdometryBufferTest, TheFirstReadingStandsForTheTimeBefore) {
  OdometryBuffer buffer(10., 100, 0.3);
  buffer.Add(3., Pose2(1., 2., 0.5));
  OdometrySample sample;
  ASSERT_TRUE(buffer.Lookup(1., &sample));
  EXPECT_EQ(sample.pose.x, 1.);
  EXPECT_DOUBLE_EQ(sample.extrapolated, 2.);
}

TEST(OdometryBufferTest, TellsRepeatedPoses) {
  OdometryBuffer buffer(10., 100, 0.3);
  buffer.Add(0., Pose2(0., 0., 0.));
  buffer.Add(1., Pose2(1., 0., 0.));
  buffer.Add(2., Pose2(1., 0., 0.));
  OdometrySample sample;
  buffer.Lookup(0.5, &sample);
  EXPECT_FALSE(sample.frozen);
  buffer.Lookup(1.5, &sample);
  EXPECT_TRUE(sample.frozen);
  buffer.Lookup(2.5, &sample);
  EXPECT_TRUE(sample.frozen);
}

TEST(OdometryBufferTest, RefusesLateAndBrokenReadings) {
  OdometryBuffer buffer(10., 100, 0.3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(buffer.Add(1., Pose2()));
  EXPECT_FALSE(buffer.Add(1., Pose2(1., 0., 0.)));
  EXPECT_FALSE(buffer.Add(0.5, Pose2(1., 0., 0.)));
  EXPECT_FALSE(buffer.Add(2., Pose2(nan, 0., 0.)));
  EXPECT_FALSE(buffer.Add(nan, Pose2()));
  EXPECT_EQ(buffer.last_time(), 1.);
}

TEST(OdometryBufferTest, ForgetsWhatIsOld) {
  OdometryBuffer by_time(1., 1000, 0.3);
  OdometryBuffer by_number(1000., 5, 0.3);
  for (int i = 0; i <= 100; ++i) {
    by_time.Add(0.1 * i, Pose2(i, 0., 0.));
    by_number.Add(0.1 * i, Pose2(i, 0., 0.));
  }
  // The reading before the last second is kept, so that all of it is known.
  EXPECT_NEAR(by_time.first_time(), 9., 0.1001);
  EXPECT_EQ(by_number.first_time(), 0.);
}

// Half an hour without a lookup: the readings are thinned, the older the more,
// and a motion over all of it is still known.
TEST(OdometryBufferTest, ThinsWhatIsTooMuch) {
  OdometryBuffer buffer(3600., 1000, 0.3);
  for (int i = 0; i <= 40000; ++i) {
    const double time = 0.05 * i;
    buffer.Add(time, Pose2(0.7 * time, 0., 0.));
  }
  EXPECT_EQ(buffer.first_time(), 0.);
  EXPECT_NEAR(buffer.MedianInterval(), 0.05, 1e-9);
  OdometrySample begin, end;
  ASSERT_TRUE(buffer.Lookup(12.34, &begin));
  ASSERT_TRUE(buffer.Lookup(1999.01, &end));
  EXPECT_EQ(begin.extrapolated, 0.);
  EXPECT_NEAR(begin.pose.x, 0.7 * 12.34, 1e-6);
  EXPECT_NEAR(end.pose.x - begin.pose.x, 0.7 * (1999.01 - 12.34), 1e-6);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
