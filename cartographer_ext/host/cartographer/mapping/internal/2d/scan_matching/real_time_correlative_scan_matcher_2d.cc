// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/real_time_correlative_scan_matcher_2d.h"

#include <algorithm>
#include <cmath>

#include "cartographer/common/math.h"
#include "cartographer/mapping/internal/2d/scan_matching/rotated_cell_indices.h"
#include "cartographer/mapping/internal/2d/tsdf_2d.h"
#include "cartographer/mapping/probability_values.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

// All sums are in single precision and in the order of the points.
float MeanProbability(const ProbabilityGrid& grid, const DiscreteScan2D& scan,
                      const Eigen::Array2i& offset) {
  float sum = 0.f;
  for (const Eigen::Array2i& cell : scan) {
    sum += grid.GetProbability(cell + offset);
  }
  return sum / static_cast<float>(scan.size());
}

float MeanCloseness(const TSDF2D& tsdf, const DiscreteScan2D& scan,
                    const Eigen::Array2i& offset) {
  const float truncation = tsdf.GetMaxCorrespondenceCost();
  float sum = 0.f;
  float total_weight = 0.f;
  for (const Eigen::Array2i& cell : scan) {
    const auto tsd_and_weight = tsdf.GetTSDAndWeight(cell + offset);
    const float closeness =
        (truncation - std::abs(tsd_and_weight.first)) / truncation;
    sum += closeness * tsd_and_weight.second;
    total_weight += tsd_and_weight.second;
  }
  return total_weight == 0.f ? 0.f : sum / total_weight;
}

// The probabilities of the square of `size` x `size` cells whose first cell is
// (x, y), row by row.
void ReadSquare(const ProbabilityGrid& grid, const int x, const int y,
                const int size, float* probabilities) {
  const CellLimits& limits = grid.limits().cell_limits();
  const bool is_inside = x >= 0 && y >= 0 && x <= limits.num_x_cells - size &&
                         y <= limits.num_y_cells - size;
  for (int j = 0; j != size; ++j, probabilities += size) {
    if (is_inside) {
      grid.CopyCorrespondenceCosts(x, y + j, size, probabilities);
      for (int i = 0; i != size; ++i) {
        probabilities[i] = CorrespondenceCostToProbability(probabilities[i]);
      }
    } else {
      for (int i = 0; i != size; ++i) {
        probabilities[i] = grid.GetProbability({x + i, y + j});
      }
    }
  }
}

void Add(const float* __restrict const values, const int count,
         float* __restrict const sums) {
  for (int i = 0; i < count; i += 4) {
    for (int k = 0; k != 4; ++k) sums[i + k] += values[i + k];
  }
}

}  // namespace

RealTimeCorrelativeScanMatcher2D::RealTimeCorrelativeScanMatcher2D(
    const proto::RealTimeCorrelativeScanMatcherOptions& options)
    : options_(options) {}

double RealTimeCorrelativeScanMatcher2D::Match(
    const transform::Rigid2d& initial_pose_estimate,
    const sensor::PointCloud& point_cloud, const Grid2D& grid,
    transform::Rigid2d* const pose_estimate) const {
  CHECK(pose_estimate != nullptr);
  if (point_cloud.empty()) {
    *pose_estimate = initial_pose_estimate;
    return 0.;
  }
  const sensor::PointCloud rotated_cloud =
      RotateCloud(point_cloud, initial_pose_estimate);
  const SearchParameters search_parameters(
      options_.linear_search_window(), options_.angular_search_window(),
      rotated_cloud, grid.limits().resolution());
  const Candidate2D best =
      grid.GetGridType() == GridType::PROBABILITY_GRID
          ? FindBestInProbabilityGrid(rotated_cloud, initial_pose_estimate,
                                      search_parameters,
                                      static_cast<const ProbabilityGrid&>(grid))
          : FindBest(rotated_cloud, initial_pose_estimate, search_parameters,
                     grid);
  *pose_estimate = transform::Rigid2d(
      initial_pose_estimate.translation() + Eigen::Vector2d(best.x, best.y),
      initial_pose_estimate.rotation() * Eigen::Rotation2Dd(best.orientation));
  return best.score;
}

void RealTimeCorrelativeScanMatcher2D::ScoreCandidates(
    const Grid2D& grid, const std::vector<DiscreteScan2D>& discrete_scans,
    const SearchParameters&, std::vector<Candidate2D>* const candidates) const {
  for (Candidate2D& candidate : *candidates) {
    const DiscreteScan2D& scan = discrete_scans[candidate.scan_index];
    const Eigen::Array2i offset(candidate.x_index_offset,
                                candidate.y_index_offset);
    const float mean =
        grid.GetGridType() == GridType::TSDF
            ? MeanCloseness(static_cast<const TSDF2D&>(grid), scan, offset)
            : MeanProbability(static_cast<const ProbabilityGrid&>(grid), scan,
                              offset);
    candidate.score = static_cast<float>(
        mean * DeltaFactor(candidate.x, candidate.y, candidate.orientation));
  }
}

