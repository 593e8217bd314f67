// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/carmen_writer.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/io/carmen/carmen_line.h"
#include "cartographer_ext/io/tokens.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr double kFrontLaserNoReturn = 81.91;

bool HasFrontLaserAngles(const LaserScan& scan) {
  double angle_min, angle_increment;
  FrontLaserAngles(scan.ranges.size(), &angle_min, &angle_increment);
  // The tolerance is a tenth of a beam over the whole sweep.
  const double tolerance = 0.1 * angle_increment;
  return std::abs(scan.angle_min - angle_min) < tolerance &&
         std::abs(scan.angle_increment - angle_increment) * scan.ranges.size() <
             tolerance;
}

std::string FormatPose(const Pose2& pose) {
  return absl::StrFormat("%.6f %.6f %.6f", pose.x, pose.y, pose.theta);
}

// Stamp, host, logger's stamp.
std::string FormatStamp(TimeNs time) {
  const std::string stamp = FormatTime(time);
  return absl::StrCat(stamp, " nohost ", stamp);
}

bool IsFinite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) &&
         std::isfinite(pose.theta);
}

}  // namespace

absl::StatusOr<std::unique_ptr<CarmenWriter>> CarmenWriter::Open(
    const std::string& filename, const std::string& comment) {
  std::unique_ptr<CarmenWriter> writer(new CarmenWriter(filename));
  if (!writer->file_.status().ok()) return writer->file_.status();
  if (!comment.empty()) {
    for (const absl::string_view line : absl::StrSplit(comment, '\n')) {
      writer->file_.stream() << "# " << line << '\n';
    }
  }
  return writer;
}

absl::Status CarmenWriter::AddOdometry(const OdometryReading& reading,
                                       double linear_velocity,
                                       double angular_velocity) {
  if (!IsFinite(reading.pose) || reading.time < 0) {
    return absl::InvalidArgumentError(
        "odometry with a pose that is not finite or a negative stamp");
  }
  file_.stream() << "ODOM " << FormatPose(reading.pose)
                 << absl::StrFormat(" %.6f %.6f 0 ", linear_velocity,
                                    angular_velocity)
                 << FormatStamp(reading.time) << '\n';
  return absl::OkStatus();
}

absl::Status CarmenWriter::AddScan(const LaserScan& scan,
                                   const Pose2& odometry) {
  const size_t num_readings = scan.ranges.size();
  if (num_readings == 0 || num_readings > CarmenLine::kMaxReadings) {
    return absl::InvalidArgumentError(
        absl::StrCat("scan with ", num_readings, " readings"));
  }
  if (!IsFinite(odometry) || !IsFinite(scan.laser_pose) || scan.time < 0) {
    return absl::InvalidArgumentError(
        "scan with a pose that is not finite or a negative stamp");
  }
  const bool front = HasFrontLaserAngles(scan);
  const double no_return = front ? kFrontLaserNoReturn : scan.range_max;
  std::string line;
  if (front) {
    line = absl::StrCat("FLASER ", num_readings);
  } else {
    // Type 0, no statement of accuracy, no remissions.
    line = absl::StrFormat("ROBOTLASER1 0 %.9f %.9f %.12f %.3f 0 0 %d",
                           scan.angle_min,
                           scan.angle_increment * (num_readings - 1),
                           scan.angle_increment, no_return, num_readings);
  }
  for (const float range : scan.ranges) {
    const bool valid = std::isfinite(range) && range > 0.f &&
                       range <= scan.range_max && range < no_return;
    absl::StrAppendFormat(&line, " %.3f", valid ? range : no_return);
  }
  const Pose2 laser = odometry * scan.laser_pose;
  if (front) {
    absl::StrAppend(&line, " ", FormatPose(laser), " ", FormatPose(odometry));
  } else {
    absl::StrAppend(&line, " 0 ", FormatPose(laser), " ", FormatPose(odometry),
                    " 0 0 0 0 0");
  }
  absl::StrAppend(&line, " ", FormatStamp(scan.time), "\n");
  file_.stream() << line;
  return absl::OkStatus();
}

absl::Status CarmenWriter::Finish() { return file_.Commit(); }

}  // namespace io
}  // namespace cartographer_ext
