// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/overlapping_submaps_trimmer_2d.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/2d/xy_index.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

using SubmapDataById = MapById<SubmapId, PoseGraphInterface::SubmapData>;

const Grid2D& GridOf(const PoseGraphInterface::SubmapData& data) {
  return *static_cast<const Submap2D&>(*data.submap).grid();
}

// The time of the newest node that each submap was built from; submaps whose
// nodes were all trimmed are skipped.
std::map<SubmapId, common::Time> TimesOfNewestNodes(
    const Trimmable& pose_graph, const SubmapDataById& submaps) {
  std::map<SubmapId, NodeId> newest_nodes;
  for (const auto& constraint : pose_graph.GetConstraints()) {
    if (constraint.tag != PoseGraphInterface::Constraint::INTRA_SUBMAP) {
      continue;
    }
    NodeId& newest =
        newest_nodes.emplace(constraint.submap_id, constraint.node_id)
            .first->second;
    newest = std::max(newest, constraint.node_id);
  }
  std::map<SubmapId, common::Time> times;
  for (const auto& submap_node : newest_nodes) {
    if (submaps.Contains(submap_node.first) &&
        pose_graph.GetTrajectoryNodes().Contains(submap_node.second)) {
      times[submap_node.first] =
          pose_graph.GetTrajectoryNodes().at(submap_node.second).time();
    }
  }
  return times;
}

// Counts how often the cells of a global grid, in which all submaps are
// compared, were covered. Memory is taken by blocks that are covered at all.
class CoverageCounter {
 public:
  CoverageCounter(const Eigen::Vector2d& max, const double resolution)
      : max_(max), resolution_(resolution) {}

  double resolution() const { return resolution_; }

  // Covers the cell of a point once more, metres; returns how often it was
  // covered before, at most 65535 times.
  int Cover(const Eigen::Vector2d& point) {
    const Eigen::Vector2d cell = (max_ - point) / resolution_;
    const int64 x = std::llround(cell.x());
    const int64 y = std::llround(cell.y());
    const std::pair<int64, int64> id(x >> kBlockBits, y >> kBlockBits);
    if (block_ == nullptr || id != block_id_) {
      block_id_ = id;
      std::unique_ptr<Block>& block = blocks_[id];
      if (block == nullptr) block = absl::make_unique<Block>();
      block_ = block.get();
    }
    uint16& count =
        (*block_)[((y & kBlockMask) << kBlockBits) | (x & kBlockMask)];
    const int before = count;
    if (count < std::numeric_limits<uint16>::max()) ++count;
    return before;
  }

 private:
  static constexpr int kBlockBits = 6;
  static constexpr int64 kBlockMask = (1 << kBlockBits) - 1;
  using Block = std::array<uint16, 1 << (2 * kBlockBits)>;

  const Eigen::Vector2d max_;
  const double resolution_;
  std::map<std::pair<int64, int64>, std::unique_ptr<Block>> blocks_;
  std::pair<int64, int64> block_id_;  // of the last point
  Block* block_ = nullptr;
};

// Covers the known cells of a submap; returns how many of them were covered
// less than `fresh_submaps_count` times before.
int64 CoverFreshCells(const PoseGraphInterface::SubmapData& data,
                      const int fresh_submaps_count,
                      CoverageCounter* const counter) {
  const Grid2D& grid = GridOf(data);
  const transform::Rigid2d global_from_local =
      transform::Project2D(data.pose * data.submap->local_pose().inverse());
  Eigen::Array2i offset;
  CellLimits cell_limits;
  grid.ComputeCroppedLimits(&offset, &cell_limits);
  const double resolution = grid.limits().resolution();
  int64 num_fresh = 0;
  for (const Eigen::Array2i& cropped_index :
       XYIndexRangeIterator(cell_limits)) {
    const Eigen::Array2i index = cropped_index + offset;
    if (!grid.IsKnown(index)) {
      continue;
    }
    const Eigen::Vector2d center =
        global_from_local *
        Eigen::Vector2d(
            grid.limits().max().x() - resolution * (index.y() + 0.5),
            grid.limits().max().y() - resolution * (index.x() + 0.5));
    num_fresh += counter->Cover(center) < fresh_submaps_count;
  }
  return num_fresh;
}

}  // namespace

void OverlappingSubmapsTrimmer2D::Trim(Trimmable* const pose_graph) {
  const SubmapDataById submaps = pose_graph->GetOptimizedSubmapData();
  if (submaps.size() <=
      num_submaps_after_last_trim_ + min_added_submaps_count_) {
    return;
  }
  // From new to old.
  std::vector<std::pair<common::Time, SubmapId>> candidates;
  for (const auto& id_time : TimesOfNewestNodes(*pose_graph, submaps)) {
    if (submaps.at(id_time.first).submap->insertion_finished()) {
      candidates.emplace_back(id_time.second, id_time.first);
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const std::pair<common::Time, SubmapId>& a,
                      const std::pair<common::Time, SubmapId>& b) {
                     return a.first > b.first;
                   });
  const MapLimits& first_limits = GridOf((*submaps.begin()).data).limits();
  CoverageCounter counter(first_limits.max(), first_limits.resolution());
  const int64 min_num_cells = static_cast<int64>(
      min_covered_area_ / (counter.resolution() * counter.resolution()));
  std::vector<SubmapId> removed;
  for (const auto& time_id : candidates) {
    if (CoverFreshCells(submaps.at(time_id.second), fresh_submaps_count_,
                        &counter) < std::max<int64>(min_num_cells, 1)) {
      removed.push_back(time_id.second);
    }
  }
  std::sort(removed.begin(), removed.end());
  num_submaps_after_last_trim_ = submaps.size() - removed.size();
  for (const SubmapId& id : removed) {
    pose_graph->TrimSubmap(id);
  }
}

}  // namespace mapping
}  // namespace cartographer
