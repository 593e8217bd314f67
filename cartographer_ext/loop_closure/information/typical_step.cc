// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/information/typical_step.h"

#include <algorithm>
#include <vector>

#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace loop_closure {

void TypicalStep::Add(const int trajectory_id, const int node_index,
                      const Pose2& local_pose) {
  Trajectory& trajectory = trajectories_[trajectory_id];
  if (node_index <= trajectory.newest_node) return;
  if (trajectory.newest_node >= 0) {
    trajectory.steps.push_back(
        Between(trajectory.newest_pose, local_pose).translation().norm() /
        (node_index - trajectory.newest_node));
    if (trajectory.steps.size() > kMostSteps) trajectory.steps.pop_front();
  }
  trajectory.newest_node = node_index;
  trajectory.newest_pose = local_pose;
}

double TypicalStep::WeightFactor(const int trajectory_id) const {
  const auto found = trajectories_.find(trajectory_id);
  if (found == trajectories_.end() ||
      found->second.steps.size() < kFewestSteps) {
    return 1.;
  }
  const double median = UpperMedian(std::vector<double>(
      found->second.steps.begin(), found->second.steps.end()));
  return Squared(std::max(1., median / dense_step_));
}

}  // namespace loop_closure
}  // namespace cartographer_ext
