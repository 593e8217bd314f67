// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Trimmers shrink the pose graph after each optimisation.
#ifndef CARTOGRAPHER_MAPPING_POSE_GRAPH_TRIMMER_H_
#define CARTOGRAPHER_MAPPING_POSE_GRAPH_TRIMMER_H_

#include <vector>

#include "cartographer/mapping/id.h"
#include "cartographer/mapping/pose_graph_interface.h"

namespace cartographer {
namespace mapping {

// The view of a pose graph that trimmers get; valid during Trim only.
class Trimmable {
 public:
  virtual ~Trimmable() {}

  virtual int num_submaps(int trajectory_id) const = 0;
  virtual std::vector<SubmapId> GetSubmapIds(int trajectory_id) const = 0;
  // Finished submaps with optimised poses.
  virtual MapById<SubmapId, PoseGraphInterface::SubmapData>
  GetOptimizedSubmapData() const = 0;
  virtual const MapById<NodeId, TrajectoryNode>& GetTrajectoryNodes() const = 0;
  virtual const std::vector<PoseGraphInterface::Constraint>& GetConstraints()
      const = 0;

  // Removes a submap together with its constraints, and the nodes that no other
  // submap was built from.
  virtual void TrimSubmap(const SubmapId& submap_id) = 0;

  virtual bool IsFinished(int trajectory_id) const = 0;
  virtual void SetTrajectoryState(
      int trajectory_id, PoseGraphInterface::TrajectoryState state) = 0;
};

class PoseGraphTrimmer {
 public:
  virtual ~PoseGraphTrimmer() {}

  virtual void Trim(Trimmable* pose_graph) = 0;
  // True once the trimmer has nothing left to do and may be dropped.
  virtual bool IsFinished() = 0;
};

// Keeps only the newest submaps of one trajectory; once the trajectory is
// finished, removes it.
class PureLocalizationTrimmer : public PoseGraphTrimmer {
 public:
  // At least two submaps are needed, the ones local SLAM still builds.
  PureLocalizationTrimmer(int trajectory_id, int num_submaps_to_keep);
  ~PureLocalizationTrimmer() override {}

  void Trim(Trimmable* pose_graph) override;
  bool IsFinished() override;

 private:
  const int trajectory_id_;
  int num_submaps_to_keep_;
  bool finished_ = false;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_POSE_GRAPH_TRIMMER_H_
