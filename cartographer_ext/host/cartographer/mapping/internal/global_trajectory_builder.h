// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Joins local SLAM of one trajectory with the pose graph: what local SLAM
// inserts becomes a node.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_GLOBAL_TRAJECTORY_BUILDER_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_GLOBAL_TRAJECTORY_BUILDER_H_

#include <memory>
#include <set>

#include "cartographer/mapping/internal/2d/pose_graph_2d.h"
#include "cartographer/mapping/internal/local_slam_result_data.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "cartographer/metrics/family_factory.h"

namespace cartographer {
namespace mapping {

// Local SLAM runs where the options of the trajectory have its options;
// otherwise only results of local SLAM and data for the pose graph are
// accepted. The motion filter of the options, if any, thins out the odometry
// that the pose graph gets.
std::unique_ptr<TrajectoryBuilderInterface> CreateGlobalTrajectoryBuilder2D(
    const proto::TrajectoryBuilderOptions& options,
    const std::set<TrajectoryBuilderInterface::SensorId>& sensor_ids,
    int trajectory_id, PoseGraph2D* pose_graph,
    const TrajectoryBuilderInterface::LocalSlamResultCallback&
        local_slam_result_callback);

void GlobalTrajectoryBuilderRegisterMetrics(
    metrics::FamilyFactory* family_factory);

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_GLOBAL_TRAJECTORY_BUILDER_H_
