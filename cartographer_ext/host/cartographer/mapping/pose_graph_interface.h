// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What users of a finished SLAM system may ask of its pose graph.
#ifndef CARTOGRAPHER_MAPPING_POSE_GRAPH_INTERFACE_H_
#define CARTOGRAPHER_MAPPING_POSE_GRAPH_INTERFACE_H_

#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/proto/pose_graph.pb.h"
#include "cartographer/mapping/submaps.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {

class PoseGraphInterface {
 public:
  // "Node j was seen from submap i at zbar_ij". INTRA: the node is one of those
  // the submap was built from. INTER: found by loop closure.
  struct Constraint {
    struct Pose {
      transform::Rigid3d zbar_ij;  // (submap <- gravity-aligned node)
      double translation_weight;   // 1 / metre
      double rotation_weight;      // 1 / radian
    };
    SubmapId submap_id;
    NodeId node_id;
    Pose pose;
    enum Tag { INTRA_SUBMAP, INTER_SUBMAP } tag;
  };

  struct LandmarkNode {
    struct LandmarkObservation {
      int trajectory_id;
      common::Time time;
      transform::Rigid3d landmark_to_tracking_transform;
      double translation_weight;
      double rotation_weight;
    };
    std::vector<LandmarkObservation> landmark_observations;
    absl::optional<transform::Rigid3d> global_landmark_pose;
    bool frozen = false;
  };

  struct SubmapPose {
    int version;
    transform::Rigid3d pose;
  };

  struct SubmapData {
    std::shared_ptr<const Submap> submap;
    transform::Rigid3d pose;
  };

  struct TrajectoryData {
    double gravity_constant = 9.8;
    std::array<double, 4> imu_calibration{{1., 0., 0., 0.}};
    absl::optional<transform::Rigid3d> fixed_frame_origin_in_map;
  };

  enum class TrajectoryState { ACTIVE, FINISHED, FROZEN, DELETED };

  // Called after every optimisation with the newest optimised submap and node
  // of each trajectory.
  using GlobalSlamOptimizationCallback =
      std::function<void(const std::map<int /* trajectory_id */, SubmapId>&,
                         const std::map<int /* trajectory_id */, NodeId>&)>;

  PoseGraphInterface() {}
  virtual ~PoseGraphInterface() {}
  PoseGraphInterface(const PoseGraphInterface&) = delete;
  PoseGraphInterface& operator=(const PoseGraphInterface&) = delete;

  // Waits for all computations, then optimises once more with the larger number
  // of iterations kept for the end.
  virtual void RunFinalOptimization() = 0;

  virtual MapById<SubmapId, SubmapData> GetAllSubmapData() const = 0;
  // An empty SubmapData where there is no such submap (any more).
  virtual SubmapData GetSubmapData(const SubmapId& submap_id) const = 0;
  virtual MapById<SubmapId, SubmapPose> GetAllSubmapPoses() const = 0;

  // (global <- local) as the newest optimised submap of the trajectory has it.
  virtual transform::Rigid3d GetLocalToGlobalTransform(
      int trajectory_id) const = 0;

  virtual MapById<NodeId, TrajectoryNode> GetTrajectoryNodes() const = 0;
  virtual MapById<NodeId, TrajectoryNodePose> GetTrajectoryNodePoses()
      const = 0;
  virtual std::map<int, TrajectoryState> GetTrajectoryStates() const = 0;

  virtual std::map<std::string /* landmark ID */, transform::Rigid3d>
  GetLandmarkPoses() const = 0;
  virtual void SetLandmarkPose(const std::string& landmark_id,
                               const transform::Rigid3d& global_pose,
                               const bool frozen = false) = 0;

  // Takes effect some time later.
  virtual void DeleteTrajectory(int trajectory_id) = 0;
  virtual bool IsTrajectoryFinished(int trajectory_id) const = 0;
  virtual bool IsTrajectoryFrozen(int trajectory_id) const = 0;
  virtual std::map<int, TrajectoryData> GetTrajectoryData() const = 0;
  virtual std::vector<Constraint> constraints() const = 0;

  // Constraints, trajectories and landmarks. Unfinished submaps, and their
  // constraints, are included on request only.
  virtual proto::PoseGraph ToProto(bool include_unfinished_submaps) const = 0;

  virtual void SetGlobalSlamOptimizationCallback(
      GlobalSlamOptimizationCallback callback) = 0;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_POSE_GRAPH_INTERFACE_H_
