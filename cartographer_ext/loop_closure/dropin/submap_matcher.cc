// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/submap_matcher.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cartographer/mapping/2d/map_limits.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/loop_closure/verification/beam_agreement.h"
#include "cartographer_ext/scan_matching/correlative_search/coarse_grid.h"
#include "cartographer_ext/scan_matching/dropin/grid_rows.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::Grid2D;
using cartographer::mapping::GridType;

// Searches of a whole submap end here at the latest, with the best so far. What
// scores well is found first; to prove that nothing else does takes many times
// as long.
constexpr int64_t kMaxCandidates = 1000000;

// Searches of many submaps use about this many of the points at first; their
// score may be this much below that of all points.
constexpr size_t kPointsToFind = 80;
constexpr double kSubsampledScoreMargin = 0.05;
// Then all points are matched within this window around the places found.
constexpr double kClosestWindowMetres = 0.2;
constexpr double kClosestWindowRadians = 0.02;

// Cells of a rough search, in cells of the grid.
constexpr int kPlaceCells = 4;
// Of a rough search. What the map does not show costs all of it.
constexpr int64_t kMaxPlaces = 250000;
// Of the window around the best place, in rough cells and rotations.
constexpr double kPlaceWindow = 2.;

// Of the farthest point, metres.
double FarthestRange(const scan_matching::PlanarCloud& cloud) {
  double farthest = 0.;
  for (size_t i = 0; i < cloud.size(); ++i) {
    const double range = std::hypot(static_cast<double>(cloud.x[i]),
                                    static_cast<double>(cloud.y[i]));
    if (std::isfinite(range)) farthest = std::max(farthest, range);
  }
  return farthest;
}

SubmapMatch ToMatch(const scan_matching::SearchResult& result) {
  SubmapMatch match;
  match.found = result.found;
  match.score = result.found ? static_cast<double>(result.score) : 0.;
  match.pose = result.pose;
  match.pose.theta = NormalizeAngle(match.pose.theta);
  return match;
}

scan_matching::SearchBudget Budget() {
  scan_matching::SearchBudget budget;
  budget.max_candidates = kMaxCandidates;
  return budget;
}

}  // namespace

SubmapMatcher::SubmapMatcher(const Grid2D& grid,
                             const cartographer::mapping::scan_matching::proto::
                                 FastCorrelativeScanMatcherOptions2D& options)
    : matcher_(grid, options) {}

SubmapMatch SubmapMatcher::Match(const Pose2& initial,
                                 const double linear_window,
                                 const double angular_window,
                                 const cartographer::sensor::PointCloud& cloud,
                                 const double min_score) const {
  scan_matching::SearchWindow window;
  window.linear = linear_window;
  window.angular = angular_window;
  return ToMatch(matcher_.Match(ToRigid2d(initial), cloud, window,
                                static_cast<float>(min_score), Budget()));
}

SubmapMatch SubmapMatcher::MatchFullSubmap(
    const cartographer::sensor::PointCloud& cloud,
    const double min_score) const {
  return ToMatch(
      matcher_.MatchFullSubmap(cloud, static_cast<float>(min_score), Budget()));
}

PlaceMatcher::PlaceMatcher(const Grid2D& grid,
                           const cartographer::mapping::scan_matching::proto::
                               FastCorrelativeScanMatcherOptions2D& options)
    : resolution_(kPlaceCells * grid.limits().resolution()),
      search_(scan_matching::CoarseGrid(scan_matching::ToSearchGrid(grid),
                                        kPlaceCells),
              scan_matching::ToSearchOptions(options)) {}

absl::optional<Pose2> PlaceMatcher::Find(
    const cartographer::sensor::PointCloud& cloud,
    const double min_score) const {
  scan_matching::SearchBudget budget;
  budget.max_candidates = kMaxPlaces;
  const scan_matching::SearchResult place =
      search_.MatchFullSubmap(scan_matching::ToPlanarCloud(cloud),
                              static_cast<float>(min_score), budget);
  if (!place.found) return absl::nullopt;
  return place.pose;
}

