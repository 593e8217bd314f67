// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The tree of coordinate frames of a ROS recording, as far as it is static: the
// poses of the sensors on the robot.
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROS_FRAMES_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROS_FRAMES_H_

#include <map>
#include <set>
#include <string>
#include <vector>

#include "Eigen/Geometry"
#include "absl/types/optional.h"
#include "cartographer_ext/io/ros/ros_messages.h"

namespace cartographer_ext {
namespace io {

class RosFrames {
 public:
  // The first pose of a frame counts; later ones show whether it moves. At most
  // 10,000 frames are kept.
  void Add(const RosTransform& transform);

  // (target <- source) if a chain of frames joins the two. Frames that move
  // against their parents on the chain are put into `moving`.
  absl::optional<Eigen::Isometry3d> Lookup(
      const std::string& target, const std::string& source,
      std::vector<std::string>* moving = nullptr) const;

  bool Knows(const std::string& frame) const;

  // Whether one of these frames moves against its parent.
  bool HasMovingChild(const std::set<std::string>& frames) const;

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d pose =
        Eigen::Isometry3d::Identity();  // (parent <- frame)
    bool moving = false;
  };
  // From `frame` up to the root: (ancestor <- frame) by ancestor, in order.
  std::vector<std::pair<std::string, Eigen::Isometry3d>> Ancestors(
      const std::string& frame) const;

  std::map<std::string, Link> links_;  // by frame
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROS_FRAMES_H_
