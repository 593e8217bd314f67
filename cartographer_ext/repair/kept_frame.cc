// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/kept_frame.h"

#include <vector>

#include "absl/strings/str_format.h"
#include "cartographer_ext/map/comparison/map_alignment.h"

namespace cartographer_ext {
namespace repair {
namespace {

// Metres: nodes that moved less count as unmoved.
constexpr double kUnmoved = 0.2;

}  // namespace

Pose2 OldFromNewByNodes(const evaluation::MapGraph& before,
                        const evaluation::MapGraph& after) {
  std::vector<evaluation::NodePosePair> pairs;
  for (const auto& node : before.nodes) {
    const auto moved = after.nodes.find(node.first);
    if (moved == after.nodes.end()) continue;
    pairs.emplace_back(node.second.global_pose, moved->second.global_pose);
  }
  const auto alignment = evaluation::AlignPoses(pairs, kUnmoved);
  return alignment.has_value() ? alignment->first_from_second : Pose2();
}

Pose2 OldFromNewByStart(const evaluation::MapGraph& before,
                        const evaluation::MapGraph& after) {
  for (const auto& node : before.nodes) {
    const auto moved = after.nodes.find(node.first);
    if (moved == after.nodes.end()) continue;
    return node.second.global_pose * moved->second.global_pose.Inverse();
  }
  return Pose2();
}

std::string PoseTable(const evaluation::MapGraph& before,
                      const evaluation::MapGraph& after) {
  std::string table =
      "trajectory_id,node_index,time,old_x,old_y,old_theta,new_x,new_y,"
      "new_theta\n";
  for (const auto& node : before.nodes) {
    const auto moved = after.nodes.find(node.first);
    if (moved == after.nodes.end()) continue;
    const Pose2& a = node.second.global_pose;
    const Pose2& b = moved->second.global_pose;
    absl::StrAppendFormat(&table, "%d,%d,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n",
                          node.first.trajectory_id, node.first.index,
                          io::ToSeconds(node.second.time), a.x, a.y, a.theta,
                          b.x, b.y, b.theta);
  }
  return table;
}

}  // namespace repair
}  // namespace cartographer_ext
