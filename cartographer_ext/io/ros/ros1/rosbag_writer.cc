// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros1/rosbag_writer.h"

#include "absl/strings/str_cat.h"

#ifndef CARTOGRAPHER_EXT_HAS_ROSBAG

namespace cartographer_ext {
namespace io {

absl::StatusOr<std::unique_ptr<RosbagWriter>> RosbagWriter::Open(
    const std::string& filename, const RosbagWriterOptions& options) {
  return absl::UnimplementedError(absl::StrCat(
      filename, ": built without librosbag-storage, bags cannot be written"));
}

}  // namespace io
}  // namespace cartographer_ext

#else  // CARTOGRAPHER_EXT_HAS_ROSBAG

#include <cmath>
#include <exception>
#include <limits>
#include <utility>
#include <vector>

#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/ros/ros2_messages.h"
#include "nav_msgs/Odometry.h"
#include "rosbag/bag.h"
#include "sensor_msgs/Imu.h"
#include "sensor_msgs/LaserScan.h"
#include "sensor_msgs/MultiEchoLaserScan.h"
#include "tf2_msgs/TFMessage.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr char kTransformTopic[] = "/tf";
constexpr char kStaticTransformTopic[] = "/tf_static";

// The destructor of a bag whose writing failed tries to write again and
// throws, which ends the program. Such bags are put here and never destroyed.
void Abandon(std::unique_ptr<rosbag::Bag> bag) {
  static std::vector<rosbag::Bag*>* const abandoned =
      new std::vector<rosbag::Bag*>;
  abandoned->push_back(bag.release());
}

bool IsValidStamp(TimeNs time) {
  return time > 0 && time / 1000000000 <= std::numeric_limits<uint32_t>::max();
}

ros::Time ToRos(TimeNs time) {
  return ros::Time(static_cast<uint32_t>(time / 1000000000),
                   static_cast<uint32_t>(time % 1000000000));
}

geometry_msgs::Quaternion YawToRos(double yaw) {
  geometry_msgs::Quaternion rotation;
  rotation.z = std::sin(0.5 * yaw);
  rotation.w = std::cos(0.5 * yaw);
  return rotation;
}

geometry_msgs::TransformStamped MakeTransform(TimeNs time,
                                              const std::string& parent,
                                              const std::string& child,
                                              const Pose2& pose) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ToRos(time);
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.translation.x = pose.x;
  transform.transform.translation.y = pose.y;
  transform.transform.rotation = YawToRos(pose.theta);
  return transform;
}

class Writer : public RosbagWriter {
 public:
  Writer(const std::string& filename, const RosbagWriterOptions& options)
      : filename_(filename), options_(options), file_(filename) {}

  ~Writer() override {
    if (bag_ == nullptr) return;
    try {
      bag_->close();
    } catch (...) {
      Abandon(std::move(bag_));
    }
  }

  absl::Status Open() {
    if (!file_.status().ok()) return file_.status();
    rosbag::CompressionType compression;
    if (options_.compression == "none") {
      compression = rosbag::compression::Uncompressed;
    } else if (options_.compression == "bz2") {
      compression = rosbag::compression::BZ2;
    } else if (options_.compression == "lz4") {
      compression = rosbag::compression::LZ4;
    } else {
      return absl::InvalidArgumentError(
          absl::StrCat("compression must be none, bz2 or lz4, not \"",
                       options_.compression, "\""));
    }
    return Try([&] {
      bag_.reset(new rosbag::Bag);
      bag_->open(file_.temporary_path(), rosbag::bagmode::Write);
      bag_->setCompression(compression);
    });
  }

  absl::Status AddScan(const LaserScan& scan) override {
    const TimeNs time = FirstBeamTime(scan);
    if (!IsValidStamp(time)) return BadStamp(time);
    if (!static_sent_[0]) {
      const absl::Status status =
          AddStatic(MakeTransform(time, options_.tracking_frame,
                                  options_.laser_frame, scan.laser_pose));
      if (!status.ok()) return status;
      static_sent_[0] = true;
    }
    if (scan.echoes.empty()) {
      sensor_msgs::LaserScan message;
      FillHead(scan, time, &message);
      message.ranges = scan.ranges;
      return Write(options_.scan_topic, time, message);
    }
    sensor_msgs::MultiEchoLaserScan message;
    FillHead(scan, time, &message);
    message.ranges.resize(scan.echoes.size());
    for (size_t i = 0; i < scan.echoes.size(); ++i) {
      message.ranges[i].echoes = scan.echoes[i];
    }
    return Write(options_.scan_topic, time, message);
  }

  absl::Status AddOdometry(const OdometryReading& reading,
                           double linear_velocity,
                           double angular_velocity) override {
    if (!IsValidStamp(reading.time)) return BadStamp(reading.time);
    nav_msgs::Odometry message;
    message.header.seq = sequence_++;
    message.header.stamp = ToRos(reading.time);
    message.header.frame_id = options_.odometry_frame;
    message.child_frame_id = options_.tracking_frame;
    message.pose.pose.position.x = reading.pose.x;
    message.pose.pose.position.y = reading.pose.y;
    message.pose.pose.orientation = YawToRos(reading.pose.theta);
    message.twist.twist.linear.x = linear_velocity;
    message.twist.twist.angular.z = angular_velocity;
    const absl::Status status =
        Write(options_.odometry_topic, reading.time, message);
    if (!status.ok()) return status;
    tf2_msgs::TFMessage transforms;
    transforms.transforms.push_back(
        MakeTransform(reading.time, options_.odometry_frame,
                      options_.tracking_frame, reading.pose));
    return Write(kTransformTopic, reading.time, transforms);
  }

