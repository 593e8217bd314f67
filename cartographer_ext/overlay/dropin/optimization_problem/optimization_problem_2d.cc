// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"

#include "absl/memory/memory.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/optimization/dropin/robust_optimization_problem_2d.h"
#include "cartographer_ext/optimization/dropin/stock_solve.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/overlay/signature.h"
#include "cartographer_ext/overlay/start_line.h"
#include "cartographer_ext/robust_optimization_options.pb.h"

#ifndef CARTOGRAPHER_EXT_OVERLAY_OPTIMIZATION_PROBLEM_2D_H_
#error \
    "The overlay of cartographer_ext is not first on the include path: another package puts Cartographer's sources before it."
#endif

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

using Stock = StockOptimizationProblem2D;
using ::cartographer_ext::PoseGraphContext;
using ::cartographer_ext::ScopedPoseGraphContext;
using ::cartographer_ext::optimization::RobustOptimizationProblem2D;

// The compiler checks the virtual functions against the interface.
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    Stock::AddFixedFramePoseData,
    void (Stock::*)(int, const sensor::FixedFramePoseData&));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    Stock::SetTrajectoryData,
    void (Stock::*)(int, const PoseGraphInterface::TrajectoryData&));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    Stock::fixed_frame_pose_data,
    const sensor::MapByTime<sensor::FixedFramePoseData>& (Stock::*)() const);
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    Stock::trajectory_data,
    const std::map<int, PoseGraphInterface::TrajectoryData>& (Stock::*)()
        const);

}  // namespace

OptimizationProblem2D::OptimizationProblem2D(
    const optimization::proto::OptimizationProblemOptions& options)
    : context_(PoseGraphContext::Current()) {
  ::cartographer_ext::proto::RobustOptimizationOptions extension;
  if (::cartographer_ext::options::GetExtension(options, &extension)) {
    ::cartographer_ext::LogStart(
        "OptimizationProblem2D",
        "POSE_GRAPH.optimization_problem.cartographer_ext", extension);
    robust_ =
        absl::make_unique<RobustOptimizationProblem2D>(options, extension);
    problem_ = robust_.get();
  } else {
    stock_ = absl::make_unique<Stock>(options);
    problem_ = stock_.get();
  }
}

OptimizationProblem2D::~OptimizationProblem2D() = default;

void OptimizationProblem2D::AddImuData(const int trajectory_id,
                                       const sensor::ImuData& imu_data) {
  problem_->AddImuData(trajectory_id, imu_data);
}

void OptimizationProblem2D::AddOdometryData(
    const int trajectory_id, const sensor::OdometryData& odometry_data) {
  problem_->AddOdometryData(trajectory_id, odometry_data);
}

void OptimizationProblem2D::AddTrajectoryNode(const int trajectory_id,
                                              const NodeSpec2D& node_data) {
  problem_->AddTrajectoryNode(trajectory_id, node_data);
}

void OptimizationProblem2D::InsertTrajectoryNode(const NodeId& node_id,
                                                 const NodeSpec2D& node_data) {
  problem_->InsertTrajectoryNode(node_id, node_data);
}

void OptimizationProblem2D::TrimTrajectoryNode(const NodeId& node_id) {
  problem_->TrimTrajectoryNode(node_id);
}

void OptimizationProblem2D::AddSubmap(
    const int trajectory_id, const transform::Rigid2d& global_submap_pose) {
  problem_->AddSubmap(trajectory_id, global_submap_pose);
}

void OptimizationProblem2D::InsertSubmap(
    const SubmapId& submap_id, const transform::Rigid2d& global_submap_pose) {
  problem_->InsertSubmap(submap_id, global_submap_pose);
}

void OptimizationProblem2D::TrimSubmap(const SubmapId& submap_id) {
  problem_->TrimSubmap(submap_id);
}

void OptimizationProblem2D::SetMaxNumIterations(
    const int32 max_num_iterations) {
  problem_->SetMaxNumIterations(max_num_iterations);
}

void OptimizationProblem2D::Solve(
    const std::vector<Constraint>& constraints,
    const std::map<int, PoseGraphInterface::TrajectoryState>&
        trajectories_state,
    const std::map<std::string, LandmarkNode>& landmark_nodes) {
  // Within a callback of the constraint builder of the same pose graph.
  std::shared_ptr<PoseGraphContext> context = PoseGraphContext::Current();
  if (context == nullptr) context = context_;
  std::vector<Constraint> kept;
  const std::vector<Constraint>& in_force =
      ::cartographer_ext::optimization::WithoutWithdrawnLoops(
          constraints, context.get(), &kept);
  if (stock_ != nullptr) {
    ::cartographer_ext::optimization::StockSolve(in_force, trajectories_state,
                                                 landmark_nodes, context.get(),
                                                 nullptr, stock_.get());
  } else {
    const ScopedPoseGraphContext scope(context);
    robust_->Solve(in_force, trajectories_state, landmark_nodes);
  }
}

const MapById<NodeId, NodeSpec2D>& OptimizationProblem2D::node_data() const {
  return problem_->node_data();
}

const MapById<SubmapId, SubmapSpec2D>& OptimizationProblem2D::submap_data()
    const {
  return problem_->submap_data();
}

const std::map<std::string, transform::Rigid3d>&
OptimizationProblem2D::landmark_data() const {
  return problem_->landmark_data();
}

const sensor::MapByTime<sensor::ImuData>& OptimizationProblem2D::imu_data()
    const {
  return problem_->imu_data();
}

const sensor::MapByTime<sensor::OdometryData>&
OptimizationProblem2D::odometry_data() const {
  return problem_->odometry_data();
}

void OptimizationProblem2D::AddFixedFramePoseData(
    const int trajectory_id,
    const sensor::FixedFramePoseData& fixed_frame_pose_data) {
  if (stock_ != nullptr) {
    stock_->AddFixedFramePoseData(trajectory_id, fixed_frame_pose_data);
  } else {
    robust_->AddFixedFramePoseData(trajectory_id, fixed_frame_pose_data);
  }
}

void OptimizationProblem2D::SetTrajectoryData(
    const int trajectory_id,
    const PoseGraphInterface::TrajectoryData& trajectory_data) {
  if (stock_ != nullptr) {
    stock_->SetTrajectoryData(trajectory_id, trajectory_data);
  } else {
    robust_->SetTrajectoryData(trajectory_id, trajectory_data);
  }
}

const sensor::MapByTime<sensor::FixedFramePoseData>&
OptimizationProblem2D::fixed_frame_pose_data() const {
  return stock_ != nullptr ? stock_->fixed_frame_pose_data()
                           : robust_->fixed_frame_pose_data();
}

const std::map<int, PoseGraphInterface::TrajectoryData>&
OptimizationProblem2D::trajectory_data() const {
  return stock_ != nullptr ? stock_->trajectory_data()
                           : robust_->trajectory_data();
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
