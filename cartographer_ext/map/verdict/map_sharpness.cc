// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/map_sharpness.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

struct Point {
  Eigen::Vector2d place;
  int trajectory_id;
  int node_index;
};

// Points sorted by the square cells of a grid whose side is the radius.
class PointGrid {
 public:
  PointGrid(std::vector<Point> points, const double side)
      : side_(side), points_(std::move(points)) {
    std::sort(points_.begin(), points_.end(),
              [this](const Point& a, const Point& b) {
                return Key(a.place) < Key(b.place);
              });
  }

  const std::vector<Point>& points() const { return points_; }

  template <typename Visit>
  void ForEachWithin(const Eigen::Vector2d& place, const double radius,
                     const Visit& visit) const {
    const Cell center = Key(place);
    for (int64_t dx = -1; dx <= 1; ++dx) {
      // The cells of a column are neighbours in the order of points.
      const Cell from(center.first + dx, center.second - 1);
      const Cell to(center.first + dx, center.second + 2);
      auto it = LowerBound(from);
      const auto end = LowerBound(to);
      for (; it != end; ++it) {
        if ((it->place - place).squaredNorm() <= radius * radius) visit(*it);
      }
    }
  }

 private:
  using Cell = std::pair<int64_t, int64_t>;

  Cell Key(const Eigen::Vector2d& place) const {
    return {static_cast<int64_t>(std::floor(place.x() / side_)),
            static_cast<int64_t>(std::floor(place.y() / side_))};
  }
  std::vector<Point>::const_iterator LowerBound(const Cell& cell) const {
    return std::lower_bound(points_.begin(), points_.end(), cell,
                            [this](const Point& point, const Cell& value) {
                              return Key(point.place) < value;
                            });
  }

  const double side_;
  std::vector<Point> points_;
};

// Covariance of points as they come.
class Spread {
 public:
  void Add(const Eigen::Vector2d& point) {
    ++count_;
    const Eigen::Vector2d delta = point - mean_;
    mean_ += delta / count_;
    sum_ += delta * (point - mean_).transpose();
  }
  int count() const { return count_; }
  Eigen::Matrix2d covariance() const { return sum_ / count_; }

  // Larger and smaller eigenvalue.
  std::pair<double, double> Eigenvalues() const {
    const Eigen::Matrix2d c = covariance();
    const double half_trace = 0.5 * c.trace();
    const double root =
        std::hypot(0.5 * (c(0, 0) - c(1, 1)), 0.5 * (c(0, 1) + c(1, 0)));
    return {half_trace + root, std::max(0., half_trace - root)};
  }

 private:
  int count_ = 0;
  Eigen::Vector2d mean_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d sum_ = Eigen::Matrix2d::Zero();
};

std::vector<Point> LayOver(const MapGraph& graph, const MapContents& contents,
                           const int64_t max_points) {
  int64_t total = 0;
  for (const auto& scan : contents.scans) {
    total += static_cast<int64_t>(scan.second.size());
  }
  const int64_t step = 1 + (total - 1) / std::max<int64_t>(1, max_points);
  std::vector<Point> points;
  int64_t counter = 0;
  for (const auto& scan : contents.scans) {
    const auto node = graph.nodes.find(scan.first);
    if (node == graph.nodes.end()) continue;
    for (const Eigen::Vector2d& point : scan.second) {
      if (counter++ % step != 0) continue;
      points.push_back({node->second.global_pose * point,
                        scan.first.trajectory_id, scan.first.index});
    }
  }
  return points;
}

// A wall of one cell's rounding has some thickness, too.
constexpr double kThinnest = 1e-3;  // metres

}  // namespace

Sharpness ComputeSharpness(const MapGraph& graph, const MapContents& contents,
                           const SharpnessOptions& options) {
  Sharpness result;
  const PointGrid grid(LayOver(graph, contents, options.max_points),
                       options.radius);
  const auto size = static_cast<int64_t>(grid.points().size());
  const int64_t step =
      1 + (size - 1) / std::max<int64_t>(1, options.max_samples);
  const double log_2_pi_e = std::log(2. * kPi * std::exp(1.));
  std::vector<double> thickness, single, revisited;
  double entropy = 0., ratio = 0.;
  for (int64_t i = 0; i < size; i += step) {
    const Point& sample = grid.points()[i];
    Spread all, visit;
    bool again = false;
    grid.ForEachWithin(sample.place, options.radius, [&](const Point& point) {
      all.Add(point.place);
      if (point.trajectory_id == sample.trajectory_id &&
          std::abs(point.node_index - sample.node_index) <=
              options.visit_nodes) {
        visit.Add(point.place);
      } else {
        again = true;
      }
    });
    if (all.count() < options.min_neighbours) continue;
    const auto eigenvalues = all.Eigenvalues();
    const double floor = kThinnest * kThinnest;
    ++result.samples;
    entropy +=
        log_2_pi_e + 0.5 * (std::log(std::max(eigenvalues.first, floor)) +
                            std::log(std::max(eigenvalues.second, floor)));
    if (eigenvalues.first >= options.min_elongation * eigenvalues.second) {
      thickness.push_back(2. * std::sqrt(eigenvalues.second));
    }
    if (!again || visit.count() < options.min_neighbours) continue;
    const auto own = visit.Eigenvalues();
    if (own.first < options.min_elongation * own.second) continue;
    single.push_back(2. * std::sqrt(own.second));
    revisited.push_back(2. * std::sqrt(eigenvalues.second));
    ratio += std::sqrt(std::max(eigenvalues.second, floor) /
                       std::max(own.second, floor));
  }
  if (result.samples > 0) {
    result.mean_entropy = entropy / static_cast<double>(result.samples);
  }
  if (!single.empty()) {
    result.doubling = ratio / static_cast<double>(single.size());
  }
  result.wall_thickness = ComputeStatistics(std::move(thickness));
  result.single_visit_thickness = ComputeStatistics(std::move(single));
  result.revisited_thickness = ComputeStatistics(std::move(revisited));
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
