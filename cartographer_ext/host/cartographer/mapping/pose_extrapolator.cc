// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/pose_extrapolator.h"

#include <algorithm>

#include "absl/memory/memory.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

// Drops readings that are no longer needed: all but the last at or before
// `time`, as long as `keep` remain.
template <typename Reading>
void DropOlderThan(const common::Time time, const size_t keep,
                   std::deque<Reading>* const readings) {
  while (readings->size() > keep && (*readings)[1].time <= time) {
    readings->pop_front();
  }
}

// Whether a reading of this time continues what is known.
template <typename Reading>
bool IsLate(const common::Time time, const common::Time newest_pose_time,
            const std::deque<Reading>& readings) {
  return time < std::max(newest_pose_time, readings.empty()
                                               ? common::Time::min()
                                               : readings.back().time);
}

void AddReading(const sensor::ImuData& reading, ImuTracker* const tracker) {
  tracker->Advance(reading.time);
  tracker->AddImuLinearAccelerationObservation(reading.linear_acceleration);
  tracker->AddImuAngularVelocityObservation(reading.angular_velocity);
}

// The mean rotation rate of a body that turned by `rotation`.
Eigen::Vector3d AngularVelocity(const Eigen::Quaterniond& rotation,
                                const double seconds) {
  return transform::RotationQuaternionToAngleAxisVector(rotation) / seconds;
}

}  // namespace

PoseExtrapolator::PoseExtrapolator(const common::Duration pose_queue_duration,
                                   const double imu_gravity_time_constant)
    : pose_queue_duration_(pose_queue_duration),
      gravity_time_constant_(imu_gravity_time_constant) {}

std::unique_ptr<PoseExtrapolator> PoseExtrapolator::InitializeWithImu(
    const common::Duration pose_queue_duration,
    const double imu_gravity_time_constant, const sensor::ImuData& imu_data) {
  auto extrapolator = absl::make_unique<PoseExtrapolator>(
      pose_queue_duration, imu_gravity_time_constant);
  extrapolator->AddImuData(imu_data);
  auto tracker =
      absl::make_unique<ImuTracker>(imu_gravity_time_constant, imu_data.time);
  AddReading(imu_data, tracker.get());
  const auto upright = transform::Rigid3d::Rotation(tracker->orientation());
  extrapolator->pose_tracker_ = std::move(tracker);
  extrapolator->AddPose(imu_data.time, upright);
  return extrapolator;
}

common::Time PoseExtrapolator::GetLastPoseTime() const {
  return HasPose() ? timed_poses_.back().time : common::Time::min();
}

common::Time PoseExtrapolator::GetLastExtrapolatedTime() const {
  return extrapolation_tracker_ != nullptr ? extrapolation_tracker_->time()
                                           : common::Time::min();
}

void PoseExtrapolator::AddPose(const common::Time time,
                               const transform::Rigid3d& pose) {
  if (pose_tracker_ == nullptr) {
    const common::Time start =
        imu_data_.empty() ? time : std::min(time, imu_data_.front().time);
    pose_tracker_ =
        absl::make_unique<ImuTracker>(gravity_time_constant_, start);
  }
  timed_poses_.push_back(TimedPose{time, pose});
  // Two poses are always kept, so that there is a velocity.
  DropOlderThan(time - pose_queue_duration_, 2, &timed_poses_);
  UpdateVelocityFromPoses();
  AdvanceTracker(time, pose_tracker_.get());
  DropSupersededReadings();
  odometry_tracker_ = absl::make_unique<ImuTracker>(*pose_tracker_);
  extrapolation_tracker_ = absl::make_unique<ImuTracker>(*pose_tracker_);
}

void PoseExtrapolator::AddImuData(const sensor::ImuData& imu_data) {
  if (IsLate(imu_data.time, GetLastPoseTime(), imu_data_)) {
    LOG_EVERY_N(WARNING, 100) << "dropped a late IMU reading";
    return;
  }
  imu_data_.push_back(imu_data);
  DropSupersededReadings();
}

void PoseExtrapolator::AddOdometryData(
    const sensor::OdometryData& odometry_data) {
  const bool repeated = !odometry_data_.empty() &&
                        odometry_data_.back().time == odometry_data.time;
  if (repeated ||
      IsLate(odometry_data.time, GetLastPoseTime(), odometry_data_)) {
    LOG_EVERY_N(WARNING, 100) << "dropped a late odometry reading";
    return;
  }
  odometry_data_.push_back(odometry_data);
  DropSupersededReadings();
  if (odometry_data_.size() > 1) {
    UpdateVelocityFromOdometry();
  }
}

transform::Rigid3d PoseExtrapolator::ExtrapolatePose(const common::Time time) {
  if (last_extrapolated_.has_value() && last_extrapolated_->time == time) {
    return last_extrapolated_->pose;
  }
  CHECK(HasPose());
  const TimedPose& newest = timed_poses_.back();
  CHECK_GE(time, newest.time);
  const double seconds = common::ToSeconds(time - newest.time);
  const Eigen::Vector3d translation =
      seconds * BestVelocity().linear + newest.pose.translation();
  const Eigen::Quaterniond rotation =
      newest.pose.rotation() * TurnUntil(time, extrapolation_tracker_.get());
  last_extrapolated_ =
      TimedPose{time, transform::Rigid3d(translation, rotation)};
  return last_extrapolated_->pose;
}

