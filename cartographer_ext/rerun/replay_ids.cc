// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/replay_ids.h"

namespace cartographer_ext {
namespace evaluation {

ReplayIds::ReplayIds(const ReplayPlan& plan) {
  for (const ReplayStep& step : plan.steps) {
    const int trajectory_id = step.node_id.trajectory_id;
    std::vector<int>& indices = nodes_[trajectory_id];
    step_nodes_.push_back({trajectory_id, static_cast<int>(indices.size())});
    indices.push_back(step.node_id.index);
  }
  for (const ReplaySubmap& submap : plan.submaps) {
    std::vector<int>& indices = submaps_[submap.trajectory_id];
    position_submaps_.push_back(
        {submap.trajectory_id, static_cast<int>(indices.size())});
    indices.push_back(submap.stored_index);
  }
}

GraphId ReplayIds::StoredNode(const GraphId& id) const {
  return {id.trajectory_id, nodes_.at(id.trajectory_id).at(id.index)};
}

GraphId ReplayIds::StoredSubmap(const GraphId& id) const {
  return {id.trajectory_id, submaps_.at(id.trajectory_id).at(id.index)};
}

}  // namespace evaluation
}  // namespace cartographer_ext
