// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Comes before Cartographer's header of the same path. The class found
// there becomes StockOptimizationProblem2D; the class of the original name
// forwards to it, or, where the options have our block, to ours.
#pragma GCC system_header

#include "cartographer_ext/swaps.h"

#if !defined(CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM) || \
    defined(OptimizationProblem2D)
// Not selected, or this is the stock source with its class renamed.
#include_next "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#else
#ifndef CARTOGRAPHER_EXT_OVERLAY_OPTIMIZATION_PROBLEM_2D_H_
#define CARTOGRAPHER_EXT_OVERLAY_OPTIMIZATION_PROBLEM_2D_H_

#define OptimizationProblem2D StockOptimizationProblem2D
#include_next "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#undef OptimizationProblem2D

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace cartographer_ext {
class PoseGraphContext;
namespace optimization {
class RobustOptimizationProblem2D;
}  // namespace optimization
}  // namespace cartographer_ext

namespace cartographer {
namespace mapping {
namespace optimization {

// Exactly one of the two problems exists, chosen once by the options. Neither
// sees loops that are withdrawn (cartographer_ext/common/withdrawn_loops.h).
class OptimizationProblem2D
    : public OptimizationProblemInterface<NodeSpec2D, SubmapSpec2D,
                                          transform::Rigid2d> {
 public:
  explicit OptimizationProblem2D(
      const optimization::proto::OptimizationProblemOptions& options);
  ~OptimizationProblem2D();
  OptimizationProblem2D(const OptimizationProblem2D&) = delete;
  OptimizationProblem2D& operator=(const OptimizationProblem2D&) = delete;

  void AddImuData(int trajectory_id, const sensor::ImuData& imu_data) override;
  void AddOdometryData(int trajectory_id,
                       const sensor::OdometryData& odometry_data) override;
  void AddTrajectoryNode(int trajectory_id,
                         const NodeSpec2D& node_data) override;
  void InsertTrajectoryNode(const NodeId& node_id,
                            const NodeSpec2D& node_data) override;
  void TrimTrajectoryNode(const NodeId& node_id) override;
  void AddSubmap(int trajectory_id,
                 const transform::Rigid2d& global_submap_pose) override;
  void InsertSubmap(const SubmapId& submap_id,
                    const transform::Rigid2d& global_submap_pose) override;
  void TrimSubmap(const SubmapId& submap_id) override;
  void SetMaxNumIterations(int32 max_num_iterations) override;
  void Solve(
      const std::vector<Constraint>& constraints,
      const std::map<int, PoseGraphInterface::TrajectoryState>&
          trajectories_state,
      const std::map<std::string, LandmarkNode>& landmark_nodes) override;

  const MapById<NodeId, NodeSpec2D>& node_data() const override;
  const MapById<SubmapId, SubmapSpec2D>& submap_data() const override;
  const std::map<std::string, transform::Rigid3d>& landmark_data()
      const override;
  const sensor::MapByTime<sensor::ImuData>& imu_data() const override;
  const sensor::MapByTime<sensor::OdometryData>& odometry_data() const override;

  // These four are not part of the interface.
  void AddFixedFramePoseData(
      int trajectory_id,
      const sensor::FixedFramePoseData& fixed_frame_pose_data);
  void SetTrajectoryData(
      int trajectory_id,
      const PoseGraphInterface::TrajectoryData& trajectory_data);
  const sensor::MapByTime<sensor::FixedFramePoseData>& fixed_frame_pose_data()
      const;
  const std::map<int, PoseGraphInterface::TrajectoryData>& trajectory_data()
      const;

 private:
  using Interface = OptimizationProblemInterface<NodeSpec2D, SubmapSpec2D,
                                                 transform::Rigid2d>;
  // Of the scope of construction, null without one.
  const std::shared_ptr<::cartographer_ext::PoseGraphContext> context_;
  std::unique_ptr<StockOptimizationProblem2D> stock_;
  std::unique_ptr<::cartographer_ext::optimization::RobustOptimizationProblem2D>
      robust_;
  // The one that exists.
  Interface* problem_ = nullptr;
};

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_EXT_OVERLAY_OPTIMIZATION_PROBLEM_2D_H_
#endif
