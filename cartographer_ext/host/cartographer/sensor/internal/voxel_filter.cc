// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/internal/voxel_filter.h"

#include <algorithm>
#include <array>
#include <random>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "cartographer/common/internal/read_options.h"
#include "cartographer/common/math.h"

namespace cartographer {
namespace sensor {

namespace {

// Uniform in [0, n). Draws from the engine like the standard library of GCC
// does, so that clouds agree with those of programs built with that.
uint32 UniformBelow(const uint32 n, std::minstd_rand0* const engine) {
  constexpr uint32 kRange = std::minstd_rand0::max() - std::minstd_rand0::min();
  const uint32 width = kRange / n;
  uint32 draw;
  do {
    draw = (*engine)() - std::minstd_rand0::min();
  } while (draw >= n * width);
  return draw / width;
}

using Voxel = std::array<int32, 3>;

Voxel VoxelOf(const Eigen::Vector3f& position, const float resolution) {
  return {{common::RoundToInt(position.x() / resolution),
           common::RoundToInt(position.y() / resolution),
           common::RoundToInt(position.z() / resolution)}};
}

// Indices of one point a voxel, ascending. `position_of(i)` is a point.
template <typename PositionOf>
std::vector<size_t> ChooseOnePerVoxel(const size_t size, const float resolution,
                                      const PositionOf& position_of) {
  struct Choice {
    uint32 num_points = 0;
    uint32 slot = 0;
  };
  absl::flat_hash_map<Voxel, Choice> voxels;
  voxels.reserve(size);
  // In order of the first point of each voxel.
  std::vector<size_t> chosen;
  std::minstd_rand0 engine;
  for (size_t i = 0; i != size; ++i) {
    Choice& choice = voxels[VoxelOf(position_of(i), resolution)];
    ++choice.num_points;
    if (choice.num_points == 1) {
      choice.slot = static_cast<uint32>(chosen.size());
      chosen.push_back(i);
    } else if (UniformBelow(choice.num_points, &engine) + 1 ==
               choice.num_points) {
      // The n-th point replaces the choice so far with chance 1/n.
      chosen[choice.slot] = i;
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

template <typename T>
std::vector<T> Pick(const std::vector<T>& all,
                    const std::vector<size_t>& indices) {
  std::vector<T> result;
  result.reserve(indices.size());
  for (const size_t i : indices) result.push_back(all[i]);
  return result;
}

}  // namespace

std::vector<RangefinderPoint> VoxelFilter(
    const std::vector<RangefinderPoint>& points, const float resolution) {
  return Pick(points, ChooseOnePerVoxel(
                          points.size(), resolution,
                          [&points](const size_t i) -> const Eigen::Vector3f& {
                            return points[i].position;
                          }));
}

PointCloud VoxelFilter(const PointCloud& point_cloud, const float resolution) {
  const std::vector<RangefinderPoint>& points = point_cloud.points();
  const std::vector<size_t> chosen =
      ChooseOnePerVoxel(points.size(), resolution,
                        [&points](const size_t i) -> const Eigen::Vector3f& {
                          return points[i].position;
                        });
  if (point_cloud.intensities().empty())
    return PointCloud(Pick(points, chosen));
  return PointCloud(Pick(points, chosen),
                    Pick(point_cloud.intensities(), chosen));
}

TimedPointCloud VoxelFilter(const TimedPointCloud& timed_point_cloud,
                            const float resolution) {
  return Pick(timed_point_cloud,
              ChooseOnePerVoxel(timed_point_cloud.size(), resolution,
                                [&timed_point_cloud](
                                    const size_t i) -> const Eigen::Vector3f& {
                                  return timed_point_cloud[i].position;
                                }));
}

std::vector<TimedPointCloudOriginData::RangeMeasurement> VoxelFilter(
    const std::vector<TimedPointCloudOriginData::RangeMeasurement>&
        range_measurements,
    const float resolution) {
  return Pick(
      range_measurements,
      ChooseOnePerVoxel(
          range_measurements.size(), resolution,
          [&range_measurements](const size_t i) -> const Eigen::Vector3f& {
            return range_measurements[i].point_time.position;
          }));
}

proto::AdaptiveVoxelFilterOptions CreateAdaptiveVoxelFilterOptions(
    common::LuaParameterDictionary* const table) {
  const auto options =
      common::ReadOptions<proto::AdaptiveVoxelFilterOptions>(table);
  CHECK_GE(options.min_num_points(), 0.f) << "min_num_points";
  return options;
}

PointCloud AdaptiveVoxelFilter(
    const PointCloud& point_cloud,
    const proto::AdaptiveVoxelFilterOptions& options) {
  const float max_range = options.max_range();
  const PointCloud near =
      point_cloud.copy_if([max_range](const RangefinderPoint& point) {
        return point.position.norm() <= max_range;
      });
  const auto is_enough = [&options](const PointCloud& cloud) {
    return cloud.size() >= options.min_num_points();
  };
  if (near.size() <= options.min_num_points()) return near;

  PointCloud result = VoxelFilter(near, options.max_length());
  if (is_enough(result)) return result;

  // Halve the length until enough is left, at a hundredth at the latest.
  float too_long = options.max_length();
  while (too_long > 1e-2f * options.max_length()) {
    float enough = too_long / 2.f;
    result = VoxelFilter(near, enough);
    if (!is_enough(result)) {
      too_long = enough;
      continue;
    }
    // Bisect until the length is known to a tenth.
    while ((too_long - enough) / enough > 1e-1f) {
      const float middle = (enough + too_long) / 2.f;
      PointCloud candidate = VoxelFilter(near, middle);
      if (is_enough(candidate)) {
        enough = middle;
        result = std::move(candidate);
      } else {
        too_long = middle;
      }
    }
    break;
  }
  return result;
}

}  // namespace sensor
}  // namespace cartographer
