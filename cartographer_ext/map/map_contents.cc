// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_contents.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "cartographer/mapping/trajectory_node.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/map_painter.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

void AddGrid(const cartographer::mapping::proto::Submap& record,
             const MapContentsOptions& options, MapContents* const contents) {
  if (!record.submap_2d().has_grid()) return;
  auto grid = SubmapGrid::Make(record.submap_2d().grid());
  if (!grid.ok()) return;
  contents->submaps.emplace(GraphId{record.submap_id().trajectory_id(),
                                    record.submap_id().submap_index()},
                            SubmapCells(*std::move(grid), options.margin));
}

void AddGrids(const io::Pbstream& pbstream, const MapContentsOptions& options,
              MapContents* const contents) {
  for (const auto& record : pbstream.submaps) {
    AddGrid(record, options, contents);
  }
}

void AddScans(const io::Pbstream& pbstream, const MapContentsOptions& options,
              MapContents* const contents) {
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
    auto& scan = contents->scans[{record.node_id().trajectory_id(),
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
}

// Nothing if the graph lacks the submap.
void Place(const MapGraph& graph, const GraphId& id, const SubmapGrid& grid,
           std::vector<PlacedGrid>* const placed) {
  const auto poses = graph.submaps.find(id);
  if (poses == graph.submaps.end()) return;
  placed->push_back({&grid, MapFromLocal(poses->second)});
}

}  // namespace

MapContents ReadMapContents(const io::Pbstream& pbstream,
                            const MapContentsOptions& options) {
  MapContents contents;
  AddScans(pbstream, options, &contents);
  AddGrids(pbstream, options, &contents);
  return contents;
}

absl::StatusOr<MapFile> ReadMapFile(const std::string& filename,
                                    const MapContentsOptions& options) {
  MapFile map;
  io::PbstreamReaderOptions reading;
  if (!options.keep_grids) {
    reading.take_grid =
        [&](const cartographer::mapping::proto::Submap& record) {
          AddGrid(record, options, &map.contents);
        };
  }
  auto pbstream = io::ReadPbstream(filename, reading);
  if (!pbstream.ok()) return pbstream.status();
  map.pbstream = *std::move(pbstream);
  AddScans(map.pbstream, options, &map.contents);
  if (options.keep_grids) AddGrids(map.pbstream, options, &map.contents);
  return map;
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

absl::StatusOr<io::OccupancyMap> PaintContents(const MapGraph& graph,
                                               const MapContents& contents,
                                               const double resolution) {
  std::vector<PlacedGrid> placed;
  for (const auto& submap : contents.submaps) {
    Place(graph, submap.first, submap.second.grid(), &placed);
  }
  return PaintMap(placed, resolution);
}

MapGrids TakeGrids(MapContents contents) {
  MapGrids grids;
  for (auto& submap : contents.submaps) {
    grids.emplace(submap.first, std::move(submap.second).TakeGrid());
  }
  return grids;
}

absl::StatusOr<io::OccupancyMap> PaintGrids(const MapGraph& graph,
                                            const MapGrids& grids,
                                            const double resolution) {
  std::vector<PlacedGrid> placed;
  for (const auto& grid : grids) {
    Place(graph, grid.first, grid.second, &placed);
  }
  return PaintMap(placed, resolution);
}

Pose2 MapFromLocal(const GraphSubmap& submap) {
  return submap.global_pose * submap.local_pose.Inverse();
}

}  // namespace evaluation
}  // namespace cartographer_ext
