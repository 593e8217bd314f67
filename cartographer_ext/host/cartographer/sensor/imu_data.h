// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_IMU_DATA_H_
#define CARTOGRAPHER_SENSOR_IMU_DATA_H_

#include "Eigen/Core"
#include "cartographer/common/time.h"
#include "cartographer/sensor/proto/sensor.pb.h"

namespace cartographer {
namespace sensor {

struct ImuData {
  common::Time time;
  Eigen::Vector3d linear_acceleration;  // m/s^2, tracking frame
  Eigen::Vector3d angular_velocity;     // rad/s, tracking frame
};

proto::ImuData ToProto(const ImuData& imu_data);
ImuData FromProto(const proto::ImuData& proto);

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_IMU_DATA_H_
