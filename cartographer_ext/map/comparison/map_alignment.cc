// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/comparison/map_alignment.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "cartographer_ext/map/comparison/point_index.h"
#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr io::TimeNs kSameStamp = 100000;
constexpr io::TimeNs kMaxGap = 2000000000;
constexpr int kMaxHypotheses = 200;
constexpr int kFits = 80;
constexpr double kConverged = 1e-5;  // metres and radians
// The coarse search: cells along the longer side, walls looked at.
constexpr double kCoarseCells = 250.;
constexpr size_t kCoarsePoints = 1200;
constexpr double kMinAgreement = 0.2;

std::vector<Eigen::Vector2d> EveryNth(const std::vector<Eigen::Vector2d>& all,
                                      const size_t most) {
  const size_t step = std::max<size_t>(1, (all.size() + most - 1) / most);
  std::vector<Eigen::Vector2d> result;
  for (size_t i = 0; i < all.size(); i += step) result.push_back(all[i]);
  return result;
}

double Agreement(const PointIndex& index,
                 const std::vector<Eigen::Vector2d>& points,
                 const Pose2& pose) {
  int64_t hits = 0;
  for (const Eigen::Vector2d& point : points) {
    hits += index.Nearest(pose * point) >= 0;
  }
  return points.empty()
             ? 0.
             : static_cast<double>(hits) / static_cast<double>(points.size());
}

// Walls as a grid of scores: full in the cell of a wall, half beside it.
scan_matching::SearchGrid2D MakeSearchGrid(
    const std::vector<Eigen::Vector2d>& walls, const double resolution) {
  Eigen::Vector2d low = walls.front(), high = walls.front();
  for (const Eigen::Vector2d& wall : walls) {
    low = low.cwiseMin(wall);
    high = high.cwiseMax(wall);
  }
  scan_matching::SearchGrid2D grid;
  grid.resolution = resolution;
  grid.max_x = high.x() + 2. * resolution;
  grid.max_y = high.y() + 2. * resolution;
  grid.num_y = static_cast<int>((grid.max_x - low.x()) / resolution) + 3;
  grid.num_x = static_cast<int>((grid.max_y - low.y()) / resolution) + 3;
  grid.values.assign(static_cast<size_t>(grid.num_x) * grid.num_y, 0);
  for (const Eigen::Vector2d& wall : walls) {
    const int iy = static_cast<int>((grid.max_x - wall.x()) / resolution);
    const int ix = static_cast<int>((grid.max_y - wall.y()) / resolution);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        uint8_t& value = grid.values[grid.num_x * (iy + dy) + ix + dx];
        value = std::max<uint8_t>(value, dx == 0 && dy == 0 ? 255 : 128);
      }
    }
  }
  return grid;
}

double LongerSide(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d low = points.front(), high = points.front();
  for (const Eigen::Vector2d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return (high - low).maxCoeff();
}

}  // namespace

std::vector<CommonNode> FindCommonNodes(const MapGraph& first,
                                        const MapGraph& second) {
  std::map<int, std::map<io::TimeNs, Pose2>> paths;
  for (const auto& node : second.nodes) {
    paths[node.first.trajectory_id][node.second.time] = node.second.global_pose;
  }
  std::vector<CommonNode> result;
  for (const auto& node : first.nodes) {
    const std::map<io::TimeNs, Pose2>& path = paths[node.first.trajectory_id];
    const io::TimeNs time = node.second.time;
    const auto after = path.lower_bound(time - kSameStamp);
    if (after == path.end()) continue;
    CommonNode common{node.first, time, {node.second.global_pose, {}}};
    if (after->first <= time + kSameStamp) {
      common.poses.second = after->second;
    } else {
      if (after == path.begin()) continue;
      const auto before = std::prev(after);
      if (after->first - before->first > kMaxGap) continue;
      common.poses.second =
          Interpolate(before->second, after->second,
                      static_cast<double>(time - before->first) /
                          static_cast<double>(after->first - before->first));
    }
    result.push_back(common);
  }
  return result;
}

Pose2 FitPoints(const std::vector<Eigen::Vector2d>& first,
                const std::vector<Eigen::Vector2d>& second) {
  Eigen::Vector2d mean_first = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_second = Eigen::Vector2d::Zero();
  for (size_t i = 0; i < first.size(); ++i) {
    mean_first += first[i];
    mean_second += second[i];
  }
  mean_first /= static_cast<double>(first.size());
  mean_second /= static_cast<double>(first.size());
  double sine = 0., cosine = 0.;
  for (size_t i = 0; i < first.size(); ++i) {
    const Eigen::Vector2d a = first[i] - mean_first;
    const Eigen::Vector2d b = second[i] - mean_second;
    cosine += a.dot(b);
    sine += b.x() * a.y() - b.y() * a.x();
  }
  const Pose2 rotation(0., 0., std::atan2(sine, cosine));
  const Eigen::Vector2d shift = mean_first - rotation * mean_second;
  return Pose2(shift.x(), shift.y(), rotation.theta);
}

