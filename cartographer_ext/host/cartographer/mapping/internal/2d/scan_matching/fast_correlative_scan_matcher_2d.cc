// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/internal/2d/scan_matching/rotated_cell_indices.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

// sums[i] += values[i] for eight i, as one vector operation.
inline void AddEight(const uint8* __restrict const values,
                     uint16* __restrict const sums) {
  for (int i = 0; i != 8; ++i)
    sums[i] = static_cast<uint16>(sums[i] + values[i]);
}

}  // namespace

proto::FastCorrelativeScanMatcherOptions2D
CreateFastCorrelativeScanMatcherOptions2D(
    common::LuaParameterDictionary* const table) {
  return common::ReadOptions<proto::FastCorrelativeScanMatcherOptions2D>(table);
}

// The coarsest grid in another order. Its candidates are `width` cells apart,
// and here cells that far apart are neighbours: a point's values for a row of
// candidates are contiguous.
class FastCorrelativeScanMatcher2D::CoarseGrid {
 public:
  explicit CoarseGrid(const PrecomputationGrid2D& grid)
      : width_(grid.width()),
        num_x_blocks_((grid.num_x_cells() + width_ - 1) / width_),
        num_y_blocks_((grid.num_y_cells() + width_ - 1) / width_),
        // AddEight may read seven values too many.
        cells_(static_cast<size_t>(width_) * width_ * num_x_blocks_ *
                       num_y_blocks_ +
                   7,
               0) {
    for (int y = 0; y != grid.num_y_cells(); ++y) {
      for (int x = 0; x != grid.num_x_cells(); ++x) {
        cells_[Index(x % width_, y % width_, x / width_, y / width_)] =
            grid.cells()[y * grid.num_x_cells() + x];
      }
    }
  }

  int width() const { return width_; }

  // Adds one point's values to the sums of num_x times num_y candidates, whose
  // rows are `stride` >= num_x + 7 apart. The first candidate has the point in
  // cell (x, y).
  void AddPoint(const int x, const int y, const int num_x, const int num_y,
                const int stride, uint16* const sums) const {
    // Counted from the grid's first cell, as block and place within it.
    const auto x_parts = Split(x + width_ - 1);
    const auto y_parts = Split(y + width_ - 1);
    const int x_begin = std::max(0, -x_parts.first);
    const int x_end = std::min(num_x, num_x_blocks_ - x_parts.first);
    const int y_begin = std::max(0, -y_parts.first);
    const int y_end = std::min(num_y, num_y_blocks_ - y_parts.first);
    if (x_begin >= x_end || y_begin >= y_end) return;
    const uint8* values =
        cells_.data() + Index(x_parts.second, y_parts.second,
                              x_parts.first + x_begin, y_parts.first + y_begin);
    uint16* row = sums + y_begin * stride;
    for (int j = y_begin; j != y_end; ++j) {
      int i = x_begin;
      for (; i + 8 <= x_end; i += 8) AddEight(values + i - x_begin, row + i);
      if (i != x_end && x_end == num_x) {
        // What is added too much lands between the rows.
        AddEight(values + i - x_begin, row + i);
      } else {
        for (; i != x_end; ++i) {
          row[i] = static_cast<uint16>(row[i] + values[i - x_begin]);
        }
      }
      values += num_x_blocks_;
      row += stride;
    }
  }

 private:
  // Quotient, rounded down, and remainder.
  std::pair<int, int> Split(const int cell) const {
    const int remainder = cell & (width_ - 1);
    return {(cell - remainder) / width_, remainder};
  }
  size_t Index(const int x, const int y, const int x_block,
               const int y_block) const {
    return (static_cast<size_t>(y * width_ + x) * num_y_blocks_ + y_block) *
               num_x_blocks_ +
           x_block;
  }

  const int width_;  // a power of two
  const int num_x_blocks_;
  const int num_y_blocks_;
  std::vector<uint8> cells_;
};

