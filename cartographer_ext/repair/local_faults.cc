// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/local_faults.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace repair {
namespace {

bool Larger(const LocalFault& a, const LocalFault& b) {
  // A metre weighs as much as a radian.
  return std::abs(a.radians) + a.metres > std::abs(b.radians) + b.metres;
}

}  // namespace

std::vector<LocalFault> FindLocalFaults(const evaluation::MapGraph& stored,
                                        const evaluation::MapGraph& repaired,
                                        const LocalFaultOptions& options) {
  std::vector<LocalFault> faults;
  if (stored.nodes.empty()) return faults;
  io::TimeNs start = stored.nodes.begin()->second.time;
  for (const auto& node : stored.nodes) {
    start = std::min(start, node.second.time);
  }
  const io::TimeNs window = io::FromSeconds(options.window_seconds);
  auto first = stored.nodes.begin();
  for (auto last = stored.nodes.begin(); last != stored.nodes.end(); ++last) {
    const auto behind = [&]() {
      return first->first.trajectory_id != last->first.trajectory_id ||
             (std::next(first) != last && first != last &&
              last->second.time - first->second.time > window);
    };
    while (first != last && behind()) ++first;
    const auto a = repaired.nodes.find(first->first);
    const auto b = repaired.nodes.find(last->first);
    if (first == last || a == repaired.nodes.end() ||
        b == repaired.nodes.end()) {
      continue;
    }
    const Pose2 local =
        Between(first->second.local_pose, last->second.local_pose);
    const Pose2 right = Between(a->second.global_pose, b->second.global_pose);
    LocalFault fault;
    fault.node_id = last->first;
    fault.seconds = io::ToSeconds(last->second.time - start);
    fault.metres = (local.translation() - right.translation()).norm();
    fault.radians = NormalizeAngle(local.theta - right.theta);
    if (std::abs(fault.radians) < options.radians &&
        fault.metres < options.metres) {
      continue;
    }
    if (!faults.empty() &&
        fault.seconds - faults.back().seconds < options.window_seconds) {
      if (Larger(fault, faults.back())) faults.back() = fault;
    } else {
      faults.push_back(fault);
    }
  }
  std::stable_sort(faults.begin(), faults.end(), Larger);
  if (faults.size() > options.max_listed) faults.resize(options.max_listed);
  return faults;
}

std::string ToText(const LocalFault& fault) {
  const std::string where =
      absl::StrFormat("at %.1f s (node %s)", fault.seconds,
                      evaluation::ToString(fault.node_id));
  if (std::abs(fault.radians) > 0.1 * fault.metres) {
    return absl::StrFormat(
        "local SLAM turned %.0f degrees too far to the %s %s",
        std::abs(RadToDeg(fault.radians)),
        fault.radians > 0. ? "left" : "right", where);
  }
  return absl::StrFormat("local SLAM slipped by %.1f m %s", fault.metres,
                         where);
}

}  // namespace repair
}  // namespace cartographer_ext
