// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/trajectory_file.h"

#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/line_reader.h"
#include "cartographer_ext/io/tokens.h"

namespace cartographer_ext {
namespace io {
namespace {

// Tolerance of the norm, because files keep few digits.
constexpr double kMaxNormError = 0.01;

absl::Status ParseLine(Tokens* tokens, StampedPose* stamped) {
  if (!ParseTime(tokens->Next(), &stamped->time)) {
    return absl::InvalidArgumentError("invalid stamp");
  }
  std::array<double, 7> values;
  for (double& value : values) {
    if (!ParseCoordinate(tokens->Next(), &value)) {
      return absl::InvalidArgumentError(
          "expected numbers up to 1e9: timestamp tx ty tz qx qy qz qw");
    }
  }
  if (tokens->More()) return absl::InvalidArgumentError("too many words");
  const Eigen::Quaterniond rotation(values[6], values[3], values[4], values[5]);
  if (!(std::abs(rotation.norm() - 1.) <= kMaxNormError)) {
    return absl::InvalidArgumentError("the quaternion is not of unit length");
  }
  stamped->pose = Eigen::Isometry3d::Identity();
  stamped->pose.linear() = rotation.normalized().toRotationMatrix();
  stamped->pose.translation() << values[0], values[1], values[2];
  return absl::OkStatus();
}

}  // namespace

StampedPose MakeStampedPose(TimeNs time, const Pose2& pose) {
  StampedPose stamped;
  stamped.time = time;
  stamped.pose.translation() << pose.x, pose.y, 0.;
  stamped.pose.linear() =
      Eigen::AngleAxisd(pose.theta, Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  return stamped;
}

absl::StatusOr<std::vector<StampedPose>> ReadTumTrajectory(
    const std::string& filename) {
  std::vector<StampedPose> trajectory;
  const absl::Status status =
      ForEachRecord(filename, [&trajectory](Tokens* const tokens) {
        StampedPose stamped;
        const absl::Status parsed = ParseLine(tokens, &stamped);
        if (!parsed.ok()) return parsed;
        if (!trajectory.empty() && stamped.time < trajectory.back().time) {
          return absl::InvalidArgumentError("the stamp goes backwards");
        }
        trajectory.push_back(stamped);
        return absl::OkStatus();
      });
  if (!status.ok()) return status;
  if (trajectory.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(filename, ": no pose"));
  }
  return trajectory;
}

absl::Status WriteTumTrajectory(const std::vector<StampedPose>& trajectory,
                                const std::string& filename) {
  std::string content = "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& stamped : trajectory) {
    const Eigen::Vector3d& translation = stamped.pose.translation();
    Eigen::Quaterniond rotation(stamped.pose.linear());
    // One of the two quaternions of a rotation, always the same.
    if (rotation.w() < 0.) rotation.coeffs() = -rotation.coeffs();
    absl::StrAppendFormat(&content, "%s %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n",
                          FormatTime(stamped.time), translation.x(),
                          translation.y(), translation.z(), rotation.x(),
                          rotation.y(), rotation.z(), rotation.w());
  }
  return WriteFileAtomically(filename, content);
}

}  // namespace io
}  // namespace cartographer_ext
