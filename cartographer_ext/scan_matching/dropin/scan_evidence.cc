// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"

#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "Eigen/Core"

namespace cartographer_ext {
namespace scan_matching {
namespace {

// Side of a patch, metres: walls are straight over more, furniture is as large.
constexpr double kPatch = 0.25;
constexpr double kUnseen = 0.5;

using cartographer::mapping::Grid2D;

class Likelihood {
 public:
  Likelihood(const Grid2D& grid, const Pose2& pose)
      : grid_(grid),
        c_(std::cos(pose.theta)),
        s_(std::sin(pose.theta)),
        x_(pose.x),
        y_(pose.y) {}

  double Log(const Eigen::Vector2d& point) const {
    const Eigen::Array2i cell = grid_.limits().GetCellIndex(Eigen::Vector2f(
        static_cast<float>(x_ + c_ * point.x() - s_ * point.y()),
        static_cast<float>(y_ + s_ * point.x() + c_ * point.y())));
    if (!grid_.limits().Contains(cell) || !grid_.IsKnown(cell)) {
      return std::log(kUnseen);
    }
    return std::log1p(-grid_.GetCorrespondenceCost(cell));
  }

 private:
  const Grid2D& grid_;
  const double c_, s_, x_, y_;
};

struct Patch {
  double sum = 0.;
  int num_points = 0;
};

}  // namespace

double ScanEvidence(const Pose2& pose, const Pose2& other,
                    const cartographer::sensor::PointCloud& cloud,
                    const Grid2D& grid) {
  if (grid.GetGridType() == cartographer::mapping::GridType::TSDF) {
    return std::numeric_limits<double>::infinity();
  }
  const Likelihood here(grid, pose), there(grid, other);
  std::map<std::pair<int, int>, Patch> patches;
  for (const auto& point : cloud) {
    const Eigen::Vector2d p = point.position.head<2>().cast<double>();
    if (!p.allFinite()) continue;
    Patch& patch = patches[{static_cast<int>(std::floor(p.x() / kPatch)),
                            static_cast<int>(std::floor(p.y() / kPatch))}];
    patch.sum += here.Log(p) - there.Log(p);
    ++patch.num_points;
  }
  double evidence = 0.;
  for (const auto& patch : patches) {
    evidence += patch.second.sum / patch.second.num_points;
  }
  return evidence;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
