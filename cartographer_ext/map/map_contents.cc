// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_contents.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "cartographer/mapping/trajectory_node.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/map_painter.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr float kOccupiedFrom = 0.6f;
constexpr float kFreeUpTo = 0.4f;
constexpr float kUnknownProbability = 0.1f;

// Rows or columns to the nearest marked cell, whichever are more (chessboard
// distance), at most `kFar`.
constexpr int kFar = std::numeric_limits<uint8_t>::max();
std::vector<uint8_t> DistancesTo(const std::vector<bool>& marked,
                                 const int num_x, const int num_y) {
  // With a border, so that every cell has all neighbours.
  const ptrdiff_t width = num_x + 2;
  std::vector<uint8_t> padded(width * (num_y + 2), kFar);
  const auto lower = [](uint8_t* const cell, const ptrdiff_t row,
                        const ptrdiff_t column) {
    const int nearest = std::min(std::min(cell[column], cell[row]),
                                 std::min(cell[row - 1], cell[row + 1]));
    *cell = static_cast<uint8_t>(std::min<int>(*cell, nearest + 1));
  };
  for (int y = 0; y < num_y; ++y) {
    uint8_t* const row = &padded[(y + 1) * width + 1];
    for (int x = 0; x < num_x; ++x) {
      if (marked[static_cast<size_t>(y) * num_x + x]) row[x] = 0;
      lower(row + x, -width, -1);
    }
  }
  std::vector<uint8_t> distances(marked.size());
  for (int y = num_y - 1; y >= 0; --y) {
    uint8_t* const row = &padded[(y + 1) * width + 1];
    for (int x = num_x - 1; x >= 0; --x) lower(row + x, width, 1);
    std::copy(row, row + num_x,
              distances.begin() + static_cast<ptrdiff_t>(y) * num_x);
  }
  return distances;
}

}  // namespace

SubmapCells::SubmapCells(const cartographer::mapping::proto::Grid2D& grid,
                         const double margin)
    : resolution_(grid.limits().resolution()),
      max_(grid.limits().max().x(), grid.limits().max().y()),
      num_x_(grid.limits().cell_limits().num_x_cells()),
      num_y_(grid.limits().cell_limits().num_y_cells()),
      cells_(static_cast<size_t>(num_x_) * num_y_, CellEvidence::kUnsure),
      probabilities_(cells_.size(), 0) {
  std::vector<bool> occupied(cells_.size(), false);
  std::vector<bool> not_free(cells_.size(), false);
  for (int iy = 0; iy < num_y_; ++iy) {
    for (int ix = 0; ix < num_x_; ++ix) {
      const float probability = Occupancy(grid, ix, iy);
      const size_t i = static_cast<size_t>(iy) * num_x_ + ix;
      occupied[i] = probability >= kOccupiedFrom;
      not_free[i] = !(probability <= kFreeUpTo);  // also where unknown
      probabilities_[i] = static_cast<uint8_t>(
          std::lround(255.f * (std::isnan(probability) ? kUnknownProbability
                                                       : probability)));
    }
  }
  // The small addition rounds half a cell up, whatever the rounding error.
  radius_ = static_cast<int>(
      std::lround(std::min(std::max(0., margin / resolution_ + 1e-6),
                           static_cast<double>(kFar - 1))));
  to_occupied_ = DistancesTo(occupied, num_x_, num_y_);
  const std::vector<uint8_t> to_not_free =
      DistancesTo(not_free, num_x_, num_y_);
  for (size_t i = 0; i < cells_.size(); ++i) {
    if (occupied[i]) {
      cells_[i] = CellEvidence::kOccupied;
    } else if (to_not_free[i] > radius_) {
      cells_[i] = CellEvidence::kFree;
    }
  }
}

bool SubmapCells::NearOccupied(const Eigen::Vector2d& point) const {
  const int offset = Offset(Cell(point));
  return offset >= 0 && to_occupied_[offset] <= radius_;
}

