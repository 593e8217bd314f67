// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/stored_gyroscope.h"

#include <cmath>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/host_ticks.h"
#include "cartographer_ext/common/pose2.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace repair {
namespace {

using cartographer::sensor::ImuData;
using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

cartographer::common::Time At(const double seconds) {
  return cartographer::common::FromUniversal(0) +
         cartographer::common::FromSeconds(1000. + seconds);
}

// A map of nodes and options alone.
class StoredGyroscopeTest : public testing::Test {
 protected:
  StoredGyroscopeTest() { UseImu(true); }

  void UseImu(const bool use_imu) {
    map_.options.clear_options_with_sensor_ids();
    map_.options.add_options_with_sensor_ids()
        ->mutable_trajectory_builder_options()
        ->mutable_trajectory_builder_2d_options()
        ->set_use_imu_data(use_imu);
  }

  void AddNode(const double seconds, const double yaw, const double roll = 0.) {
    cartographer::mapping::proto::Node node;
    node.mutable_node_id()->set_node_index(map_.nodes.size());
    auto* const data = node.mutable_node_data();
    data->set_timestamp(cartographer::common::ToUniversal(At(seconds)));
    *data->mutable_gravity_alignment() = cartographer::transform::ToProto(
        Quaterniond(AngleAxisd(yaw, Vector3d::UnitZ()) *
                    AngleAxisd(roll, Vector3d::UnitX())));
    map_.nodes.push_back(node);
  }

  io::Pbstream map_;
};

// Integrated as by the front end.
double Integral(const std::vector<ImuData>& readings, const double from,
                const double to) {
  double angle = 0.;
  for (size_t i = 1; i < readings.size(); ++i) {
    if (readings[i - 1].time < At(from) || readings[i].time > At(to)) continue;
    angle += 0.5 *
             (readings[i - 1].angular_velocity.z() +
              readings[i].angular_velocity.z()) *
             cartographer::common::ToSeconds(readings[i].time -
                                             readings[i - 1].time);
  }
  return angle;
}

TEST_F(StoredGyroscopeTest, TheIntegralIsTheRotationBetweenNodes) {
  const double times[] = {0., 0.4, 5.4, 5.5, 6.5};
  const double yaws[] = {1., 1.2, 3.1, -3.1, -3.1};
  for (int i = 0; i < 5; ++i) AddNode(times[i], yaws[i], i % 2 == 0 ? 0. : 0.2);
  const auto all = StoredGyroscopeReadings(map_);
  ASSERT_EQ(all.size(), 1u);
  const std::vector<ImuData>& readings = all.at(0);
  EXPECT_EQ(readings.front().time, At(0.));
  EXPECT_EQ(readings.back().time, At(6.5));
  for (int i = 1; i < 5; ++i) {
    EXPECT_NEAR(Integral(readings, times[i - 1], times[i]),
                NormalizeAngle(yaws[i] - yaws[i - 1]), 1e-6);
  }
  for (size_t i = 1; i < readings.size(); ++i) {
    EXPECT_GT(readings[i].time, readings[i - 1].time);
    EXPECT_LE(readings[i].time,
              readings[i - 1].time + cartographer::common::FromSeconds(0.0501));
    EXPECT_EQ(readings[i].linear_acceleration, 9.80665 * Vector3d::UnitZ());
  }
}

TEST_F(StoredGyroscopeTest, NodesInAnyOrder) {
  AddNode(1., 0.5);
  AddNode(0., 0.1);
  EXPECT_NEAR(Integral(StoredGyroscopeReadings(map_).at(0), 0., 1.), 0.4, 1e-6);
}

// A robot that was switched off between two nodes, and damaged stamps as far
// apart as the reader allows.
TEST_F(StoredGyroscopeTest, NodesThatAreFarApartAreFewReadings) {
  constexpr double kTenDays = 10. * 24. * 3600.;
  AddNode(0., 0.1);
  AddNode(1., 0.5);
  AddNode(1. + kTenDays, 1.5);
  const auto all = StoredGyroscopeReadings(map_);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NEAR(Integral(all.at(0), 0., 1.), 0.4, 1e-6);
  EXPECT_NEAR(Integral(all.at(0), 1., 1. + kTenDays), 1., 1e-6);
  EXPECT_LE(all.at(0).size(), 2000u);
  map_.nodes.front().mutable_node_data()->set_timestamp(0);
  map_.nodes.back().mutable_node_data()->set_timestamp(kMaxHostTicks);
  const auto damaged = StoredGyroscopeReadings(map_);
  ASSERT_EQ(damaged.size(), 1u);
  EXPECT_LE(damaged.at(0).size(), 3000u);
  for (size_t i = 1; i < damaged.at(0).size(); ++i)
    EXPECT_GE(damaged.at(0)[i].time, damaged.at(0)[i - 1].time);
}

// Without an IMU Cartographer integrates odometry or matches instead.
TEST_F(StoredGyroscopeTest, WithoutAnImuThereIsNone) {
  UseImu(false);
  AddNode(0., 0.1);
  AddNode(1., 0.5);
  EXPECT_TRUE(StoredGyroscopeReadings(map_).empty());
  map_.options.clear_options_with_sensor_ids();
  EXPECT_TRUE(StoredGyroscopeReadings(map_).empty());
}

TEST_F(StoredGyroscopeTest, AnAlignmentThatDoesNotTurnTellsNothing) {
  AddNode(0., 0., 0.1);
  AddNode(1., 0.001, 0.2);
  EXPECT_TRUE(StoredGyroscopeReadings(map_).empty());
}

TEST_F(StoredGyroscopeTest, MapsOfOneOrNoNode) {
  EXPECT_TRUE(StoredGyroscopeReadings(map_).empty());
  AddNode(0., 0.1);
  EXPECT_TRUE(StoredGyroscopeReadings(map_).empty());
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
