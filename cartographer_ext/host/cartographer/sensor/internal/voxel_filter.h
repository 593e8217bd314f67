// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_INTERNAL_VOXEL_FILTER_H_
#define CARTOGRAPHER_SENSOR_INTERNAL_VOXEL_FILTER_H_

#include <vector>

#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/sensor/proto/adaptive_voxel_filter_options.pb.h"
#include "cartographer/sensor/timed_point_cloud_data.h"

namespace cartographer {
namespace sensor {

// Keeps one point of every cube with edges of `resolution` metres, chosen with
// equal chances among the cube's points, in the order of the input. The random
// engine starts afresh in every call, so the same input gives the same output.
std::vector<RangefinderPoint> VoxelFilter(
    const std::vector<RangefinderPoint>& points, float resolution);
PointCloud VoxelFilter(const PointCloud& point_cloud, float resolution);
TimedPointCloud VoxelFilter(const TimedPointCloud& timed_point_cloud,
                            float resolution);
std::vector<TimedPointCloudOriginData::RangeMeasurement> VoxelFilter(
    const std::vector<TimedPointCloudOriginData::RangeMeasurement>&
        range_measurements,
    float resolution);

// Reads max_length, min_num_points and max_range.
proto::AdaptiveVoxelFilterOptions CreateAdaptiveVoxelFilterOptions(
    common::LuaParameterDictionary* parameter_dictionary);

// Drops points beyond max_range from the origin, then voxel-filters with nearly
// the largest edge up to max_length that leaves min_num_points points.
PointCloud AdaptiveVoxelFilter(
    const PointCloud& point_cloud,
    const proto::AdaptiveVoxelFilterOptions& options);

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_INTERNAL_VOXEL_FILTER_H_
