// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Extrapolation at constant velocity. The velocity comes from wheel odometry
// where there is any (at least two readings), else from the two ends of a short
// queue of matched poses. The rotation comes from the gyroscope where there is
// one, else from the same velocity estimate.
#ifndef CARTOGRAPHER_MAPPING_POSE_EXTRAPOLATOR_H_
#define CARTOGRAPHER_MAPPING_POSE_EXTRAPOLATOR_H_

#include <deque>
#include <memory>
#include <vector>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "absl/types/optional.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/imu_tracker.h"
#include "cartographer/mapping/pose_extrapolator_interface.h"
#include "cartographer/sensor/imu_data.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {

class PoseExtrapolator : public PoseExtrapolatorInterface {
 public:
  // The pose queue spans at least `pose_queue_duration` once it has filled.
  explicit PoseExtrapolator(common::Duration pose_queue_duration,
                            double imu_gravity_time_constant);

  PoseExtrapolator(const PoseExtrapolator&) = delete;
  PoseExtrapolator& operator=(const PoseExtrapolator&) = delete;

  // Starts at the origin, upright as `imu_data` measures it.
  static std::unique_ptr<PoseExtrapolator> InitializeWithImu(
      common::Duration pose_queue_duration, double imu_gravity_time_constant,
      const sensor::ImuData& imu_data);

  common::Time GetLastPoseTime() const override;
  common::Time GetLastExtrapolatedTime() const override;

  // IMU and odometry readings older than the newest pose are dropped.
  void AddPose(common::Time time, const transform::Rigid3d& pose) override;
  void AddImuData(const sensor::ImuData& imu_data) override;
  void AddOdometryData(const sensor::OdometryData& odometry_data) override;

  // A pose must have been added, and `time` be neither before it nor before the
  // time of an earlier call that came after it.
  transform::Rigid3d ExtrapolatePose(common::Time time) override;
  ExtrapolationResult ExtrapolatePosesWithGravity(
      const std::vector<common::Time>& times) override;
  Eigen::Quaterniond EstimateGravityOrientation(common::Time time) override;

 private:
  struct TimedPose {
    common::Time time;
    transform::Rigid3d pose;  // (local <- tracking)
  };
  struct Velocity {
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();   // m/s, local frame
    Eigen::Vector3d angular = Eigen::Vector3d::Zero();  // rad/s, body frame
  };

  bool HasPose() const { return !timed_poses_.empty(); }
  const Velocity& BestVelocity() const;
  void UpdateVelocityFromPoses();
  // Needs two readings.
  void UpdateVelocityFromOdometry();
  void DropSupersededReadings();
  // Brings a tracker to `time` by the IMU readings up to then or, where there
  // are none, as of an upright robot that turns at the estimated velocity.
  void AdvanceTracker(common::Time time, ImuTracker* tracker) const;
  // The first reading must not be after `time`.
  void FollowImu(common::Time time, ImuTracker* tracker) const;
  // The turn since the newest pose.
  Eigen::Quaterniond TurnUntil(common::Time time, ImuTracker* tracker) const;

  const common::Duration pose_queue_duration_;
  const double gravity_time_constant_;

  std::deque<TimedPose> timed_poses_;
  std::deque<sensor::ImuData> imu_data_;
  std::deque<sensor::OdometryData> odometry_data_;
  Velocity velocity_from_poses_;
  Velocity velocity_from_odometry_;

  // The first is at the time of the newest pose, its copies run ahead of it.
  std::unique_ptr<ImuTracker> pose_tracker_;
  std::unique_ptr<ImuTracker> odometry_tracker_;
  std::unique_ptr<ImuTracker> extrapolation_tracker_;

  // Many points of a scan share one time.
  absl::optional<TimedPose> last_extrapolated_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_POSE_EXTRAPOLATOR_H_
