// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How far an observed landmark is from where the observation puts it: the robot
// at the time of the observation is interpolated between the two nodes around
// it, the error is that of ComputeUnscaledError in space.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_LANDMARK_COST_FUNCTION_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_LANDMARK_COST_FUNCTION_2D_H_

#include <algorithm>
#include <array>
#include <tuple>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer/common/time.h"
#include "cartographer/mapping/internal/optimization/cost_functions/cost_helpers.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/transform.h"
#include "ceres/ceres.h"
#include "ceres/jet.h"

namespace cartographer {
namespace mapping {
namespace optimization {

class LandmarkCostFunction2D {
 public:
  using LandmarkObservation =
      PoseGraphInterface::LandmarkNode::LandmarkObservation;

  // Six residuals. Parameter blocks: (x, y, theta) of the node before and of
  // the node after, quaternion (w, x, y, z) and translation of the landmark.
  // The nodes must differ in time.
  static ceres::CostFunction* CreateAutoDiffCostFunction(
      const LandmarkObservation& observation, const NodeSpec2D& prev_node,
      const NodeSpec2D& next_node) {
    return new ceres::AutoDiffCostFunction<LandmarkCostFunction2D, 6, 3, 3, 4,
                                           3>(
        new LandmarkCostFunction2D(observation, prev_node, next_node));
  }

  template <typename T>
  bool operator()(const T* const prev_node_pose, const T* const next_node_pose,
                  const T* const landmark_rotation,
                  const T* const landmark_translation, T* const e) const {
    const auto tracking =
        InterpolateNodes2D(prev_node_pose, prev_gravity_alignment_,
                           next_node_pose, next_gravity_alignment_, fraction_);
    const auto error = ScaleError(
        ComputeUnscaledError(observation_.landmark_to_tracking_transform,
                             std::get<0>(tracking).data(),
                             std::get<1>(tracking).data(), landmark_rotation,
                             landmark_translation),
        observation_.translation_weight, observation_.rotation_weight);
    std::copy(error.begin(), error.end(), e);
    return true;
  }

 private:
  LandmarkCostFunction2D(const LandmarkObservation& observation,
                         const NodeSpec2D& prev_node,
                         const NodeSpec2D& next_node)
      : observation_(observation),
        prev_gravity_alignment_(prev_node.gravity_alignment),
        next_gravity_alignment_(next_node.gravity_alignment),
        fraction_(common::ToSeconds(observation.time - prev_node.time) /
                  common::ToSeconds(next_node.time - prev_node.time)) {}

  const LandmarkObservation observation_;
  const Eigen::Quaterniond prev_gravity_alignment_;
  const Eigen::Quaterniond next_gravity_alignment_;
  const double fraction_;
};

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_LANDMARK_COST_FUNCTION_2D_H_
