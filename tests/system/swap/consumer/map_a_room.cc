// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// map_a_room CONFIGURATION_DIRECTORY: maps a room of 8 by 6 metres from a drive through it, once without and once with our
// include in the Lua code, and prints the nodes and the error of the last pose of each.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "glog/logging.h"

namespace {

using cartographer::mapping::TrajectoryBuilderInterface;

std::unique_ptr<cartographer::common::LuaParameterDictionary> Load(
    const std::string& folder, const std::string& code) {
  return std::make_unique<cartographer::common::LuaParameterDictionary>(
      code, std::make_unique<cartographer::common::ConfigurationFileResolver>(
                std::vector<std::string>{folder}));
}

// Distance from `at` in direction `angle` to the walls of the room.
double Range(const double x, const double y, const double angle) {
  const double dx = std::cos(angle), dy = std::sin(angle);
  double range = 1e9;
  if (dx > 1e-9) range = std::min(range, (8. - x) / dx);
  if (dx < -1e-9) range = std::min(range, -x / dx);
  if (dy > 1e-9) range = std::min(range, (6. - y) / dy);
  if (dy < -1e-9) range = std::min(range, -y / dy);
  return range;
}

int MapRoom(const std::string& folder, const std::string& include) {
  const std::string code =
      "include \"map_builder.lua\"\ninclude \"trajectory_builder.lua\"\n"
      "MAP_BUILDER.use_trajectory_builder_2d = "
      "true\nTRAJECTORY_BUILDER_2D.use_imu_data = false\n" +
      include;
  auto builder = cartographer::mapping::CreateMapBuilder(
      cartographer::mapping::CreateMapBuilderOptions(
          Load(folder, code + "return MAP_BUILDER").get()));
  const TrajectoryBuilderInterface::SensorId scan{
      TrajectoryBuilderInterface::SensorId::SensorType::RANGE, "scan"};
  const TrajectoryBuilderInterface::SensorId odom{
      TrajectoryBuilderInterface::SensorId::SensorType::ODOMETRY, "odom"};
  const int id = builder->AddTrajectoryBuilder(
      {scan, odom},
      cartographer::mapping::CreateTrajectoryBuilderOptions(
          Load(folder, code + "return TRAJECTORY_BUILDER").get()),
      nullptr);
  TrajectoryBuilderInterface* const trajectory =
      builder->GetTrajectoryBuilder(id);
  const cartographer::common::Time start =
      cartographer::common::FromUniversal(621355968000000000 + 10000000);
  double travelled = 0.;
  for (int i = 0; i < 100; ++i) {
    const cartographer::common::Time time =
        start + cartographer::common::FromSeconds(0.1 * i);
    travelled = 0.04 * i;
    trajectory->AddSensorData(
        odom.id, cartographer::sensor::OdometryData{
                     time, cartographer::transform::Rigid3d::Translation(
                               {travelled, 0., 0.})});
    cartographer::sensor::TimedPointCloudData data;
    data.time = time;
    data.origin = Eigen::Vector3f::Zero();
    for (int beam = 0; beam < 360; ++beam) {
      const double angle = 2. * M_PI * beam / 360.,
                   range = Range(2. + travelled, 2.5, angle);
      data.ranges.push_back({Eigen::Vector3f(range * std::cos(angle),
                                             range * std::sin(angle), 0.f),
                             0.f});
    }
    trajectory->AddSensorData(scan.id, data);
  }
  builder->FinishTrajectory(id);
  builder->pose_graph()->RunFinalOptimization();
  const auto nodes = builder->pose_graph()->GetTrajectoryNodePoses();
  if (nodes.empty()) return 1;
  const auto& last = std::prev(nodes.end())->data;
  // Where the drive was when the last node was made.
  const double expected =
      0.4 * cartographer::common::ToSeconds(
                last.constant_pose_data.value().time - start);
  const double error = std::hypot(last.global_pose.translation().x() - expected,
                                  last.global_pose.translation().y());
  std::printf("%s: %d nodes, error %.3f m\n",
              include.empty() ? "stock" : "ours",
              static_cast<int>(nodes.size()), error);
  return error < 0.1 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  if (argc != 2) {
    std::fprintf(
        stderr, "map_a_room: expects the folder of Cartographer's Lua files\n");
    return 2;
  }
  const int stock = MapRoom(argv[1], "");
  const int ours = MapRoom(argv[1], "include \"cartographer_ext_2d.lua\"\n");
  return stock + ours == 0 ? 0 : 1;
}
