// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Predicts where the robot is between two matched scans.
#ifndef CARTOGRAPHER_MAPPING_POSE_EXTRAPOLATOR_INTERFACE_H_
#define CARTOGRAPHER_MAPPING_POSE_EXTRAPOLATOR_INTERFACE_H_

#include <memory>
#include <vector>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/proto/pose_extrapolator_options.pb.h"
#include "cartographer/sensor/imu_data.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/timestamped_transform.h"

namespace cartographer {
namespace mapping {

// Reads the table `pose_extrapolator`.
proto::PoseExtrapolatorOptions CreatePoseExtrapolatorOptions(
    common::LuaParameterDictionary* const parameter_dictionary);

class PoseExtrapolatorInterface {
 public:
  struct ExtrapolationResult {
    // (local <- tracking) for all but the last of the times asked for.
    std::vector<transform::Rigid3f> previous_poses;
    // The same for the last one, and the velocity there.
    transform::Rigid3d current_pose;
    Eigen::Vector3d current_velocity;  // m/s in the local frame
    Eigen::Quaterniond gravity_from_tracking;
  };

  PoseExtrapolatorInterface(const PoseExtrapolatorInterface&) = delete;
  PoseExtrapolatorInterface& operator=(const PoseExtrapolatorInterface&) =
      delete;
  virtual ~PoseExtrapolatorInterface() {}

  // Needs at least one IMU reading. The host extrapolates at constant velocity;
  // options that ask for the IMU-based method are a fatal error.
  static std::unique_ptr<PoseExtrapolatorInterface> CreateWithImuData(
      const proto::PoseExtrapolatorOptions& options,
      const std::vector<sensor::ImuData>& imu_data,
      const std::vector<transform::TimestampedTransform>& initial_poses);

  // Time::min() where there is none yet.
  virtual common::Time GetLastPoseTime() const = 0;
  virtual common::Time GetLastExtrapolatedTime() const = 0;

  // Times must not go backwards, each of them for its own kind of data.
  virtual void AddPose(common::Time time, const transform::Rigid3d& pose) = 0;
  virtual void AddImuData(const sensor::ImuData& imu_data) = 0;
  virtual void AddOdometryData(const sensor::OdometryData& odometry_data) = 0;
  virtual transform::Rigid3d ExtrapolatePose(common::Time time) = 0;
  virtual ExtrapolationResult ExtrapolatePosesWithGravity(
      const std::vector<common::Time>& times) = 0;

  // (gravity aligned <- tracking)
  virtual Eigen::Quaterniond EstimateGravityOrientation(common::Time time) = 0;

 protected:
  PoseExtrapolatorInterface() {}
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_POSE_EXTRAPOLATOR_INTERFACE_H_
