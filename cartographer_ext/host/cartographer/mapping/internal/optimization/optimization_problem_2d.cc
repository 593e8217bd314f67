// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"

#include <array>
#include <iterator>
#include <utility>

#include "cartographer/common/internal/ceres_solver_options.h"
#include "cartographer/mapping/internal/optimization/cost_functions/landmark_cost_function_2d.h"
#include "cartographer/mapping/internal/optimization/cost_functions/pose_error.h"
#include "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"
#include "cartographer/mapping/internal/optimization/sensor_readings.h"
#include "cartographer/transform/transform.h"
#include "ceres/ceres.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

// Ceres 2.1 renamed it; 2.2 has the new name only.
#if CERES_VERSION_MAJOR > 2 || \
    (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR >= 1)
using UnitQuaternion = ceres::QuaternionManifold;
#else
using UnitQuaternion = ceres::QuaternionParameterization;
#endif

using Values2D = std::array<double, 3>;  // x, y, theta
using TrajectoryData = PoseGraphInterface::TrajectoryData;
using TrajectoryState = PoseGraphInterface::TrajectoryState;

struct LandmarkValues {
  std::array<double, 4> rotation;  // w, x, y, z
  std::array<double, 3> translation;
};

Values2D ToValues(const transform::Rigid2d& pose) {
  return {{pose.translation().x(), pose.translation().y(),
           pose.normalized_angle()}};
}

transform::Rigid2d ToPose(const Values2D& values) {
  return transform::Rigid2d({values[0], values[1]}, values[2]);
}

LandmarkValues ToValues(const transform::Rigid3d& pose) {
  const Eigen::Quaterniond& q = pose.rotation();
  const Eigen::Vector3d& t = pose.translation();
  return LandmarkValues{{{q.w(), q.x(), q.y(), q.z()}},
                        {{t.x(), t.y(), t.z()}}};
}

transform::Rigid3d ToPose(const LandmarkValues& values) {
  return transform::Rigid3d::FromArrays(values.rotation, values.translation);
}

}  // namespace

// One optimisation: builds the problem, solves it, writes the results back.
class OptimizationProblem2D::Solver {
 public:
  Solver(OptimizationProblem2D* const data,
         const std::map<int, TrajectoryState>& trajectories_state)
      : data_(*data), options_(data->options_) {
    for (const auto& id_state : trajectories_state) {
      frozen_[id_state.first] = id_state.second == TrajectoryState::FROZEN;
    }
    for (const auto& submap : data_.submap_data_) {
      AddPose(submap.id, submap.data.global_pose, &submaps_);
    }
    if (!submaps_.empty()) {
      problem_.SetParameterBlockConstant(
          submaps_.at((*submaps_.begin()).id).data());
    }
    for (const auto& node : data_.node_data_) {
      AddPose(node.id, node.data.global_pose_2d, &nodes_);
    }
  }

  void AddConstraints(const std::vector<Constraint>& constraints) {
    for (const Constraint& constraint : constraints) {
      AddSpaTerm(constraint.pose,
                 constraint.tag == Constraint::INTER_SUBMAP
                     ? new ceres::HuberLoss(options_.huber_scale())
                     : nullptr,
                 &submaps_.at(constraint.submap_id),
                 &nodes_.at(constraint.node_id));
    }
  }

  // Between nodes that follow each other, without a trimmed one in between.
  void AddConsecutiveNodeTerms() {
    for (const int trajectory_id : data_.node_data_.trajectory_ids()) {
      if (IsFrozen(trajectory_id)) {
        continue;
      }
      const auto nodes = data_.node_data_.trajectory(trajectory_id);
      auto previous = nodes.begin();
      for (auto next = std::next(previous); next != nodes.end();
           previous = next, ++next) {
        const auto first = *previous;
        const auto second = *next;
        if (second.id.node_index != first.id.node_index + 1) {
          continue;
        }
        const auto odometry =
            data_.OdometryBetween(trajectory_id, first.data, second.data);
        if (odometry.has_value()) {
          AddSpaTerm(Constraint::Pose{*odometry,
                                      options_.odometry_translation_weight(),
                                      options_.odometry_rotation_weight()},
                     nullptr, &nodes_.at(first.id), &nodes_.at(second.id));
        }
        const transform::Rigid2d local_slam =
            first.data.local_pose_2d.inverse() * second.data.local_pose_2d;
        AddSpaTerm(
            Constraint::Pose{transform::Embed3D(local_slam),
                             options_.local_slam_pose_translation_weight(),
                             options_.local_slam_pose_rotation_weight()},
            nullptr, &nodes_.at(first.id), &nodes_.at(second.id));
      }
    }
  }