PoseExtrapolator::ExtrapolationResult
PoseExtrapolator::ExtrapolatePosesWithGravity(
    const std::vector<common::Time>& times) {
  CHECK(!times.empty());
  ExtrapolationResult result;
  result.previous_poses.reserve(times.size() - 1);
  for (size_t i = 0; i + 1 < times.size(); ++i) {
    result.previous_poses.push_back(ExtrapolatePose(times[i]).cast<float>());
  }
  result.current_pose = ExtrapolatePose(times.back());
  result.current_velocity = BestVelocity().linear;
  result.gravity_from_tracking = EstimateGravityOrientation(times.back());
  return result;
}

Eigen::Quaterniond PoseExtrapolator::EstimateGravityOrientation(
    const common::Time time) {
  CHECK(pose_tracker_ != nullptr);
  ImuTracker tracker = *pose_tracker_;
  AdvanceTracker(time, &tracker);
  return tracker.orientation();
}

const PoseExtrapolator::Velocity& PoseExtrapolator::BestVelocity() const {
  return odometry_data_.size() < 2 ? velocity_from_poses_
                                   : velocity_from_odometry_;
}

void PoseExtrapolator::UpdateVelocityFromPoses() {
  const TimedPose& oldest = timed_poses_.front();
  const TimedPose& newest = timed_poses_.back();
  const common::Duration span = newest.time - oldest.time;
  // The first scan comes at the time of the first pose, as expected.
  if (span == common::Duration::zero()) {
    return;
  }
  if (span < pose_queue_duration_) {
    LOG_EVERY_N(WARNING, 100) << "poses span only " << common::ToSeconds(span)
                              << " s, too short for a velocity";
    return;
  }
  const double seconds = common::ToSeconds(span);
  const Eigen::Vector3d distance =
      newest.pose.translation() - oldest.pose.translation();
  velocity_from_poses_ = Velocity{
      distance / seconds,
      AngularVelocity(oldest.pose.rotation().inverse() * newest.pose.rotation(),
                      seconds)};
}

void PoseExtrapolator::UpdateVelocityFromOdometry() {
  const sensor::OdometryData& newest = odometry_data_.back();
  const sensor::OdometryData& oldest = odometry_data_.front();
  const double seconds = common::ToSeconds(newest.time - oldest.time);
  // The previous pose in the newest tracking frame, which gives the negative
  // velocity in that frame.
  const transform::Rigid3d origin = newest.pose.inverse() * oldest.pose;
  velocity_from_odometry_.angular =
      -AngularVelocity(origin.rotation(), seconds);
  if (HasPose()) {
    // The tracker must receive the new rotation rate before it predicts.
    const Eigen::Quaterniond turn =
        TurnUntil(newest.time, odometry_tracker_.get());
    velocity_from_odometry_.linear =
        (timed_poses_.back().pose.rotation() * turn) *
        Eigen::Vector3d(-origin.translation() / seconds);
  }
}

void PoseExtrapolator::DropSupersededReadings() {
  if (!HasPose()) {
    return;
  }
  const common::Time time = timed_poses_.back().time;
  DropOlderThan(time, 1, &imu_data_);
  DropOlderThan(time, 2, &odometry_data_);
}

void PoseExtrapolator::AdvanceTracker(const common::Time time,
                                      ImuTracker* const tracker) const {
  CHECK_GE(time, tracker->time());
  const bool imu_is_missing =
      imu_data_.empty() || time < imu_data_.front().time;
  if (imu_is_missing) {
    AddReading(
        sensor::ImuData{time, Eigen::Vector3d::UnitZ(), BestVelocity().angular},
        tracker);
    return;
  }
  FollowImu(time, tracker);
}

void PoseExtrapolator::FollowImu(const common::Time time,
                                 ImuTracker* const tracker) const {
  const auto first_at = [this](const common::Time wanted) {
    return std::partition_point(imu_data_.begin(), imu_data_.end(),
                                [wanted](const sensor::ImuData& reading) {
                                  return reading.time < wanted;
                                });
  };
  const auto unread = first_at(tracker->time());
  if (tracker->time() < imu_data_.front().time) {
    tracker->Advance(imu_data_.front().time);
  }
  std::for_each(unread, first_at(time),
                [tracker](const sensor::ImuData& reading) {
                  AddReading(reading, tracker);
                });
  tracker->Advance(time);
}

Eigen::Quaterniond PoseExtrapolator::TurnUntil(
    const common::Time time, ImuTracker* const tracker) const {
  AdvanceTracker(time, tracker);
  return pose_tracker_->orientation().inverse() * tracker->orientation();
}

}  // namespace mapping
}  // namespace cartographer
