// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The scans and grids of a stored map in plain types. Together with the poses
// of a MapGraph, from the file or from another run, they are used to check the
// consistency of the map.
#ifndef CARTOGRAPHER_EXT_MAP_MAP_CONTENTS_H_
#define CARTOGRAPHER_EXT_MAP_MAP_CONTENTS_H_

#include <map>
#include <string>
#include <vector>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/submap_cells.h"

namespace cartographer_ext {
namespace evaluation {

struct MapContents {
  // Returns in the frame of the node as in MapGraph, metres.
  std::map<GraphId, std::vector<Eigen::Vector2d>> scans;
  std::map<GraphId, SubmapCells> submaps;
};

struct MapContentsOptions {
  double margin = 0.15;  // metres, see SubmapCells
  // Scans with more returns are subsampled evenly to this number.
  int max_points = 400;
  // Of ReadMapFile: leave the grids in the state, too.
  bool keep_grids = false;
};

MapContents ReadMapContents(const io::Pbstream& pbstream,
                            const MapContentsOptions& options);

// A state with its contents. Unless they are to be kept, the grids are in the
// contents alone: each takes the memory of a message only while it is read.
struct MapFile {
  io::Pbstream pbstream;
  MapContents contents;
};

// Errors as of io::ReadPbstream.
absl::StatusOr<MapFile> ReadMapFile(const std::string& filename,
                                    const MapContentsOptions& options);

// The score of each loop of the graph at its own pose, in the order of the
// constraints; -1 if the scan or the grid is missing.
std::vector<double> LoopScores(const MapGraph& graph,
                               const MapContents& contents);

// All submaps at the poses of the graph, see PaintMap; those that either lacks
// are skipped.
absl::StatusOr<io::OccupancyMap> PaintContents(const MapGraph& graph,
                                               const MapContents& contents,
                                               double resolution);

// What is painted of the contents, the rest of which is freed: a picture of a
// large map takes as much again.
using MapGrids = std::map<GraphId, SubmapGrid>;
MapGrids TakeGrids(MapContents contents);

// As PaintContents.
absl::StatusOr<io::OccupancyMap> PaintGrids(const MapGraph& graph,
                                            const MapGrids& grids,
                                            double resolution);

// (map <- local frame of the trajectory), by the poses of a submap.
Pose2 MapFromLocal(const GraphSubmap& submap);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_MAP_CONTENTS_H_
