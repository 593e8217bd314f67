// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Random grids of the host and clouds that fit them more or less.
#ifndef TESTS_SCAN_MATCHING_DROPIN_RANDOM_WORLDS_H_
#define TESTS_SCAN_MATCHING_DROPIN_RANDOM_WORLDS_H_

#include <memory>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/internal/2d/tsdf_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/random.h"

namespace cartographer_ext {
namespace scan_matching {
namespace test {

namespace mapping = cartographer::mapping;
using cartographer::sensor::PointCloud;
using cartographer::transform::Rigid2d;
using mapping::CellLimits;
using mapping::Grid2D;
using mapping::MapLimits;
using mapping::ProbabilityGrid;

constexpr double kResolution = 0.05;

inline MapLimits RandomLimits(Random* const random) {
  return MapLimits(
      kResolution,
      Eigen::Vector2d(random->Uniform(-60., 60.), random->Uniform(-60., 60.)),
      CellLimits(static_cast<int>(random->UniformInt(1, 90)),
                 static_cast<int>(random->UniformInt(1, 90))));
}

// Walls, free space, unknown space and noise.
inline std::unique_ptr<Grid2D> RandomGrid(
    mapping::ValueConversionTables* const tables, Random* const random) {
  auto grid = absl::make_unique<ProbabilityGrid>(RandomLimits(random), tables);
  const CellLimits size = grid->limits().cell_limits();
  const double noise = random->Uniform() < 0.3 ? 0.3 : 0.01;
  const double unknown = random->Uniform();
  const int64_t spacing = random->UniformInt(4, 40);
  for (const Eigen::Array2i& cell : mapping::XYIndexRangeIterator(size)) {
    const bool wall = cell.x() % spacing == 2 || cell.y() % spacing == 3;
    if (!wall && random->Uniform() < unknown) continue;
    double probability = wall ? 0.85 : 0.15;
    if (random->Uniform() < noise) probability = random->Uniform(0.1, 0.9);
    grid->SetProbability(cell, static_cast<float>(probability));
  }
  return grid;
}

inline std::unique_ptr<Grid2D> RandomTsdf(
    mapping::ValueConversionTables* const tables, Random* const random) {
  auto grid = absl::make_unique<mapping::TSDF2D>(RandomLimits(random), 0.3f,
                                                 10.f, tables);
  for (const Eigen::Array2i& cell :
       mapping::XYIndexRangeIterator(grid->limits().cell_limits())) {
    if (random->Uniform() < 0.5) continue;
    grid->SetCell(cell, static_cast<float>(random->Uniform(-0.3, 0.3)), 1.f);
  }
  grid->FinishUpdate();
  return grid;
}

// Points at high scores, seen from `pose`, and some anywhere.
inline PointCloud RandomCloud(const Grid2D& grid, const Rigid2d& pose,
                              const int num_points, Random* const random) {
  PointCloud cloud;
  const CellLimits size = grid.limits().cell_limits();
  const Rigid2d inverse = pose.inverse();
  for (int i = 0; i != num_points; ++i) {
    Eigen::Vector2d point;
    for (int k = 0; k != 20; ++k) {
      const Eigen::Array2i cell(
          static_cast<int>(random->UniformInt(0, size.num_x_cells - 1)),
          static_cast<int>(random->UniformInt(0, size.num_y_cells - 1)));
      point = grid.limits().GetCellCenter(cell).cast<double>();
      if (grid.GetCorrespondenceCost(cell) < 0.3f) break;
    }
    if (random->Uniform() < 0.15) {
      point +=
          Eigen::Vector2d(random->Uniform(-9., 9.), random->Uniform(-9., 9.));
    }
    const Eigen::Vector2d seen = inverse * point;
    cloud.push_back({Eigen::Vector3f(static_cast<float>(seen.x()),
                                     static_cast<float>(seen.y()), 1.f)});
  }
  return cloud;
}

}  // namespace test
}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // TESTS_SCAN_MATCHING_DROPIN_RANDOM_WORLDS_H_
