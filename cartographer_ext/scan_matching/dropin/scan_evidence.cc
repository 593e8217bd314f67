// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"

#include <algorithm>
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
// A person with what they carry or push, metres.
constexpr double kObjectRadius = 0.5;

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

// What the beams to both sides of one leave between them belongs to the same
// surface, half of it to each, up to this distance: metres.
constexpr double kLargestGap = 2.;

// The nearest of `points` to the one with this index, on the other side than
// `beside`, a difference to the point, if that is not zero; as a difference.
Eigen::Vector2d NearestBeside(const std::vector<Eigen::Vector2d>& points,
                              const size_t index,
                              const Eigen::Vector2d& beside) {
  Eigen::Vector2d nearest = Eigen::Vector2d::Zero();
  double least = kLargestGap * kLargestGap;
  for (size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector2d off = points[k] - points[index];
    const double distance = off.squaredNorm();
    if (distance == 0. || distance >= least || off.dot(beside) > 0.) continue;
    least = distance;
    nearest = off;
  }
  return nearest;
}

// Points a cell apart from one of `points` to the middle between it and those on
// its sides.
std::vector<Eigen::Vector2d> SurfaceAround(
    const std::vector<Eigen::Vector2d>& points, const size_t index,
    const double cell) {
  std::vector<Eigen::Vector2d> surface = {points[index]};
  Eigen::Vector2d beside = Eigen::Vector2d::Zero();
  for (int side = 0; side < 2; ++side) {
    beside = NearestBeside(points, index, beside);
    const double length = beside.norm();
    for (double along = cell; along <= 0.5 * length; along += cell) {
      surface.push_back(points[index] + along / length * beside);
    }
  }
  return surface;
}

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
                           const Grid2D& grid, const PosePrecision precision)
    : grid_(grid), tolerance_(precision == PosePrecision::kCell ? 1 : 0) {
  if (grid.GetGridType() == cartographer::mapping::GridType::TSDF) return;
  std::vector<Eigen::Vector2d> points;
  std::map<std::pair<int, int>, int> patches;
  for (const auto& point : cloud) {
    const Eigen::Vector2f p = point.position.head<2>();
    if (!p.allFinite()) continue;
    points.push_back(p.cast<double>());
    ++patches[PatchOf(p)];
  }
  for (size_t i = 0; i < points.size(); ++i) {
    Point point;
    point.weight = 1. / patches.at(PatchOf(points[i].cast<float>()));
    if (precision == PosePrecision::kCell) {
      point.surface = SurfaceAround(points, i, grid.limits().resolution());
    } else {
      point.surface = {points[i]};
    }
    points_.push_back(std::move(point));
  }
  SetPose(pose);
}

template <typename Function>
void PoseEvidence::ForEachPart(const Pose2& pose,
                               const Function& function) const {
  const Likelihood likelihood(grid_, pose);
  for (const Point& point : points_) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& place : point.surface) {
      most = std::max(most, likelihood.Log(place));
    }
    function(point.weight * most);
  }
}

PoseEvidence::Best PoseEvidence::BestNear(const Pose2& pose,
                                          const int tolerance) const {
  const double cell = grid_.limits().resolution();
  Best best;
  best.log_likelihood = -std::numeric_limits<double>::infinity();
  for (int ix = -tolerance; ix <= tolerance; ++ix) {
    for (int iy = -tolerance; iy <= tolerance; ++iy) {
      const Pose2 near(pose.x + ix * cell, pose.y + iy * cell, pose.theta);
      double sum = 0.;
      ForEachPart(near, [&sum](const double part) { sum += part; });
      if (sum > best.log_likelihood) best = {near, sum};
    }
  }
  return best;
}

void PoseEvidence::SetPose(const Pose2& pose) {
  pose_ = pose;
  log_likelihood_ = BestNear(pose, 0).log_likelihood;
}

double PoseEvidence::Against(const Pose2& other) const {
  if (grid_.GetGridType() == cartographer::mapping::GridType::TSDF) {
    return std::numeric_limits<double>::infinity();
  }
  return log_likelihood_ - BestNear(other, tolerance_).log_likelihood;
}

double PoseEvidence::AgainstWithoutObject(const Pose2& other) const {
  const double evidence = Against(other);
  if (!std::isfinite(evidence)) return evidence;
  std::vector<double> parts;
  parts.reserve(points_.size());
  ForEachPart(pose_, [&parts](const double part) { parts.push_back(part); });
  size_t index = 0;
  ForEachPart(BestNear(other, tolerance_).pose,
              [&](const double part) { parts[index++] -= part; });
  double of_object = 0.;
  for (const Point& center : points_) {
    double sum = 0.;
    for (size_t i = 0; i < parts.size(); ++i) {
      if ((points_[i].surface.front() - center.surface.front()).squaredNorm() <=
          kObjectRadius * kObjectRadius) {
        sum += parts[i];
      }
    }
    of_object = std::max(of_object, sum);
  }
  return evidence - of_object;
}

double ScanEvidence(const Pose2& pose, const Pose2& other,
                    const cartographer::sensor::PointCloud& cloud,
                    const Grid2D& grid) {
  return PoseEvidence(pose, cloud, grid, PosePrecision::kCell).Against(other);
}

}  // namespace scan_matching
}  // namespace cartographer_ext