Candidate2D RealTimeCorrelativeScanMatcher2D::FindBest(
    const sensor::PointCloud& rotated_cloud,
    const transform::Rigid2d& initial_pose_estimate,
    const SearchParameters& search_parameters, const Grid2D& grid) const {
  const Eigen::Vector2f translation =
      initial_pose_estimate.translation().cast<float>();
  const std::vector<DiscreteScan2D> scans = DiscretizeScans(
      grid.limits(), GenerateRotatedScans(rotated_cloud, search_parameters),
      Eigen::Translation2f(translation));
  std::vector<Candidate2D> candidates;
  for (int scan = 0; scan != search_parameters.num_scans; ++scan) {
    const SearchParameters::LinearBounds& bounds =
        search_parameters.linear_bounds[scan];
    for (int x = bounds.min_x; x <= bounds.max_x; ++x) {
      for (int y = bounds.min_y; y <= bounds.max_y; ++y) {
        candidates.emplace_back(scan, x, y, search_parameters);
      }
    }
  }
  ScoreCandidates(grid, scans, search_parameters, &candidates);
  return *std::max_element(candidates.begin(), candidates.end());
}

Candidate2D RealTimeCorrelativeScanMatcher2D::FindBestInProbabilityGrid(
    const sensor::PointCloud& rotated_cloud,
    const transform::Rigid2d& initial_pose_estimate,
    const SearchParameters& search_parameters,
    const ProbabilityGrid& grid) const {
  // The same window for all scans. A point falls into the cells of a square of
  // this size, which many neighbouring rotations share when it is near. So each
  // point goes through the rotations, and adds its square to the sums of all
  // candidates of a rotation at once.
  const SearchParameters::LinearBounds bounds =
      search_parameters.linear_bounds.front();
  const int size = bounds.max_x - bounds.min_x + 1;
  const int num_candidates = size * size;
  const int stride = (num_candidates + 3) / 4 * 4;
  // The sums of so many rotations stay in the fastest memory.
  constexpr int kMaxSums = 8192;
  const int num_rotations = search_parameters.num_scans;
  const int block = std::min(std::max(1, kMaxSums / stride), num_rotations);

  const RotatedCellIndices indices(rotated_cloud, search_parameters,
                                   grid.limits(),
                                   initial_pose_estimate.translation());
  std::vector<int> x(block);
  std::vector<int> y(block);
  std::vector<float> square(stride, 0.f);
  std::vector<float> sums;
  Candidate2D best(0, bounds.min_x, bounds.min_y, search_parameters);
  best.score = -1.f;
  for (int begin = 0; begin < num_rotations; begin += block) {
    const int count = std::min(block, num_rotations - begin);
    sums.assign(static_cast<size_t>(count) * stride, 0.f);
    for (int point = 0; point != indices.num_points(); ++point) {
      indices.ForPoint(point, begin, begin + count, x.data(), y.data());
      for (int i = 0; i != count; ++i) {
        if (i == 0 || x[i] != x[i - 1] || y[i] != y[i - 1]) {
          ReadSquare(grid, x[i] + bounds.min_x, y[i] + bounds.min_y, size,
                     square.data());
        }
        Add(square.data(), stride, sums.data() + i * stride);
      }
    }
    for (int i = 0; i != count; ++i) {
      for (int x_offset = 0; x_offset != size; ++x_offset) {
        for (int y_offset = 0; y_offset != size; ++y_offset) {
          const float mean = sums[i * stride + y_offset * size + x_offset] /
                             static_cast<float>(indices.num_points());
          // The factor does not exceed 1.
          if (mean <= best.score) continue;
          Candidate2D candidate(begin + i, bounds.min_x + x_offset,
                                bounds.min_y + y_offset, search_parameters);
          candidate.score =
              static_cast<float>(mean * DeltaFactor(candidate.x, candidate.y,
                                                    candidate.orientation));
          if (candidate.score > best.score) best = candidate;
        }
      }
    }
  }
  return best;
}

double RealTimeCorrelativeScanMatcher2D::DeltaFactor(
    const double x, const double y, const double orientation) const {
  const double delta =
      std::hypot(x, y) * options_.translation_delta_cost_weight() +
      std::abs(orientation) * options_.rotation_delta_cost_weight();
  return std::exp(-common::Pow2(delta));
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