scan_matching::SearchWindow PlaceMatcher::WindowOf(
    const cartographer::sensor::PointCloud& cloud) const {
  scan_matching::SearchWindow window;
  window.linear = kPlaceWindow * resolution_;
  const double range =
      std::max(resolution_, FarthestRange(scan_matching::ToPlanarCloud(cloud)));
  window.angular = std::min(kPi, window.linear / range);
  return window;
}

std::vector<SubmapRanking> MatchBestSubmaps(
    const std::vector<const SubmapMatcher*>& submaps,
    const cartographer::sensor::PointCloud& cloud, const double min_score,
    const int num_best) {
  // Some of the points find the places, all of them rank them.
  const scan_matching::PlanarCloud all = scan_matching::ToPlanarCloud(cloud);
  scan_matching::PlanarCloud some;
  const size_t stride = std::max<size_t>(1, all.x.size() / kPointsToFind);
  for (size_t i = 0; i < all.x.size(); i += stride) {
    some.x.push_back(all.x[i]);
    some.y.push_back(all.y[i]);
  }
  std::vector<scan_matching::SearchTask> tasks(submaps.size());
  for (size_t i = 0; i < submaps.size(); ++i) {
    tasks[i].grid = &submaps[i]->search();
    tasks[i].cloud = &some;
    tasks[i].full_submap = true;
    tasks[i].min_score = static_cast<float>(min_score - kSubsampledScoreMargin);
  }
  scan_matching::SearchWindow window;
  window.linear = kClosestWindowMetres;
  window.angular = kClosestWindowRadians;
  std::vector<SubmapRanking> ranking;
  for (const scan_matching::SearchTaskResult& result :
       scan_matching::MatchBestFew(tasks, num_best, Budget(), nullptr)) {
    if (!result.result.found) continue;
    const SubmapMatch match = ToMatch(submaps[result.task]->search().Match(
        result.result.pose, all, window, static_cast<float>(min_score),
        Budget()));
    if (match.found) ranking.push_back(SubmapRanking{result.task, match});
  }
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const SubmapRanking& a, const SubmapRanking& b) {
                     return a.match.score > b.match.score;
                   });
  return ranking;
}

OccupancyView MakeOccupancyView(const Grid2D& grid) {
  const auto& limits = grid.limits();
  const int num_x = limits.cell_limits().num_y_cells;
  const int num_y = limits.cell_limits().num_x_cells;
  const double resolution = limits.resolution();
  OccupancyView view(Eigen::Vector2d(limits.max().x() - resolution * num_x,
                                     limits.max().y() - resolution * num_y),
                     resolution, num_x, num_y);
  const bool is_tsdf = grid.GetGridType() == GridType::TSDF;
  std::vector<float> costs(num_y);
  for (int i = 0; i < num_x; ++i) {
    const int row = num_x - 1 - i;
    scan_matching::CopyCosts(grid, 0, row, num_y, costs.data());
    for (int j = 0; j < num_y; ++j) {
      const int column = num_y - 1 - j;
      const double cost = costs[column];
      // Unknown cells have the maximum cost, as known ones may.
      if (costs[column] == grid.GetMaxCorrespondenceCost() &&
          !grid.IsKnown(Eigen::Array2i(column, row))) {
        continue;
      }
      const bool occupied = is_tsdf ? std::abs(cost) < resolution : cost < 0.5;
      view.Set(i, j, occupied ? CellState::kOccupied : CellState::kFree);
    }
  }
  return view;
}

OccupancyView MakeReferenceView(const TemporalVerificationOptions& options,
                                const Grid2D& grid) {
  OccupancyView view = MakeOccupancyView(grid);
  if (options.comparison == ScanComparison::kBeams) {
    view.FindDistances(DistanceReach(options.beams, view.resolution()));
  }
  return view;
}

Pose2 RefineMatch(
    const cartographer::mapping::scan_matching::CeresScanMatcher2D& matcher,
    const Grid2D& grid, const cartographer::sensor::PointCloud& cloud,
    const Pose2& pose) {
  cartographer::transform::Rigid2d refined = ToRigid2d(pose);
  ceres::Solver::Summary unused_summary;
  matcher.Match(refined.translation(), refined, cloud, grid, &refined,
                &unused_summary);
  return ToPose2(refined);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
