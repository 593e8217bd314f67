// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Options from the stock Lua files, and a robot in a room, for tests of the
// host's local and global SLAM.
#ifndef TESTS_HOST_SLAM_TEST_HELPERS_H_
#define TESTS_HOST_SLAM_TEST_HELPERS_H_

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer/transform/transform.h"

namespace cartographer {
namespace mapping {
namespace test {

struct SlamOptions {
  proto::MapBuilderOptions map_builder;
  proto::TrajectoryBuilderOptions trajectory_builder;
};

// The stock values after `changes`, a piece of Lua.
inline SlamOptions LoadSlamOptions(const std::string& changes) {
  common::LuaParameterDictionary dictionary(
      "include \"common_2d.lua\"\n" + changes +
          "\nreturn { map_builder = MAP_BUILDER, "
          "trajectory_builder = TRAJECTORY_BUILDER }",
      absl::make_unique<common::ConfigurationFileResolver>(
          std::vector<std::string>{"configuration_files"}));
  SlamOptions options;
  options.map_builder =
      CreateMapBuilderOptions(dictionary.GetDictionary("map_builder").get());
  options.trajectory_builder = CreateTrajectoryBuilderOptions(
      dictionary.GetDictionary("trajectory_builder").get());
  return options;
}

inline common::Time At(const double seconds) {
  return common::FromUniversal(10000000) + common::FromSeconds(seconds);
}

inline transform::Rigid3d Planar(const double x, const double y,
                                 const double yaw) {
  return transform::Rigid3d(
      Eigen::Vector3d(x, y, 0.),
      Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())));
}

// An L-shaped room of 12 m by 9 m with a pillar; walls as pairs of ends.
inline const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& Walls() {
  static const auto* const walls =
      new std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>{
          {{-4., -3.}, {8., -3.}},    {{8., -3.}, {8., 2.}},
          {{8., 2.}, {3., 2.}},       {{3., 2.}, {3., 6.}},
          {{3., 6.}, {-4., 6.}},      {{-4., 6.}, {-4., -3.}},
          {{4.9, -1.2}, {5.6, -1.2}}, {{5.6, -1.2}, {5.6, -0.4}},
          {{5.6, -0.4}, {4.9, -0.4}}, {{4.9, -0.4}, {4.9, -1.2}}};
  return *walls;
}

// The distance to the nearest wall in a direction.
inline double CastRay(const Eigen::Vector2d& from, const double angle) {
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& wall : Walls()) {
    const Eigen::Vector2d along = wall.second - wall.first;
    const Eigen::Vector2d offset = wall.first - from;
    const double det = direction.y() * along.x() - direction.x() * along.y();
    if (std::abs(det) < 1e-12) continue;
    const double range =
        (along.x() * offset.y() - along.y() * offset.x()) / det;
    const double place =
        (direction.x() * offset.y() - direction.y() * offset.x()) / det;
    if (range > 0. && place >= 0. && place <= 1.) {
      nearest = std::min(nearest, range);
    }
  }
  return nearest;
}

// What a scanner sees that looks all around from `pose`.
inline sensor::TimedPointCloudData Scan(const transform::Rigid3d& pose,
                                        const common::Time time,
                                        const int num_beams = 360) {
  const double yaw = transform::GetYaw(pose);
  sensor::TimedPointCloudData scan{time, Eigen::Vector3f::Zero(), {}, {}};
  for (int i = 0; i < num_beams; ++i) {
    const double angle = -M_PI + 2. * M_PI * i / num_beams;
    const double range = CastRay(pose.translation().head<2>(), yaw + angle);
    scan.ranges.push_back(
        {Eigen::Vector3f(range * std::cos(angle), range * std::sin(angle), 0.f),
         0.f});
  }
  return scan;
}

// A closed drive through the room, one round in a time of 1. It starts and ends
// at rest at the origin, heading along x.
inline transform::Rigid3d Drive(const double time) {
  const double angle = 2. * M_PI * time - std::sin(2. * M_PI * time);
  return Planar(1.8 * std::sin(angle), 1.2 * (1. - std::cos(angle)), angle);
}

}  // namespace test
}  // namespace mapping
}  // namespace cartographer

#endif  // TESTS_HOST_SLAM_TEST_HELPERS_H_
