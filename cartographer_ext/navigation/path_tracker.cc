// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/path_tracker.h"

#include <algorithm>
#include <cmath>

#include "glog/logging.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kSpacing = 0.1;    // metres
constexpr double kReachBack = 0.5;  // metres
constexpr double kReachAhead = 2.;

}  // namespace

PathTracker::PathTracker(const std::vector<Eigen::Vector2d>& corners) {
  CHECK(!corners.empty());
  points_.push_back(corners.front());
  lengths_.push_back(0.);
  for (size_t i = 1; i != corners.size(); ++i) {
    const Eigen::Vector2d from = corners[i - 1], piece = corners[i] - from;
    const int count =
        std::max(1, static_cast<int>(std::ceil(piece.norm() / kSpacing)));
    const double begin = lengths_.back();
    for (int j = 1; j <= count; ++j) {
      const double ratio = static_cast<double>(j) / count;
      points_.push_back(from + ratio * piece);
      lengths_.push_back(begin + ratio * piece.norm());
    }
  }
}

void PathTracker::Advance(const Eigen::Vector2d& position) {
  if (points_.empty()) return;
  const double here = lengths_[nearest_];
  size_t best = nearest_;
  double least = (points_[best] - position).squaredNorm();
  for (size_t i = 0; i != points_.size(); ++i) {
    if (lengths_[i] < here - kReachBack) continue;
    if (lengths_[i] > here + kReachAhead) break;
    const double squared = (points_[i] - position).squaredNorm();
    if (squared < least) {
      least = squared;
      best = i;
    }
  }
  nearest_ = best;
}

double PathTracker::Remaining() const {
  return points_.empty() ? 0. : lengths_.back() - lengths_[nearest_];
}

Eigen::Vector2d PathTracker::Ahead(const double distance) const {
  CHECK(!points_.empty());
  size_t i = nearest_;
  while (i + 1 < points_.size() &&
         lengths_[i] < lengths_[nearest_] + distance) {
    ++i;
  }
  return points_[i];
}

std::vector<Eigen::Vector2d> PathTracker::PointsAhead(
    const double distance) const {
  std::vector<Eigen::Vector2d> ahead;
  for (size_t i = nearest_;
       i < points_.size() && lengths_[i] <= lengths_[nearest_] + distance;
       ++i) {
    ahead.push_back(points_[i]);
  }
  return ahead;
}

}  // namespace navigation
}  // namespace cartographer_ext
