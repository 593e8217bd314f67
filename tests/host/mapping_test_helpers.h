// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Small worlds and dictionaries for the tests of the host's 2D mapping.
#ifndef TESTS_HOST_MAPPING_TEST_HELPERS_H_
#define TESTS_HOST_MAPPING_TEST_HELPERS_H_

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/2d/probability_grid_range_data_inserter_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace test {

class NoFiles : public common::FileResolver {
 public:
  std::string GetFullPathOrDie(const std::string& basename) override {
    LOG(FATAL) << "the test asks for " << basename;
    return "";
  }
  std::string GetFileContentOrDie(const std::string& basename) override {
    return GetFullPathOrDie(basename);
  }
};

// `code` is "return { ... }". Every key must be read exactly once.
inline std::unique_ptr<common::LuaParameterDictionary> Lua(
    const std::string& code) {
  return absl::make_unique<common::LuaParameterDictionary>(
      code, absl::make_unique<NoFiles>());
}

inline sensor::PointCloud Cloud(
    const std::vector<std::pair<float, float>>& points) {
  sensor::PointCloud cloud;
  for (const auto& point : points) {
    cloud.push_back({Eigen::Vector3f(point.first, point.second, 0.f)});
  }
  return cloud;
}

// Points every 4 cm on the walls of a room without symmetries, metres, seen
// from its origin. The walls run through centres of cells of 5 cm.
inline sensor::PointCloud Room() {
  const std::vector<std::pair<float, float>> corners = {
      {-2.125f, -1.425f}, {1.675f, -1.425f}, {1.675f, 0.325f},
      {3.225f, 0.325f},   {3.225f, 2.175f},  {-2.125f, 2.175f}};
  sensor::PointCloud cloud;
  for (size_t i = 0; i != corners.size(); ++i) {
    const Eigen::Vector2f from(corners[i].first, corners[i].second);
    const auto& next = corners[(i + 1) % corners.size()];
    const Eigen::Vector2f to(next.first, next.second);
    const int steps = static_cast<int>((to - from).norm() / 0.04f);
    for (int k = 0; k != steps; ++k) {
      const Eigen::Vector2f point = from + (to - from) * k / steps;
      cloud.push_back({Eigen::Vector3f(point.x(), point.y(), 0.f)});
    }
  }
  return cloud;
}

inline sensor::PointCloud Moved(const sensor::PointCloud& cloud,
                                const transform::Rigid2d& pose) {
  return sensor::TransformPointCloud(cloud,
                                     transform::Embed3D(pose).cast<float>());
}

inline proto::ProbabilityGridRangeDataInserterOptions2D InserterOptions(
    const double hit, const double miss) {
  proto::ProbabilityGridRangeDataInserterOptions2D options;
  options.set_hit_probability(hit);
  options.set_miss_probability(miss);
  options.set_insert_free_space(true);
  return options;
}

// The room seen `times` times from the origin.
inline std::unique_ptr<ProbabilityGrid> RoomGrid(
    ValueConversionTables* const tables, const double resolution,
    const int times) {
  auto grid = absl::make_unique<ProbabilityGrid>(
      MapLimits(resolution, Eigen::Vector2d(1., 1.), CellLimits(20, 20)),
      tables);
  const ProbabilityGridRangeDataInserter2D inserter(InserterOptions(.6, .45));
  const sensor::RangeData range_data{Eigen::Vector3f::Zero(), Room(), {}};
  for (int i = 0; i != times; ++i) inserter.Insert(range_data, grid.get());
  return grid;
}

}  // namespace test
}  // namespace mapping
}  // namespace cartographer

#endif  // TESTS_HOST_MAPPING_TEST_HELPERS_H_