// One search: its rotated scans and what branch and bound needs. Scores are
// compared as sums over the points of values from 0 to 255.
class FastCorrelativeScanMatcher2D::Search {
 public:
  // On level k: the candidates at offsets x to x + 2^k - 1, likewise y.
  struct Node {
    int scan;
    int x;
    int y;
    int sum;  // a bound, exact on level 0
  };

  Search(const PrecomputationGridStack2D& grids, const CoarseGrid& coarse_grid,
         const CellLimits& cell_limits, const RotatedCellIndices& indices,
         const SearchParameters& parameters)
      : grids_(grids),
        coarse_grid_(coarse_grid),
        num_points_(indices.num_points()),
        x_(static_cast<size_t>(num_points_) * indices.num_rotations()),
        y_(x_.size()) {
    scans_.reserve(indices.num_rotations());
    for (int i = 0; i != indices.num_rotations(); ++i) {
      int* const x = x_.data() + static_cast<size_t>(i) * num_points_;
      int* const y = y_.data() + static_cast<size_t>(i) * num_points_;
      indices.ForRotation(i, x, y);
      int min_x = x[0], max_x = x[0], min_y = y[0], max_y = y[0];
      for (int k = 1; k < num_points_; ++k) {
        min_x = std::min(min_x, x[k]);
        max_x = std::max(max_x, x[k]);
        min_y = std::min(min_y, y[k]);
        max_y = std::max(max_y, y[k]);
      }
      // Offsets that put the whole scan outside the grid are not searched, save
      // for the initial position.
      SearchParameters::LinearBounds bounds = parameters.linear_bounds[i];
      bounds.min_x = std::max(bounds.min_x, std::min(0, -max_x));
      bounds.min_y = std::max(bounds.min_y, std::min(0, -max_y));
      bounds.max_x = std::min(bounds.max_x,
                              std::max(0, cell_limits.num_x_cells - 1 - min_x));
      bounds.max_y = std::min(bounds.max_y,
                              std::max(0, cell_limits.num_y_cells - 1 - min_y));
      scans_.push_back(Scan{x, y, bounds});
    }
  }

  float ToScore(const int sum) const {
    return grids_.Get(0).ToScore(sum / static_cast<float>(num_points_));
  }

  // True, with the best candidate, when its score is above `min_score`.
  bool Run(const float min_score, Node* const best) {
    const int threshold = LargestSumNotAbove(min_score);
    const std::vector<Node> nodes = CoarsestNodes(threshold);
    best_ = Node{0, 0, 0, threshold};
    for (const Node& node : nodes) {
      if (node.sum <= best_.sum) break;
      Branch(node, grids_.max_depth());
    }
    *best = best_;
    return best_.sum > threshold;
  }

 private:
  struct Scan {
    const int* x;
    const int* y;
    SearchParameters::LinearBounds bounds;
  };

  // -1 when every sum scores more. By bisection, as rounding decides.
  int LargestSumNotAbove(const float score) const {
    int low = -1;
    int high = 255 * num_points_ + 1;
    while (high - low > 1) {
      const int middle = low + (high - low) / 2;
      (ToScore(middle) <= score ? low : high) = middle;
    }
    return low;
  }

  // Those above `threshold`, best first.
  std::vector<Node> CoarsestNodes(const int threshold) const {
    std::vector<Node> nodes;
    std::vector<uint16> sums;
    std::vector<int> totals;
    const int step = coarse_grid_.width();
    for (size_t i = 0; i != scans_.size(); ++i) {
      const Scan& scan = scans_[i];
      const SearchParameters::LinearBounds& bounds = scan.bounds;
      const int num_x = (bounds.max_x - bounds.min_x) / step + 1;
      const int num_y = (bounds.max_y - bounds.min_y) / step + 1;
      const int stride = num_x + 7;
      totals.assign(static_cast<size_t>(stride) * num_y, 0);
      for (int begin = 0; begin < num_points_; begin += kPointsPerSum) {
        const int end = std::min(begin + kPointsPerSum, num_points_);
        sums.assign(totals.size(), 0);
        for (int point = begin; point != end; ++point) {
          coarse_grid_.AddPoint(scan.x[point] + bounds.min_x,
                                scan.y[point] + bounds.min_y, num_x, num_y,
                                stride, sums.data());
        }
        for (size_t k = 0; k != totals.size(); ++k) totals[k] += sums[k];
      }
      for (int x = 0; x != num_x; ++x) {
        for (int y = 0; y != num_y; ++y) {
          const int sum = totals[y * stride + x];
          if (sum <= threshold) continue;
          nodes.push_back(Node{static_cast<int>(i), bounds.min_x + step * x,
                               bounds.min_y + step * y, sum});
        }
      }
    }
    std::stable_sort(nodes.begin(), nodes.end(), BetterThan);
    return nodes;
  }