  void AddLandmarks(const std::map<std::string, LandmarkNode>& landmark_nodes) {
    for (const auto& id_landmark : landmark_nodes) {
      for (const auto& observation : id_landmark.second.landmark_observations) {
        AddLandmarkObservation(id_landmark.first, id_landmark.second,
                               observation);
      }
    }
  }

  void AddFixedFrames() {
    for (const int trajectory_id : data_.node_data_.trajectory_ids()) {
      for (const auto& node : data_.node_data_.trajectory(trajectory_id)) {
        const auto pose =
            PoseAt(data_.fixed_frame_pose_data_, trajectory_id, node.data.time);
        if (!pose.has_value()) {
          continue;
        }
        if (fixed_frames_.count(trajectory_id) == 0) {
          const auto& origin = data_.trajectory_data_.at(trajectory_id)
                                   .fixed_frame_origin_in_map;
          fixed_frames_[trajectory_id] = ToValues(
              origin.has_value() ? transform::Project2D(*origin)
                                 : node.data.global_pose_2d *
                                       transform::Project2D(*pose).inverse());
        }
        AddSpaTerm(
            Constraint::Pose{*pose,
                             options_.fixed_frame_pose_translation_weight(),
                             options_.fixed_frame_pose_rotation_weight()},
            options_.fixed_frame_pose_use_tolerant_loss()
                ? new ceres::TolerantLoss(
                      options_.fixed_frame_pose_tolerant_loss_param_a(),
                      options_.fixed_frame_pose_tolerant_loss_param_b())
                : nullptr,
            &fixed_frames_.at(trajectory_id), &nodes_.at(node.id));
      }
    }
  }

