// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The residual of a landmark observation: the robot at the time of the
// observation is interpolated between the nodes before and after it, and the
// landmark seen from there is compared with the observation in space.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_LANDMARK_COST_FUNCTION_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_LANDMARK_COST_FUNCTION_2D_H_

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer/common/time.h"
#include "cartographer/mapping/internal/optimization/cost_functions/pose_error.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "ceres/ceres.h"

namespace cartographer {
namespace mapping {
namespace optimization {

using LandmarkObservation =
    PoseGraphInterface::LandmarkNode::LandmarkObservation;

// Where between two nodes of different times something was observed.
struct ObservationSite {
  ObservationSite(const NodeSpec2D& before, const NodeSpec2D& after,
                  const common::Time time)
      : gravity_alignment_before(before.gravity_alignment),
        gravity_alignment_after(after.gravity_alignment),
        fraction(common::ToSeconds(time - before.time) /
                 common::ToSeconds(after.time - before.time)) {}

  // The tracking frame, given the poses (x, y, theta) of the nodes.
  template <typename T>
  SpatialPose<T> TrackingPose(const T* const before,
                              const T* const after) const {
    return InterpolatePoses(
        SpatialPose<T>::OfNode(before, gravity_alignment_before),
        SpatialPose<T>::OfNode(after, gravity_alignment_after), fraction);
  }

  Eigen::Quaterniond gravity_alignment_before;
  Eigen::Quaterniond gravity_alignment_after;
  double fraction;  // 0 at the node before, 1 at the one after
};

struct LandmarkError {
  template <typename T>
  bool operator()(const T* const before, const T* const after,
                  const T* const landmark_wxyz, const T* const landmark_xyz,
                  T* const residuals) const {
    Eigen::Map<Eigen::Matrix<T, 6, 1>>(residuals, 6) =
        SpatialError(observation.landmark_to_tracking_transform,
                     ErrorWeights{observation.translation_weight,
                                  observation.rotation_weight},
                     site.TrackingPose(before, after),
                     SpatialPose<T>::OfBlocks(landmark_wxyz, landmark_xyz));
    return true;
  }

  LandmarkObservation observation;
  ObservationSite site;
};

// Six residuals. Parameter blocks: (x, y, theta) of the node before and of the
// node after, quaternion (w, x, y, z) and translation of the landmark.
inline ceres::CostFunction* CreateLandmarkCostFunction2D(
    const LandmarkObservation& observation, const ObservationSite& site) {
  return new ceres::AutoDiffCostFunction<LandmarkError, 6, 3, 3, 4, 3>(
      new LandmarkError{observation, site});
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_LANDMARK_COST_FUNCTION_2D_H_
