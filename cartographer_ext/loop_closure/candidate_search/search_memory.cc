// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/search_memory.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr size_t kMaxNodes = 20000;

}  // namespace

void RememberedNodes::Add(const uncertainty::NodeId& node, const int64_t time) {
  nodes_.emplace(node, time);
  if (nodes_.size() > kMaxNodes) nodes_.erase(nodes_.begin());
}

void RememberedNodes::EraseUpTo(const int trajectory_id,
                                const int last_node_index) {
  for (auto it = nodes_.begin(); it != nodes_.end();) {
    const bool erased = it->first.IsNodeOf(trajectory_id) &&
                        it->first.index() <= last_node_index;
    it = erased ? nodes_.erase(it) : std::next(it);
  }
}

bool RememberedNodes::HasNear(const uncertainty::PathUncertainty& paths,
                              const uncertainty::NodeId& node,
                              const int64_t time, const double distance,
                              const double duration) const {
  if (distance <= 0.) return false;
  const double ticks = 1e7 * duration;
  const auto near =
      [&](const std::pair<const uncertainty::VertexId, int64_t>& other) {
        if (std::abs(static_cast<double>(other.second - time)) > ticks) {
          return false;
        }
        const absl::optional<double> travelled =
            paths.Travelled(other.first, node);
        return travelled.has_value() && *travelled < distance;
      };
  const auto after = nodes_.lower_bound(node);
  if (after != nodes_.end() && near(*after)) return true;
  return after != nodes_.begin() && near(*std::prev(after));
}

bool IsStillFar(const absl::optional<FarNode>& far,
                const uncertainty::PathUncertainty& paths,
                const uncertainty::NodeId& node, const double distance) {
  if (!far.has_value() || distance <= far->limit ||
      far->drift_version != paths.drift_version()) {
    return false;
  }
  const absl::optional<double> travelled = paths.Travelled(far->node, node);
  return travelled.has_value() &&
         distance > far->limit + std::max(1., far->growth * *travelled);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