  void SolveAndStore() {
    ceres::Solver::Options solver_options =
        common::CreateCeresSolverOptions(options_.ceres_solver_options());
    // With several threads the order of summation in Ceres varies.
    solver_options.num_threads = 1;
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options, &problem_, &summary);
    LOG_IF(INFO, options_.log_solver_summary()) << summary.FullReport();
    if (!summary.IsSolutionUsable()) {
      LOG(ERROR) << "the poses stay as they are: " << summary.message;
      return;
    }
    for (const auto& submap : submaps_) {
      data_.submap_data_.at(submap.id).global_pose = ToPose(submap.data);
    }
    for (const auto& node : nodes_) {
      data_.node_data_.at(node.id).global_pose_2d = ToPose(node.data);
    }
    for (const auto& id_frame : fixed_frames_) {
      data_.trajectory_data_.at(id_frame.first).fixed_frame_origin_in_map =
          transform::Embed3D(ToPose(id_frame.second));
    }
    for (const auto& id_landmark : landmarks_) {
      data_.landmark_data_[id_landmark.first] = ToPose(id_landmark.second);
    }
  }

 private:
  bool IsFrozen(const int trajectory_id) const {
    const auto it = frozen_.find(trajectory_id);
    return it != frozen_.end() && it->second;
  }

  template <typename IdType>
  void AddPose(const IdType& id, const transform::Rigid2d& pose,
               MapById<IdType, Values2D>* const values) {
    values->Insert(id, ToValues(pose));
    double* const block = values->at(id).data();
    problem_.AddParameterBlock(block, 3);
    if (IsFrozen(id.trajectory_id)) {
      problem_.SetParameterBlockConstant(block);
    }
  }

  void AddSpaTerm(const Constraint::Pose& pose, ceres::LossFunction* const loss,
                  Values2D* const start, Values2D* const end) {
    problem_.AddResidualBlock(CreateAnalyticalSpaCostFunction(pose), loss,
                              start->data(), end->data());
  }

  using NodeIterator = MapById<NodeId, NodeSpec2D>::ConstIterator;

  // The second of the two nodes around an observation, which may be at the time
  // of either; the end of the trajectory where it is not between two nodes.
  NodeIterator NodeAfter(
      const LandmarkNode::LandmarkObservation& observation) const {
    const MapById<NodeId, NodeSpec2D>& nodes = data_.node_data_;
    const auto first = nodes.BeginOfTrajectory(observation.trajectory_id);
    const auto end = nodes.EndOfTrajectory(observation.trajectory_id);
    if (first == end || observation.time < first->data.time) {
      return end;
    }
    const auto at_or_after =
        nodes.lower_bound(observation.trajectory_id, observation.time);
    return at_or_after == first ? std::next(first) : at_or_after;
  }

  void AddLandmarkObservation(
      const std::string& id, const LandmarkNode& landmark,
      const LandmarkNode::LandmarkObservation& observation) {
    const NodeIterator after = NodeAfter(observation);
    if (after == data_.node_data_.EndOfTrajectory(observation.trajectory_id)) {
      return;
    }
    const NodeIterator before = std::prev(after);
    const ObservationSite site(before->data, after->data, observation.time);
    Values2D* const values_before = &nodes_.at(before->id);
    Values2D* const values_after = &nodes_.at(after->id);
    auto found = landmarks_.find(id);
    if (found == landmarks_.end()) {
      found = AddLandmark(
          id, landmark,
          SeenAt(site.TrackingPose(values_before->data(), values_after->data()),
                 observation));
    }
    problem_.AddResidualBlock(CreateLandmarkCostFunction2D(observation, site),
                              new ceres::HuberLoss(options_.huber_scale()),
                              values_before->data(), values_after->data(),
                              found->second.rotation.data(),
                              found->second.translation.data());
  }

  static transform::Rigid3d SeenAt(
      const SpatialPose<double>& tracking,
      const LandmarkNode::LandmarkObservation& observation) {
    return transform::Rigid3d(tracking.translation, tracking.rotation) *
           observation.landmark_to_tracking_transform;
  }

  // Starts at the pose given for the landmark, else where it was `first_seen`.
  std::map<std::string, LandmarkValues>::iterator AddLandmark(
      const std::string& id, const LandmarkNode& landmark,
      const transform::Rigid3d& first_seen) {
    const auto added = landmarks_.emplace(
        id, ToValues(landmark.global_landmark_pose.value_or(first_seen)));
    LandmarkValues& values = added.first->second;
    problem_.AddParameterBlock(values.rotation.data(), 4, new UnitQuaternion);
    problem_.AddParameterBlock(values.translation.data(), 3);
    if (landmark.frozen) {
      problem_.SetParameterBlockConstant(values.rotation.data());
      problem_.SetParameterBlockConstant(values.translation.data());
    }
    return added.first;
  }

  OptimizationProblem2D& data_;
  const optimization::proto::OptimizationProblemOptions& options_;
  std::map<int, bool> frozen_;
  // Ceres keeps pointers to these values.
  MapById<SubmapId, Values2D> submaps_;
  MapById<NodeId, Values2D> nodes_;
  std::map<int, Values2D> fixed_frames_;
  std::map<std::string, LandmarkValues> landmarks_;
  ceres::Problem problem_;
};

OptimizationProblem2D::OptimizationProblem2D(
    const proto::OptimizationProblemOptions& options)
    : options_(options) {}

OptimizationProblem2D::~OptimizationProblem2D() {}

void OptimizationProblem2D::AddImuData(const int /*trajectory_id*/,
                                       const sensor::ImuData& /*imu_data*/) {}

void OptimizationProblem2D::AddOdometryData(
    const int trajectory_id, const sensor::OdometryData& odometry_data) {
  if (!IsNewer(odometry_data_, trajectory_id, odometry_data.time)) {
    LOG_EVERY_N(WARNING, 100) << "dropped an odometry reading out of order";
    return;
  }
  odometry_data_.Append(trajectory_id, odometry_data);
}

