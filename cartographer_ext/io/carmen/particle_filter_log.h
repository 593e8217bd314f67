// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Recovers the odometry from the log that GMapping writes ("gfs" logs; many
// public logs exist only like this). Of the recorded log it keeps the scans its
// particle filter used and all ODOM lines, and changes the poses:
//
//   ODOM o1 ... ODOM ok     odometry, continued from the last corrected pose
//   FLASER ... c c          the scan; both poses are that of the best particle
//   ODOM c                  the same pose again, under the stamp 0 or worse
//   NEFF number             only GMapping writes these
//   ODOM o1' ...            odometry, continued from c
//
// So the pose jumps from ok to c by the correction at every scan. Without these
// jumps, and chained, the increments are those of the wheels. Between scans
// without an ODOM line between them only the corrected increment is known.
#ifndef CARTOGRAPHER_EXT_IO_CARMEN_PARTICLE_FILTER_LOG_H_
#define CARTOGRAPHER_EXT_IO_CARMEN_PARTICLE_FILTER_LOG_H_

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/carmen/carmen_line.h"

namespace cartographer_ext {
namespace io {

inline bool IsScanKind(const CarmenKind kind) {
  return kind == CarmenKind::kFrontLaser || kind == CarmenKind::kRobotLaser ||
         kind == CarmenKind::kRawLaser;
}

// Sees every scan and ODOM line of the log in its order.
class ParticleFilterLog {
 public:
  // Whether the ODOM line behind a scan repeats its pose.
  bool Repeats(const CarmenLine& line) const {
    return has_last_ && last_was_scan_ && line.kind == CarmenKind::kOdometry &&
           line.robot_pose.x == last_.x && line.robot_pose.y == last_.y &&
           line.robot_pose.theta == last_.theta;
  }

  bool last_was_scan() const { return last_was_scan_; }

  // Replaces the poses of the line by those of uncorrected odometry.
  void RemoveCorrection(CarmenLine* const line) {
    const Pose2 corrected = line->robot_pose;
    const bool is_scan = IsScanKind(line->kind);
    if (!has_last_) {
      odometry_ = corrected;
    } else if (!is_scan || !odometry_since_scan_) {
      odometry_ = odometry_ * Between(last_, corrected);
    }
    if (is_scan) {
      line->laser_pose = odometry_ * Between(corrected, line->laser_pose);
    }
    line->robot_pose = odometry_;
    odometry_since_scan_ = !is_scan;
    Remember(corrected, is_scan);
  }

  // Instead of RemoveCorrection: of repetitions, or to find these only.
  void Skip(const CarmenLine& line) {
    Remember(line.robot_pose, IsScanKind(line.kind));
  }

 private:
  void Remember(const Pose2& corrected, const bool is_scan) {
    last_ = corrected;
    last_was_scan_ = is_scan;
    has_last_ = true;
  }

  Pose2 odometry_;  // (odometry <- robot), chained
  Pose2 last_;      // as in the last line
  bool last_was_scan_ = false;
  bool odometry_since_scan_ = false;  // other than a repetition
  bool has_last_ = false;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_CARMEN_PARTICLE_FILTER_LOG_H_