  absl::Status AddImu(const ImuReading& reading) override {
    if (!IsValidStamp(reading.time)) return BadStamp(reading.time);
    if (!static_sent_[1]) {
      const absl::Status status = AddStatic(MakeTransform(
          reading.time, options_.tracking_frame, options_.imu_frame, Pose2()));
      if (!status.ok()) return status;
      static_sent_[1] = true;
    }
    sensor_msgs::Imu message;
    message.header.seq = sequence_++;
    message.header.stamp = ToRos(reading.time);
    message.header.frame_id = options_.imu_frame;
    message.orientation.w = 1.;
    message.orientation_covariance[0] = -1.;  // no estimate
    message.angular_velocity.x = reading.angular_velocity.x();
    message.angular_velocity.y = reading.angular_velocity.y();
    message.angular_velocity.z = reading.angular_velocity.z();
    message.linear_acceleration.x = reading.linear_acceleration.x();
    message.linear_acceleration.y = reading.linear_acceleration.y();
    message.linear_acceleration.z = reading.linear_acceleration.z();
    return Write(options_.imu_topic, reading.time, message);
  }

  absl::Status Finish() override {
    if (bag_ == nullptr) {
      return absl::FailedPreconditionError(
          absl::StrCat(filename_, ": finished or failed before"));
    }
    const absl::Status status = Try([&] { bag_->close(); });
    if (!status.ok()) return status;
    bag_.reset();
    return file_.Commit();
  }

 private:
  template <typename Function>
  absl::Status Try(const Function& function) {
    if (failed_) {
      return absl::FailedPreconditionError(
          absl::StrCat(filename_, ": writing failed before"));
    }
    std::string problem;
    try {
      function();
      return absl::OkStatus();
    } catch (const std::exception& exception) {
      problem = exception.what();
    } catch (...) {
      problem = "unknown error";
    }
    failed_ = true;
    if (bag_ != nullptr) Abandon(std::move(bag_));
    return absl::UnavailableError(
        absl::StrCat("cannot write ", filename_, ": ", problem));
  }

  template <typename Message>
  absl::Status Write(const std::string& topic, TimeNs time,
                     const Message& message) {
    if (bag_ == nullptr) {
      return absl::FailedPreconditionError(
          absl::StrCat(filename_, ": finished or failed before"));
    }
    return Try([&] { bag_->write(topic, ToRos(time), message); });
  }

  absl::Status AddStatic(const geometry_msgs::TransformStamped& transform) {
    if (bag_ == nullptr) {
      return absl::FailedPreconditionError(
          absl::StrCat(filename_, ": finished or failed before"));
    }
    tf2_msgs::TFMessage message;
    message.transforms.push_back(transform);
    if (latched_header_ == nullptr) {
      // Players repeat latched messages to late subscribers.
      latched_header_ = boost::make_shared<ros::M_string>();
      (*latched_header_)["latching"] = "1";
      (*latched_header_)["callerid"] = "/cartographer_ext";
      (*latched_header_)["topic"] = kStaticTransformTopic;
      (*latched_header_)["type"] = ros::message_traits::datatype(message);
      (*latched_header_)["md5sum"] = ros::message_traits::md5sum(message);
      (*latched_header_)["message_definition"] =
          ros::message_traits::definition(message);
    }
    return Try([&] {
      bag_->write(kStaticTransformTopic, transform.header.stamp, message,
                  latched_header_);
    });
  }

  template <typename Message>
  void FillHead(const LaserScan& scan, TimeNs time, Message* message) {
    message->header.seq = sequence_++;
    message->header.stamp = ToRos(time);
    message->header.frame_id = options_.laser_frame;
    message->angle_min = static_cast<float>(scan.angle_min);
    message->angle_increment = static_cast<float>(scan.angle_increment);
    message->angle_max = static_cast<float>(
        scan.angle_min +
        scan.angle_increment * (static_cast<double>(scan.ranges.size()) - 1.));
    message->time_increment = static_cast<float>(scan.time_increment);
    message->range_min = static_cast<float>(scan.range_min);
    message->range_max = static_cast<float>(scan.range_max);
  }

  absl::Status BadStamp(TimeNs time) const {
    return absl::InvalidArgumentError(absl::StrCat(
        filename_, ": bags cannot hold the stamp ", ToSeconds(time), " s"));
  }

  const std::string filename_;
  const RosbagWriterOptions options_;
  AtomicFile file_;
  std::unique_ptr<rosbag::Bag> bag_;
  boost::shared_ptr<ros::M_string> latched_header_;
  bool static_sent_[2] = {false, false};  // laser, IMU
  bool failed_ = false;
  uint32_t sequence_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<RosbagWriter>> RosbagWriter::Open(
    const std::string& filename, const RosbagWriterOptions& options) {
  std::unique_ptr<Writer> writer(new Writer(filename, options));
  const absl::Status status = writer->Open();
  if (!status.ok()) return status;
  return std::unique_ptr<RosbagWriter>(std::move(writer));
}

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_HAS_ROSBAG
