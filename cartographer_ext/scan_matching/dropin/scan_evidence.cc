// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace cartographer_ext {
namespace scan_matching {
namespace {

// Side of a patch, metres: walls are straight over more, furniture is as large.
constexpr double kPatch = 0.25;
constexpr double kUnseen = 0.5;

using cartographer::mapping::Grid2D;

std::pair<int, int> PatchOf(const Eigen::Vector2f& point) {
  const Eigen::Vector2d p = point.cast<double>();
  return {static_cast<int>(std::floor(p.x() / kPatch)),
          static_cast<int>(std::floor(p.y() / kPatch))};
}

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

}  // namespace

int NumPatches(const cartographer::sensor::PointCloud& cloud) {
  std::set<std::pair<int, int>> patches;
  for (const auto& point : cloud) {
    const Eigen::Vector2f p = point.position.head<2>();
    if (p.allFinite()) patches.insert(PatchOf(p));
  }
  return static_cast<int>(patches.size());
}

PoseEvidence::PoseEvidence(const Pose2& pose,
                           const cartographer::sensor::PointCloud& cloud,
                           const Grid2D& grid)
    : grid_(grid) {
  if (grid.GetGridType() == cartographer::mapping::GridType::TSDF) return;
  const Likelihood likelihood(grid, pose);
  std::map<std::pair<int, int>, std::vector<Point>> patches;
  for (const auto& point : cloud) {
    const Eigen::Vector2d p = point.position.head<2>().cast<double>();
    if (!p.allFinite()) continue;
    patches[PatchOf(point.position.head<2>())].push_back(
        {p, likelihood.Log(p)});
  }
  patches_.reserve(patches.size());
  for (auto& patch : patches) patches_.push_back(std::move(patch.second));
}

double PoseEvidence::Against(const Pose2& other) const {
  if (grid_.GetGridType() == cartographer::mapping::GridType::TSDF) {
    return std::numeric_limits<double>::infinity();
  }
  const Likelihood likelihood(grid_, other);
  double evidence = 0.;
  for (const std::vector<Point>& patch : patches_) {
    double sum = 0.;
    for (const Point& point : patch) {
      sum += point.log_probability - likelihood.Log(point.position);
    }
    evidence += sum / static_cast<double>(patch.size());
  }
  return evidence;
}

double ScanEvidence(const Pose2& pose, const Pose2& other,
                    const cartographer::sensor::PointCloud& cloud,
                    const Grid2D& grid) {
  return PoseEvidence(pose, cloud, grid).Against(other);
}

}  // namespace scan_matching
}  // namespace cartographer_ext
