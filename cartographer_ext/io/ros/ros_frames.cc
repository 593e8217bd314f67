// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros_frames.h"

#include <algorithm>
#include <utility>

namespace cartographer_ext {
namespace io {
namespace {

constexpr size_t kMaxFrames = 10000;
// No robot has a deeper tree of frames; the limit also ends the search in trees
// with a cycle.
constexpr int kMaxDepth = 100;

bool Same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm() < 1e-3 &&
         (a.linear() - b.linear()).norm() < 1e-3;
}

}  // namespace

void RosFrames::Add(const RosTransform& transform) {
  if (transform.child_frame.empty() || transform.header.frame.empty() ||
      transform.child_frame == transform.header.frame) {
    return;
  }
  const auto it = links_.find(transform.child_frame);
  if (it == links_.end()) {
    if (links_.size() >= kMaxFrames) return;
    Link& link = links_[transform.child_frame];
    link.parent = transform.header.frame;
    link.pose = transform.pose;
    return;
  }
  if (it->second.parent != transform.header.frame ||
      !Same(it->second.pose, transform.pose)) {
    it->second.moving = true;
  }
}

bool RosFrames::Knows(const std::string& frame) const {
  if (links_.count(frame) > 0) return true;
  for (const auto& link : links_) {
    if (link.second.parent == frame) return true;
  }
  return false;
}

bool RosFrames::HasMovingChild(const std::set<std::string>& frames) const {
  for (const std::string& frame : frames) {
    const auto link = links_.find(frame);
    if (link != links_.end() && link->second.moving) return true;
  }
  return false;
}

std::vector<std::pair<std::string, Eigen::Isometry3d>> RosFrames::Ancestors(
    const std::string& frame) const {
  std::vector<std::pair<std::string, Eigen::Isometry3d>> ancestors;
  ancestors.emplace_back(frame, Eigen::Isometry3d::Identity());
  for (int depth = 0; depth < kMaxDepth; ++depth) {
    const auto it = links_.find(ancestors.back().first);
    if (it == links_.end()) break;
    ancestors.emplace_back(it->second.parent,
                           it->second.pose * ancestors.back().second);
  }
  return ancestors;
}

absl::optional<Eigen::Isometry3d> RosFrames::Lookup(
    const std::string& target, const std::string& source,
    std::vector<std::string>* moving) const {
  const auto from_target = Ancestors(target);
  const auto from_source = Ancestors(source);
  for (size_t i = 0; i < from_source.size(); ++i) {
    for (size_t j = 0; j < from_target.size(); ++j) {
      if (from_source[i].first != from_target[j].first) continue;
      if (moving != nullptr) {
        for (size_t k = 0; k < std::max(i, j); ++k) {
          if (k < i && links_.at(from_source[k].first).moving) {
            moving->push_back(from_source[k].first);
          }
          if (k < j && links_.at(from_target[k].first).moving) {
            moving->push_back(from_target[k].first);
          }
        }
      }
      return Eigen::Isometry3d(from_target[j].second.inverse() *
                               from_source[i].second);
    }
  }
  return absl::nullopt;
}

}  // namespace io
}  // namespace cartographer_ext
