// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/beam_order.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "Eigen/Geometry"
#include "absl/memory/memory.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/sensor/range_data.h"
#include "gtest/gtest.h"
#include "tests/front_end/dropin/simulated_drive.h"
#include "tests/front_end/dropin/simulated_room.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::sensor::TimedPointCloudData;
using cartographer::sensor::TimedPointCloudOriginData;

constexpr double kPeriod = 0.1;  // seconds
constexpr double kRate = 0.9;    // radians a second

// Of a robot that turns on the spot, in the middle of a scan; the time of a beam
// after it in periods by its share of the turn. Beams begin ahead.
TimedPointCloudData TurningScan(const double heading, const double direction,
                                Random* const random) {
  TimedPointCloudData data;
  data.origin = Eigen::Vector3f::Zero();
  for (int i = 0; i < 360; ++i) {
    const double bearing = DegToRad(i);
    const double time = direction * (i / 360. - 0.5) * kPeriod;
    const double range = test::Cast(test::Room(), Eigen::Vector2d(-0.5, 0.2),
                                    heading + kRate * time + bearing) +
                         random->Normal(0., 0.01);
    cartographer::sensor::TimedRangefinderPoint point;
    point.position = Eigen::Vector3f(range * std::cos(bearing),
                                     range * std::sin(bearing), 0.f);
    point.time = 0.f;
    data.ranges.push_back(point);
  }
  return data;
}

// As the collator leaves it: points of one time in any order.
TimedPointCloudOriginData ToSweep(const TimedPointCloudData& scan) {
  TimedPointCloudOriginData sweep;
  sweep.origins = {scan.origin};
  for (const auto& point : scan.ranges) {
    sweep.ranges.push_back({point, 0.f, 0});
  }
  std::reverse(sweep.ranges.begin(), sweep.ranges.end());
  return sweep;
}

class BeamOrderTest : public ::testing::Test {
 protected:
  BeamOrderTest()
      : options_(test::StockOptions()),
        submaps_(options_.submaps_options()),
        learner_(absl::make_unique<BeamOrderLearner>(options_, true)) {
    const Pose2 pose(-0.5, 0.2, 0.);
    for (int i = 0; i < 20; ++i) {
      cartographer::sensor::RangeData range_data;
      range_data.origin = Eigen::Vector3f(-0.5f, 0.2f, 0.f);
      for (const auto& point :
           test::Scan(test::Room(), 0., pose, 20., &random_).ranges) {
        range_data.returns.push_back(
            {point.position + Eigen::Vector3f(-0.5f, 0.2f, 0.f)});
      }
      submaps_.InsertRangeData(range_data);
    }
  }

  // Turns until it is sure, through `seconds` at most. Returns the last sweep.
  TimedPointCloudOriginData Turn(const double direction, const double seconds) {
    TimedPointCloudOriginData sweep;
    for (double time = 0.; time < seconds; time += kPeriod) {
      const double heading = kRate * time;
      const auto scan = TurningScan(heading, direction, &random_);
      sweep = ToSweep(scan);
      learner_->SetTimes(scan, kPeriod, &sweep);
      learner_->Learn(sweep, kPeriod, Pose2(0., 0., kRate * kPeriod),
                      Eigen::Quaterniond::Identity(), Pose2(-0.5, 0.2, heading),
                      *submaps_.submaps().front());
    }
    return sweep;
  }

  const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D options_;
  cartographer::mapping::ActiveSubmaps2D submaps_;
  std::unique_ptr<BeamOrderLearner> learner_;
  Random random_{4};
};

TEST_F(BeamOrderTest, OfALaserThatTurnsCounterclockwise) {
  const TimedPointCloudOriginData sweep = Turn(1., 5.);
  EXPECT_EQ(learner_->order(), BeamOrder::kCounterclockwise);
  // The last beam is the first of the sweep.
  EXPECT_NEAR(sweep.ranges.front().point_time.time, 0.5 * kPeriod, 1e-3);
  EXPECT_NEAR(sweep.ranges.back().point_time.time, -0.5 * kPeriod, 1e-3);
}

TEST_F(BeamOrderTest, OfALaserThatTurnsClockwise) {
  const TimedPointCloudOriginData sweep = Turn(-1., 5.);
  EXPECT_EQ(learner_->order(), BeamOrder::kClockwise);
  EXPECT_NEAR(sweep.ranges.front().point_time.time, -0.5 * kPeriod, 1e-3);
}

TEST_F(BeamOrderTest, OfALaserThatMeasuresAtOnce) {
  const TimedPointCloudOriginData sweep = Turn(0., 30.);
  EXPECT_EQ(learner_->order(), BeamOrder::kAtOnce);
  EXPECT_EQ(sweep.ranges.front().point_time.time, 0.f);
}

TEST_F(BeamOrderTest, IsNotLearntWhereTheOptionsSayNo) {
  learner_ = absl::make_unique<BeamOrderLearner>(options_, false);
  const TimedPointCloudOriginData sweep = Turn(1., 5.);
  EXPECT_EQ(learner_->order(), BeamOrder::kAtOnce);
  EXPECT_EQ(sweep.ranges.front().point_time.time, 0.f);
}

TEST_F(BeamOrderTest, TimesOfTheRecordingStay) {
  for (double time = 0.; time < 5.; time += kPeriod) {
    auto scan = TurningScan(kRate * time, 1., &random_);
    scan.ranges.front().time = -0.07f;
    TimedPointCloudOriginData sweep = ToSweep(scan);
    learner_->SetTimes(scan, kPeriod, &sweep);
    EXPECT_EQ(sweep.ranges.back().point_time.time, -0.07f);
    EXPECT_EQ(sweep.ranges.front().point_time.time, 0.f);
    learner_->Learn(sweep, kPeriod, Pose2(0., 0., kRate * kPeriod),
                    Eigen::Quaterniond::Identity(),
                    Pose2(-0.5, 0.2, kRate * time),
                    *submaps_.submaps().front());
  }
  EXPECT_EQ(learner_->order(), BeamOrder::kAtOnce);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
