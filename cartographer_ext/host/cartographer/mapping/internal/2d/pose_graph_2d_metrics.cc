// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/pose_graph_2d_metrics.h"

#include "cartographer/mapping/internal/2d/pose_graph_2d.h"

namespace cartographer {
namespace mapping {

PoseGraph2DMetrics& GetPoseGraph2DMetrics() {
  static PoseGraph2DMetrics* const metrics = new PoseGraph2DMetrics;
  return *metrics;
}

void PoseGraph2D::CountConstraints() const {
  int num_same = 0;
  int num_different = 0;
  for (const Constraint& constraint : data_.constraints) {
    if (constraint.tag == Constraint::INTER_SUBMAP) {
      const bool same = constraint.node_id.trajectory_id ==
                        constraint.submap_id.trajectory_id;
      ++(same ? num_same : num_different);
    }
  }
  GetPoseGraph2DMetrics().constraints_same_trajectory->Set(num_same);
  GetPoseGraph2DMetrics().constraints_different_trajectory->Set(num_different);
}

void PoseGraph2D::RegisterMetrics(
    metrics::FamilyFactory* const family_factory) {
  PoseGraph2DMetrics& metrics = GetPoseGraph2DMetrics();
  metrics.work_queue_delay =
      family_factory
          ->NewGaugeFamily("mapping_2d_pose_graph_work_queue_delay",
                           "Seconds that the oldest waiting item has waited")
          ->Add({});
  metrics.work_queue_size =
      family_factory
          ->NewGaugeFamily("mapping_2d_pose_graph_work_queue_size",
                           "Items that wait in the work queue")
          ->Add({});
  auto* const constraints = family_factory->NewGaugeFamily(
      "mapping_2d_pose_graph_constraints", "Constraints in the pose graph");
  metrics.constraints_same_trajectory =
      constraints->Add({{"tag", "inter_submap"}, {"trajectory", "same"}});
  metrics.constraints_different_trajectory =
      constraints->Add({{"tag", "inter_submap"}, {"trajectory", "different"}});
  auto* const submaps = family_factory->NewGaugeFamily(
      "mapping_2d_pose_graph_submaps", "Submaps in the pose graph");
  metrics.active_submaps = submaps->Add({{"state", "active"}});
  metrics.frozen_submaps = submaps->Add({{"state", "frozen"}});
  metrics.deleted_submaps = submaps->Add({{"state", "deleted"}});
}

}  // namespace mapping
}  // namespace cartographer