void OptimizationProblem2D::AddFixedFramePoseData(
    const int trajectory_id,
    const sensor::FixedFramePoseData& fixed_frame_pose_data) {
  if (!IsNewer(fixed_frame_pose_data_, trajectory_id,
               fixed_frame_pose_data.time)) {
    LOG_EVERY_N(WARNING, 100) << "dropped a fixed frame pose out of order";
    return;
  }
  fixed_frame_pose_data_.Append(trajectory_id, fixed_frame_pose_data);
}

void OptimizationProblem2D::SetTrajectoryData(
    const int trajectory_id, const TrajectoryData& trajectory_data) {
  trajectory_data_[trajectory_id] = trajectory_data;
}

void OptimizationProblem2D::AddTrajectoryNode(const int trajectory_id,
                                              const NodeSpec2D& node_data) {
  node_data_.Append(trajectory_id, node_data);
  trajectory_data_.emplace(trajectory_id, TrajectoryData());
}

void OptimizationProblem2D::InsertTrajectoryNode(const NodeId& node_id,
                                                 const NodeSpec2D& node_data) {
  node_data_.Insert(node_id, node_data);
  trajectory_data_.emplace(node_id.trajectory_id, TrajectoryData());
}

void OptimizationProblem2D::TrimTrajectoryNode(const NodeId& node_id) {
  const bool trajectory_ends =
      node_data_.SizeOfTrajectoryOrZero(node_id.trajectory_id) == 1;
  const auto trim_readings = [this, &node_id](auto* const readings) {
    readings->Trim(node_data_, node_id);
  };
  trim_readings(&fixed_frame_pose_data_);
  trim_readings(&odometry_data_);
  if (trajectory_ends) {
    trajectory_data_.erase(node_id.trajectory_id);
  }
  node_data_.Trim(node_id);
}

void OptimizationProblem2D::AddSubmap(
    const int trajectory_id, const transform::Rigid2d& global_submap_pose) {
  submap_data_.Append(trajectory_id, SubmapSpec2D{global_submap_pose});
}

void OptimizationProblem2D::InsertSubmap(
    const SubmapId& submap_id, const transform::Rigid2d& global_submap_pose) {
  submap_data_.Insert(submap_id, SubmapSpec2D{global_submap_pose});
}

void OptimizationProblem2D::TrimSubmap(const SubmapId& submap_id) {
  submap_data_.Trim(submap_id);
}

void OptimizationProblem2D::SetMaxNumIterations(
    const int32 max_num_iterations) {
  options_.mutable_ceres_solver_options()->set_max_num_iterations(
      max_num_iterations);
}

void OptimizationProblem2D::Solve(
    const std::vector<Constraint>& constraints,
    const std::map<int, TrajectoryState>& trajectories_state,
    const std::map<std::string, LandmarkNode>& landmark_nodes) {
  if (node_data_.empty()) {
    // Ceres does not call an empty problem solved.
    return;
  }
  Solver solver(this, trajectories_state);
  solver.AddConstraints(constraints);
  solver.AddLandmarks(landmark_nodes);
  solver.AddConsecutiveNodeTerms();
  solver.AddFixedFrames();
  solver.SolveAndStore();
}

absl::optional<transform::Rigid3d> OptimizationProblem2D::OdometryBetween(
    const int trajectory_id, const NodeSpec2D& first,
    const NodeSpec2D& second) const {
  const auto odometry_first = PoseAt(odometry_data_, trajectory_id, first.time);
  if (!odometry_first.has_value()) {
    return absl::nullopt;
  }
  const auto odometry_second =
      PoseAt(odometry_data_, trajectory_id, second.time);
  if (!odometry_second.has_value()) {
    return absl::nullopt;
  }
  // Odometry measures the tracking frame, nodes are gravity aligned.
  return transform::Rigid3d::Rotation(first.gravity_alignment) *
         odometry_first->inverse() * *odometry_second *
         transform::Rigid3d::Rotation(second.gravity_alignment.inverse());
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
