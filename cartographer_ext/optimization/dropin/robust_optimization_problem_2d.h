// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// OptimizationProblem2D for options with our block: before each optimization it
// selects the loop constraints to optimize with (SelectLoops); the stock
// problem does everything else, so without wrong loops the result is that of
// stock. Disabled loops are recorded in the current PoseGraphContext.
//
// With `running_tolerance`, the optimisations during a run end early
// (running_solve.h); the final one is stock's.
//
// With `recent_nodes`, most optimisations during a long run are of its newest
// part only (recent_solve.h). The whole graph is optimised when it has grown by
// a tenth, when new loops move the newest part by much, and in the end; so the
// optimisations of a run cost in proportion to its length.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_ROBUST_OPTIMIZATION_PROBLEM_2D_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_ROBUST_OPTIMIZATION_PROBLEM_2D_H_

#include <map>
#include <set>
#include <string>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer_ext/common/loop_id.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/optimization/graph/relaxation.h"
#include "cartographer_ext/optimization/graph/slam_pose_graph.h"
#include "cartographer_ext/optimization/selection/loop_selection.h"
#include "cartographer_ext/optimization/selection/switched_loops.h"
#include "cartographer_ext/robust_optimization_options.pb.h"

namespace cartographer_ext {
namespace optimization {

class RobustOptimizationProblem2D
    : public cartographer::mapping::optimization::OptimizationProblemInterface<
          cartographer::mapping::optimization::NodeSpec2D,
          cartographer::mapping::optimization::SubmapSpec2D,
          cartographer::transform::Rigid2d> {
 public:
  using NodeId = cartographer::mapping::NodeId;
  using SubmapId = cartographer::mapping::SubmapId;
  using NodeSpec2D = cartographer::mapping::optimization::NodeSpec2D;
  using SubmapSpec2D = cartographer::mapping::optimization::SubmapSpec2D;
  using PoseGraphInterface = cartographer::mapping::PoseGraphInterface;

  RobustOptimizationProblem2D(
      const cartographer::mapping::optimization::proto::
          OptimizationProblemOptions& options,
      const proto::RobustOptimizationOptions& extension);

  void AddImuData(int trajectory_id,
                  const cartographer::sensor::ImuData& imu_data) override {
    stock_.AddImuData(trajectory_id, imu_data);
  }
  void AddOdometryData(
      int trajectory_id,
      const cartographer::sensor::OdometryData& odometry_data) override {
    stock_.AddOdometryData(trajectory_id, odometry_data);
  }
  void AddTrajectoryNode(int trajectory_id,
                         const NodeSpec2D& node_data) override {
    stock_.AddTrajectoryNode(trajectory_id, node_data);
    if (recent_nodes() == 0) return;
    nodes_.Append(trajectory_id, node_data);
    grown_.insert(trajectory_id);
  }
  void InsertTrajectoryNode(const NodeId& node_id,
                            const NodeSpec2D& node_data) override {
    stock_.InsertTrajectoryNode(node_id, node_data);
    if (recent_nodes() > 0) nodes_.Insert(node_id, node_data);
  }
  void TrimTrajectoryNode(const NodeId& node_id) override {
    stock_.TrimTrajectoryNode(node_id);
    if (recent_nodes() > 0) nodes_.Trim(node_id);
  }
  void AddSubmap(
      int trajectory_id,
      const cartographer::transform::Rigid2d& global_submap_pose) override {
    stock_.AddSubmap(trajectory_id, global_submap_pose);
    if (recent_nodes() == 0) return;
    submaps_.Append(trajectory_id, SubmapSpec2D{global_submap_pose});
  }
  void InsertSubmap(
      const SubmapId& submap_id,
      const cartographer::transform::Rigid2d& global_submap_pose) override {
    stock_.InsertSubmap(submap_id, global_submap_pose);
    if (recent_nodes() == 0) return;
    submaps_.Insert(submap_id, SubmapSpec2D{global_submap_pose});
  }
  void TrimSubmap(const SubmapId& submap_id) override {
    stock_.TrimSubmap(submap_id);
    if (recent_nodes() > 0) submaps_.Trim(submap_id);
  }
  void SetMaxNumIterations(cartographer::int32 max_num_iterations) override {
    // PoseGraph2D does this before and after its final optimization.
    is_final_ = max_num_iterations > stock_iterations_;
    if (is_final_) {
      nodes_when_thorough_ = 0;
      nodes_when_whole_ = 0;
    }
    options_.mutable_ceres_solver_options()->set_max_num_iterations(
        max_num_iterations);
    stock_iterations_ = max_num_iterations;
    stock_.SetMaxNumIterations(max_num_iterations);
  }

  void Solve(
      const std::vector<Constraint>& constraints,
      const std::map<int, PoseGraphInterface::TrajectoryState>&
          trajectories_state,
      const std::map<std::string, LandmarkNode>& landmark_nodes) override;

  const cartographer::mapping::MapById<NodeId, NodeSpec2D>& node_data()
      const override {
    return recent_nodes() > 0 ? nodes_ : stock_.node_data();
  }
  const cartographer::mapping::MapById<SubmapId, SubmapSpec2D>& submap_data()
      const override {
    return recent_nodes() > 0 ? submaps_ : stock_.submap_data();
  }
  const std::map<std::string, cartographer::transform::Rigid3d>& landmark_data()
      const override {
    return stock_.landmark_data();
  }
  const cartographer::sensor::MapByTime<cartographer::sensor::ImuData>&
  imu_data() const override {
    return stock_.imu_data();
  }
  const cartographer::sensor::MapByTime<cartographer::sensor::OdometryData>&
  odometry_data() const override {
    return stock_.odometry_data();
  }

  void AddFixedFramePoseData(
      int trajectory_id, const cartographer::sensor::FixedFramePoseData& data) {
    stock_.AddFixedFramePoseData(trajectory_id, data);
  }
  void SetTrajectoryData(int trajectory_id,
                         const PoseGraphInterface::TrajectoryData& data) {
    stock_.SetTrajectoryData(trajectory_id, data);
  }
  const cartographer::sensor::MapByTime<
      cartographer::sensor::FixedFramePoseData>&
  fixed_frame_pose_data() const {
    return stock_.fixed_frame_pose_data();
  }
  const std::map<int, PoseGraphInterface::TrajectoryData>& trajectory_data()
      const {
    return stock_.trajectory_data();
  }

 private:
  SlamPoseGraph MakeProblem(
      const std::vector<Constraint>& constraints,
      const std::map<int, PoseGraphInterface::TrajectoryState>&
          trajectories_state) const;
  // The constraints to optimize with; disabled loops are added to `off`.
  std::vector<Constraint> Select(
      const std::vector<Constraint>& constraints,
      const std::map<int, PoseGraphInterface::TrajectoryState>&
          trajectories_state,
      std::vector<SwitchedLoop>* off);

  int recent_nodes() const { return extension_.recent_nodes(); }
  // Optimises the newest part only; returns whether that is enough.
  bool SolveRecentPart(
      const std::vector<Constraint>& constraints,
      const std::map<int, PoseGraphInterface::TrajectoryState>&
          trajectories_state,
      const std::map<std::string, LandmarkNode>& landmark_nodes,
      PoseGraphContext* context);
  // The whole graph.
  void SolveWhole(const std::vector<Constraint>& constraints,
                  const std::map<int, PoseGraphInterface::TrajectoryState>&
                      trajectories_state,
                  const std::map<std::string, LandmarkNode>& landmark_nodes,
                  PoseGraphContext* context);
  bool HasFixedFrames() const;
  // At the end of a run: with loops that the map contradicts put in force; returns
  // how the problem was relaxed for that, if it was.
  absl::optional<Relaxation> PutInForce(
      const std::vector<Constraint>& constraints,
      const std::map<int, PoseGraphInterface::TrajectoryState>&
          trajectories_state,
      PoseGraphContext* context);

  // At the end of a run: withdraws loops that the map contradicts even so.
  void TakeBack(const absl::optional<Relaxation>& relaxation,
                const std::map<int, PoseGraphInterface::TrajectoryState>&
                    trajectories_state,
                const std::map<std::string, LandmarkNode>& landmark_nodes,
                PoseGraphContext* context, std::vector<Constraint> constraints);

  const proto::RobustOptimizationOptions extension_;
  cartographer::mapping::optimization::proto::OptimizationProblemOptions
      options_;
  cartographer::mapping::optimization::StockOptimizationProblem2D stock_;
  int stock_iterations_;
  bool is_final_ = false;
  // Number of nodes at the last thorough selection.
  int nodes_when_thorough_ = 0;
  std::set<LoopId> switched_off_;

  // With `recent_nodes`: the poses, those of `stock_` as of the last
  // optimisation of the whole graph and newer ones.
  cartographer::mapping::MapById<NodeId, NodeSpec2D> nodes_;
  cartographer::mapping::MapById<SubmapId, SubmapSpec2D> submaps_;
  // Number of nodes, and trajectories that have grown since, at the last
  // optimisation of the whole graph.
  int nodes_when_whole_ = 0;
  std::set<int> grown_;
};

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_ROBUST_OPTIMIZATION_PROBLEM_2D_H_
