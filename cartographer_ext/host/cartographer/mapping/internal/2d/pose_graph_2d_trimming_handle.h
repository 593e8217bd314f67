// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What trimmers see of a PoseGraph2D, while it holds its lock for them.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_POSE_GRAPH_2D_TRIMMING_HANDLE_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_POSE_GRAPH_2D_TRIMMING_HANDLE_H_

#include <set>
#include <vector>

#include "cartographer/mapping/internal/2d/pose_graph_2d.h"
#include "cartographer/mapping/pose_graph_trimmer.h"

namespace cartographer {
namespace mapping {

class PoseGraph2D::TrimmingHandle : public Trimmable {
 public:
  explicit TrimmingHandle(PoseGraph2D* parent);
  ~TrimmingHandle() override {}

  int num_submaps(int trajectory_id) const override;
  std::vector<SubmapId> GetSubmapIds(int trajectory_id) const override;
  MapById<SubmapId, PoseGraphInterface::SubmapData> GetOptimizedSubmapData()
      const override;
  const MapById<NodeId, TrajectoryNode>& GetTrajectoryNodes() const override;
  const std::vector<PoseGraphInterface::Constraint>& GetConstraints()
      const override;
  void TrimSubmap(const SubmapId& submap_id) override;
  bool IsFinished(int trajectory_id) const override;
  void SetTrajectoryState(int trajectory_id,
                          PoseGraphInterface::TrajectoryState state) override;

 private:
  // The nodes that no submap but this one was built from.
  std::set<NodeId> NodesOnlyIn(const SubmapId& submap_id) const;
  // Also drops the scan matchers of other submaps that have no loop closure
  // left, as their area is not likely to be visited again.
  void RemoveConstraints(const SubmapId& submap_id,
                         const std::set<NodeId>& node_ids);

  PoseGraph2D* const parent_;
  PoseGraphData& data_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_POSE_GRAPH_2D_TRIMMING_HANDLE_H_