  void Branch(const Node& node, const int level) {
    if (level == 0) {
      best_ = node;
      return;
    }
    const SearchParameters::LinearBounds& bounds = scans_[node.scan].bounds;
    const int half = 1 << (level - 1);
    int sums[4];
    if (!SumChildren(node, grids_.Get(level - 1), sums)) return;
    Node children[4];
    int num_children = 0;
    for (int i = 0; i != 4; ++i) {
      const Node child{node.scan, node.x + (i >> 1) * half,
                       node.y + (i & 1) * half, sums[i]};
      if (child.x > bounds.max_x || child.y > bounds.max_y) continue;
      // Equal ones stay in order.
      int place = num_children++;
      for (; place != 0 && BetterThan(child, children[place - 1]); --place) {
        children[place] = children[place - 1];
      }
      children[place] = child;
    }
    for (int i = 0; i != num_children; ++i) {
      if (children[i].sum <= best_.sum) break;
      Branch(children[i], level - 1);
    }
  }

  // For offsets (0, 0), (0, half), (half, 0) and (half, half) from the node's,
  // half being the width of the children's `grid`. False as soon as it is clear
  // that none exceeds the best so far: the node's sum consists of each point's
  // largest value among the children, so what they fall short of it for the
  // first points will be missing in the end.
  bool SumChildren(const Node& node, const PrecomputationGrid2D& grid,
                   int (&sums)[4]) const {
    const Scan& scan = scans_[node.scan];
    const uint8* const cells = grid.cells();
    const int half = grid.width();
    const int num_x = grid.num_x_cells();
    const int num_y = grid.num_y_cells();
    const int x_shift = node.x + half - 1;
    const int y_shift = node.y + half - 1;
    const int down = half * num_x;
    const unsigned inner_x = std::max(0, num_x - half);
    const unsigned inner_y = std::max(0, num_y - half);
    int low_low = 0, low_high = 0, high_low = 0, high_high = 0;
    int missing = node.sum - best_.sum;  // what may still be
    for (int begin = 0; begin < num_points_; begin += kPointsPerCheck) {
      const int end = std::min(begin + kPointsPerCheck, num_points_);
      for (int i = begin; i != end; ++i) {
        const int x = scan.x[i] + x_shift;
        const int y = scan.y[i] + y_shift;
        const int cell = y * num_x + x;
        int a = 0, b = 0, c = 0, d = 0;
        if (static_cast<unsigned>(x) < inner_x &&
            static_cast<unsigned>(y) < inner_y) {
          a = cells[cell];
          b = cells[cell + down];
          c = cells[cell + half];
          d = cells[cell + down + half];
        } else if (x >= -half && x < num_x && y >= -half && y < num_y) {
          if (x >= 0 && y >= 0) a = cells[cell];
          if (x >= 0 && y + half < num_y) b = cells[cell + down];
          if (x + half < num_x && y >= 0) c = cells[cell + half];
          if (x + half < num_x && y + half < num_y) {
            d = cells[cell + down + half];
          }
        }
        low_low += a;
        low_high += b;
        high_low += c;
        high_high += d;
        missing -= std::max(std::max(a, b), std::max(c, d));
      }
      const int largest =
          std::max(std::max(low_low, low_high), std::max(high_low, high_high));
      if (largest + missing <= 0) return false;
    }
    sums[0] = low_low;
    sums[1] = low_high;
    sums[2] = high_low;
    sums[3] = high_high;
    return true;
  }