std::vector<int> SubmapCells::CountNearOccupied(
    const std::vector<Eigen::Vector2d>& points,
    const std::vector<Eigen::Vector2d>& shifts, const double tolerance) const {
  std::vector<Eigen::Vector2d> cells;
  for (const Eigen::Vector2d& point : points) cells.push_back(Cell(point));
  const Eigen::Vector2d origin = Cell(Eigen::Vector2d::Zero());
  const double limit = tolerance / resolution_;
  std::vector<int> counts;
  for (const Eigen::Vector2d& shift : shifts) {
    const Eigen::Vector2d moved = Cell(shift) - origin;
    int count = 0;
    for (const Eigen::Vector2d& cell : cells) {
      const int offset = Offset(cell + moved);
      count += offset >= 0 && to_occupied_[offset] <= limit;
    }
    counts.push_back(count);
  }
  return counts;
}

double SubmapCells::Score(const std::vector<Eigen::Vector2d>& points,
                          const Pose2& local_from_node) const {
  if (points.empty()) return 0.;
  double sum = 0.;
  for (const Eigen::Vector2d& point : points) {
    const int offset = Offset(Cell(local_from_node * point));
    sum += offset < 0 ? kUnknownProbability : probabilities_[offset] / 255.;
  }
  return sum / static_cast<double>(points.size());
}

std::vector<Eigen::Vector2d> SubmapCells::OccupiedCells() const {
  std::vector<Eigen::Vector2d> result;
  for (int iy = 0; iy < num_y_; ++iy) {
    for (int ix = 0; ix < num_x_; ++ix) {
      if (cells_[static_cast<size_t>(iy) * num_x_ + ix] !=
          CellEvidence::kOccupied) {
        continue;
      }
      result.emplace_back(max_.x() - (iy + 0.5) * resolution_,
                          max_.y() - (ix + 0.5) * resolution_);
    }
  }
  return result;
}

Eigen::Vector2d SubmapCells::min_corner() const {
  return max_ - resolution_ * Eigen::Vector2d(num_y_, num_x_);
}

MapContents ReadMapContents(const io::Pbstream& pbstream,
                            const MapContentsOptions& options) {
  MapContents contents;
  for (const auto& record : pbstream.nodes) {
    const auto node = cartographer::mapping::FromProto(record.node_data());
    // The cloud is in the gravity-aligned frame, whose yaw may differ.
    const double offset =
        NormalizeAngle(ToPlanarPose(node.local_pose *
                                    cartographer::transform::Rigid3d::Rotation(
                                        node.gravity_alignment.inverse()))
                           .theta -
                       ToPlanarPose(node.local_pose).theta);
    const Pose2 node_from_cloud(0., 0., offset);
    auto& scan = contents.scans[{record.node_id().trajectory_id(),
                                 record.node_id().node_index()}];
    const auto& points = node.filtered_gravity_aligned_point_cloud.points();
    const size_t step =
        std::max<size_t>(1, (points.size() + options.max_points - 1) /
                                std::max(1, options.max_points));
    for (size_t i = 0; i < points.size(); i += step) {
      const Eigen::Vector2d point = points[i].position.head<2>().cast<double>();
      if (point.allFinite()) scan.push_back(node_from_cloud * point);
    }
  }
  for (const auto& record : pbstream.submaps) {
    const auto& submap = record.submap_2d();
    if (!submap.has_grid() || !CheckGrid(submap.grid()).ok()) continue;
    contents.submaps.emplace(GraphId{record.submap_id().trajectory_id(),
                                     record.submap_id().submap_index()},
                             SubmapCells(submap.grid(), options.margin));
  }
  return contents;
}

std::vector<double> LoopScores(const MapGraph& graph,
                               const MapContents& contents) {
  std::vector<double> scores;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (!constraint.is_loop) continue;
    const auto submap = graph.submaps.find(constraint.submap_id);
    const auto cells = contents.submaps.find(constraint.submap_id);
    const auto scan = contents.scans.find(constraint.node_id);
    if (submap == graph.submaps.end() || cells == contents.submaps.end() ||
        scan == contents.scans.end()) {
      scores.push_back(-1.);
      continue;
    }
    scores.push_back(cells->second.Score(
        scan->second, submap->second.local_pose * constraint.relative_pose));
  }
  return scores;
}

Pose2 MapFromLocal(const GraphSubmap& submap) {
  return submap.global_pose * submap.local_pose.Inverse();
}

}  // namespace evaluation
}  // namespace cartographer_ext
