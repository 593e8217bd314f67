// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/overlapping_submaps_trimmer_2d.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

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

// A cell of the coverage grid that a submap covers.
struct Coverage {
  int64 x;
  int64 y;
  common::Time time;
  SubmapId submap_id;

  bool SameCell(const Coverage& other) const {
    return x == other.x && y == other.y;
  }
  // By cell, within a cell from new to old.
  bool operator<(const Coverage& other) const {
    return std::tie(x, y, other.time, submap_id) <
           std::tie(other.x, other.y, time, other.submap_id);
  }
};

// The global grid that all submaps are compared in.
struct CoverageGrid {
  Eigen::Vector2d max;
  double resolution;
};

void AppendCoverage(const CoverageGrid& coverage_grid, const SubmapId& id,
                    const PoseGraphInterface::SubmapData& data,
                    const common::Time time,
                    std::vector<Coverage>* const coverage) {
  const Grid2D& grid = GridOf(data);
  const transform::Rigid2d global_from_local =
      transform::Project2D(data.pose * data.submap->local_pose().inverse());
  Eigen::Array2i offset;
  CellLimits cell_limits;
  grid.ComputeCroppedLimits(&offset, &cell_limits);
  const double resolution = grid.limits().resolution();
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
    const Eigen::Vector2d cell =
        (coverage_grid.max - center) / coverage_grid.resolution;
    coverage->push_back(
        Coverage{std::llround(cell.x()), std::llround(cell.y()), time, id});
  }
}

// How many cells belong to each submap.
std::map<SubmapId, int64> CountCells(std::vector<Coverage> coverage,
                                     const int fresh_submaps_count) {
  std::sort(coverage.begin(), coverage.end());
  std::map<SubmapId, int64> counts;
  int rank = 0;
  for (size_t i = 0; i < coverage.size(); ++i) {
    rank = i > 0 && coverage[i].SameCell(coverage[i - 1]) ? rank + 1 : 0;
    if (rank < fresh_submaps_count) {
      ++counts[coverage[i].submap_id];
    }
  }
  return counts;
}

}  // namespace

void OverlappingSubmapsTrimmer2D::Trim(Trimmable* const pose_graph) {
  const SubmapDataById submaps = pose_graph->GetOptimizedSubmapData();
  if (submaps.size() <=
      num_submaps_after_last_trim_ + min_added_submaps_count_) {
    return;
  }
  const MapLimits& first_limits = GridOf((*submaps.begin()).data).limits();
  const CoverageGrid coverage_grid{first_limits.max(),
                                   first_limits.resolution()};
  const std::map<SubmapId, common::Time> times =
      TimesOfNewestNodes(*pose_graph, submaps);
  std::vector<Coverage> coverage;
  std::vector<SubmapId> candidates;
  for (const auto& id_time : times) {
    const PoseGraphInterface::SubmapData& data = submaps.at(id_time.first);
    if (!data.submap->insertion_finished()) {
      continue;
    }
    candidates.push_back(id_time.first);
    AppendCoverage(coverage_grid, id_time.first, data, id_time.second,
                   &coverage);
  }
  const std::map<SubmapId, int64> num_cells =
      CountCells(std::move(coverage), fresh_submaps_count_);
  const int64 min_num_cells =
      static_cast<int64>(min_covered_area_ /
                         (coverage_grid.resolution * coverage_grid.resolution));
  std::vector<SubmapId> removed;
  for (const SubmapId& id : candidates) {
    const auto it = num_cells.find(id);
    if (it == num_cells.end() || it->second < min_num_cells) {
      removed.push_back(id);
    }
  }
  num_submaps_after_last_trim_ = submaps.size() - removed.size();
  for (const SubmapId& id : removed) {
    pose_graph->TrimSubmap(id);
  }
}

}  // namespace mapping
}  // namespace cartographer