  static bool BetterThan(const Node& a, const Node& b) { return a.sum > b.sum; }

  // So many values of 255 fit 16 bits.
  static constexpr int kPointsPerSum = 257;
  static constexpr int kPointsPerCheck = 16;

  const PrecomputationGridStack2D& grids_;
  const CoarseGrid& coarse_grid_;
  const int num_points_;
  std::vector<int> x_;
  std::vector<int> y_;
  std::vector<Scan> scans_;
  Node best_;
};

FastCorrelativeScanMatcher2D::FastCorrelativeScanMatcher2D(
    const Grid2D& grid,
    const proto::FastCorrelativeScanMatcherOptions2D& options)
    : options_(options),
      limits_(grid.limits()),
      grids_(absl::make_unique<PrecomputationGridStack2D>(grid, options)),
      coarse_grid_(
          absl::make_unique<CoarseGrid>(grids_->Get(grids_->max_depth()))) {
  // One copy is enough: a map has hundreds of matchers.
  grids_->ReleaseCoarsest();
}

FastCorrelativeScanMatcher2D::~FastCorrelativeScanMatcher2D() = default;

bool FastCorrelativeScanMatcher2D::Match(
    const transform::Rigid2d& initial_pose_estimate,
    const sensor::PointCloud& point_cloud, const float min_score,
    float* const score, transform::Rigid2d* const pose_estimate) const {
  const SearchParameters parameters(options_.linear_search_window(),
                                    options_.angular_search_window(),
                                    point_cloud, limits_.resolution());
  return MatchWithSearchParameters(parameters, initial_pose_estimate,
                                   point_cloud, min_score, score,
                                   pose_estimate);
}

bool FastCorrelativeScanMatcher2D::MatchFullSubmap(
    const sensor::PointCloud& point_cloud, const float min_score,
    float* const score, transform::Rigid2d* const pose_estimate) const {
  // More than any grid has; the search cuts it down to where points can be.
  constexpr double kCellsPerDirection = 1e6;
  const double resolution = limits_.resolution();
  const SearchParameters parameters(kCellsPerDirection * resolution, M_PI,
                                    point_cloud, resolution);
  const CellLimits& size = limits_.cell_limits();
  const Eigen::Vector2d middle =
      limits_.max() -
      0.5 * resolution * Eigen::Vector2d(size.num_y_cells, size.num_x_cells);
  return MatchWithSearchParameters(
      parameters, transform::Rigid2d::Translation(middle), point_cloud,
      min_score, score, pose_estimate);
}

bool FastCorrelativeScanMatcher2D::MatchWithSearchParameters(
    const SearchParameters search_parameters,
    const transform::Rigid2d& initial_pose_estimate,
    const sensor::PointCloud& point_cloud, const float min_score,
    float* const score, transform::Rigid2d* const pose_estimate) const {
  CHECK(score != nullptr);
  CHECK(pose_estimate != nullptr);
  if (point_cloud.empty()) return false;
  const RotatedCellIndices indices(
      RotateCloud(point_cloud, initial_pose_estimate), search_parameters,
      limits_, initial_pose_estimate.translation());
  Search search(*grids_, *coarse_grid_, limits_.cell_limits(), indices,
                search_parameters);
  Search::Node best;
  if (!search.Run(min_score, &best)) return false;
  const Candidate2D candidate(best.scan, best.x, best.y, search_parameters);
  *score = search.ToScore(best.sum);
  *pose_estimate =
      transform::Rigid2d(initial_pose_estimate.translation() +
                             Eigen::Vector2d(candidate.x, candidate.y),
                         initial_pose_estimate.rotation() *
                             Eigen::Rotation2Dd(candidate.orientation));
  return true;
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