absl::optional<MapAlignment> AlignPoses(const std::vector<NodePosePair>& pairs,
                                        const double tolerance) {
  if (pairs.empty()) return absl::nullopt;
  const auto inliers = [&](const Pose2& pose) {
    std::vector<size_t> result;
    for (size_t i = 0; i < pairs.size(); ++i) {
      const Eigen::Vector2d moved = pose * pairs[i].second.translation();
      if ((moved - pairs[i].first.translation()).norm() <= tolerance) {
        result.push_back(i);
      }
    }
    return result;
  };
  const size_t step =
      std::max<size_t>(1, pairs.size() / static_cast<size_t>(kMaxHypotheses));
  Pose2 best;
  std::vector<size_t> best_inliers;
  for (size_t i = 0; i < pairs.size(); i += step) {
    const Pose2 pose = pairs[i].first * pairs[i].second.Inverse();
    std::vector<size_t> found = inliers(pose);
    if (found.size() > best_inliers.size()) {
      best = pose;
      best_inliers.swap(found);
    }
  }
  for (int i = 0; i < kFits && best_inliers.size() > 1; ++i) {
    std::vector<Eigen::Vector2d> first, second;
    for (const size_t index : best_inliers) {
      first.push_back(pairs[index].first.translation());
      second.push_back(pairs[index].second.translation());
    }
    if (LongerSide(first) < tolerance) break;  // no rotation in a point
    const Pose2 fitted = FitPoints(first, second);
    std::vector<size_t> found = inliers(fitted);
    if (found.size() < best_inliers.size()) break;
    best = fitted;
    if (found == best_inliers) break;
    best_inliers.swap(found);
  }
  MapAlignment result;
  result.first_from_second = best;
  result.agreement = static_cast<double>(best_inliers.size()) /
                     static_cast<double>(pairs.size());
  return result;
}

MapAlignment RefineWalls(const std::vector<Eigen::Vector2d>& first,
                         const std::vector<Eigen::Vector2d>& second,
                         const Pose2& first_from_second, double radius,
                         const double tolerance) {
  MapAlignment result;
  result.first_from_second = first_from_second;
  for (int i = 0; i < kFits; ++i) {
    const PointIndex index(first, radius);
    std::vector<Eigen::Vector2d> a, b;
    for (const Eigen::Vector2d& point : second) {
      const int nearest = index.Nearest(result.first_from_second * point);
      if (nearest < 0) continue;
      a.push_back(first[nearest]);
      b.push_back(point);
    }
    if (a.size() < 3) break;
    const Pose2 fitted = FitPoints(a, b);
    const Pose2 step = Between(result.first_from_second, fitted);
    result.first_from_second = fitted;
    if (radius == tolerance &&
        step.translation().norm() + std::abs(step.theta) < kConverged) {
      break;
    }
    radius = std::max(tolerance, 0.8 * radius);
  }
  const std::vector<Eigen::Vector2d>& smaller =
      first.size() < second.size() ? first : second;
  const bool first_is_smaller = &smaller == &first;
  result.agreement = Agreement(
      PointIndex(first_is_smaller ? second : first, tolerance), smaller,
      first_is_smaller ? result.first_from_second.Inverse()
                       : result.first_from_second);
  return result;
}

absl::optional<MapAlignment> AlignWalls(
    const std::vector<Eigen::Vector2d>& first,
    const std::vector<Eigen::Vector2d>& second, const double tolerance) {
  if (first.size() < 3 || second.size() < 3) return absl::nullopt;
  // The map with fewer walls is aligned to the other one.
  const bool swapped = first.size() < second.size();
  const std::vector<Eigen::Vector2d>& base = swapped ? second : first;
  const std::vector<Eigen::Vector2d>& laid = swapped ? first : second;
  const double resolution =
      std::max(tolerance, LongerSide(base) / kCoarseCells);
  // Rotations are taken about the origin of the cloud: its middle.
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : laid) middle += point;
  middle /= static_cast<double>(laid.size());
  scan_matching::PlanarCloud cloud;
  for (const Eigen::Vector2d& point : EveryNth(laid, kCoarsePoints)) {
    cloud.x.push_back(static_cast<float>(point.x() - middle.x()));
    cloud.y.push_back(static_cast<float>(point.y() - middle.y()));
  }
  const scan_matching::FastCorrelativeSearch2D search(
      MakeSearchGrid(base, resolution), {});
  scan_matching::SearchBudget budget;
  budget.max_candidates = 200000000;
  const scan_matching::SearchResult found =
      search.MatchFullSubmap(cloud, static_cast<float>(kMinAgreement), budget);
  if (!found.found) return absl::nullopt;
  const Pose2 base_from_laid = found.pose * Pose2(-middle.x(), -middle.y(), 0.);
  MapAlignment result = RefineWalls(
      first, second, swapped ? base_from_laid.Inverse() : base_from_laid,
      2. * resolution, tolerance);
  if (result.agreement < kMinAgreement) return absl::nullopt;
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
