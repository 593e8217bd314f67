// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The scans and grids of a stored map in plain types. Together with the poses
// of a MapGraph, from the file or from another run, they are used to check the
// consistency of the map.
#ifndef CARTOGRAPHER_EXT_MAP_MAP_CONTENTS_H_
#define CARTOGRAPHER_EXT_MAP_MAP_CONTENTS_H_

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

// State of a cell in a submap. Cells with intermediate probability, and those
// next to unknown cells, are unsure.
enum class CellEvidence : uint8_t { kUnsure, kFree, kOccupied };

// A cell on a ray.
struct CellView {
  CellEvidence evidence = CellEvidence::kUnsure;
  // So many steps of one cell from the point, in any direction, do not end in
  // an occupied cell.
  int clear_steps = 0;
};

// The grid of one submap.
class SubmapCells {
 public:
  // `grid` must be one that CheckGrid accepts. `margin`: metres around occupied
  // or unknown cells in which a free cell does not count as free.
  SubmapCells(const cartographer::mapping::proto::Grid2D& grid, double margin);

  double resolution() const { return resolution_; }
  int num_x() const { return num_x_; }
  int num_y() const { return num_y_; }
  // `point`: in the local frame of the trajectory, metres.
  CellEvidence At(const Eigen::Vector2d& point) const {
    const int offset = Offset(Cell(point));
    return offset < 0 ? CellEvidence::kUnsure : cells_[offset];
  }
  // The same, and how far it is to the next wall.
  CellView View(const Eigen::Vector2d& point) const {
    CellView view;
    const Eigen::Vector2d cell = Cell(point);
    const int offset = Offset(cell);
    double distance = 0.;
    if (offset >= 0) {
      view.evidence = cells_[offset];
      distance = to_occupied_[offset];
    } else if (cell.allFinite()) {
      distance = std::min(
          (cell - Eigen::Vector2d(num_x_, num_y_)).cwiseMax(-cell).maxCoeff(),
          1e6);
    }
    // Rounding may move a cell by one.
    view.clear_steps = std::max(0, static_cast<int>(distance) - 2);
    return view;
  }
  // Occupied, or within the margin of an occupied cell.
  bool NearOccupied(const Eigen::Vector2d& point) const;
  // For each shift, how many of the points come to lie at most `tolerance`
  // (metres, in whole cells, each axis) from an occupied cell. `points` and
  // `shifts` in the local frame.
  std::vector<int> CountNearOccupied(const std::vector<Eigen::Vector2d>& points,
                                     const std::vector<Eigen::Vector2d>& shifts,
                                     double tolerance) const;
  // Mean probability of occupancy under the points, as the loop search scores a
  // match (0.1 for unknown cells); accurate to a few thousandths. `points` in
  // the frame of a node, `local_from_node` places them in the local frame.
  double Score(const std::vector<Eigen::Vector2d>& points,
               const Pose2& local_from_node) const;
  // Centres of the occupied cells, in the local frame.
  std::vector<Eigen::Vector2d> OccupiedCells() const;
  // Corners of the grid in the local frame.
  Eigen::Vector2d min_corner() const;
  Eigen::Vector2d max_corner() const { return max_; }

 private:
  // Continuous indices of a point. Cell ix runs against the y axis, iy against
  // the x axis.
  Eigen::Vector2d Cell(const Eigen::Vector2d& point) const {
    return Eigen::Vector2d((max_.y() - point.y()) / resolution_,
                           (max_.x() - point.x()) / resolution_);
  }
  // -1 outside.
  int Offset(const Eigen::Vector2d& cell) const {
    const double x = cell.x(), y = cell.y();
    if (!(x >= 0.) || !(y >= 0.) || !(x < num_x_) || !(y < num_y_)) return -1;
    return static_cast<int>(y) * num_x_ + static_cast<int>(x);
  }

  double resolution_;
  Eigen::Vector2d max_;
  int num_x_, num_y_;
  std::vector<CellEvidence> cells_;
  int radius_;                          // the margin, cells
  std::vector<uint8_t> to_occupied_;    // distance, cells
  std::vector<uint8_t> probabilities_;  // of 255
};

struct MapContents {
  // Returns in the frame of the node as in MapGraph, metres.
  std::map<GraphId, std::vector<Eigen::Vector2d>> scans;
  std::map<GraphId, SubmapCells> submaps;
};

struct MapContentsOptions {
  double margin = 0.15;  // metres, see SubmapCells
  // Scans with more returns are subsampled evenly to this number.
  int max_points = 400;
};

MapContents ReadMapContents(const io::Pbstream& pbstream,
                            const MapContentsOptions& options);

// The score of each loop of the graph at its own pose, in the order of the
// constraints; -1 if the scan or the grid is missing.
std::vector<double> LoopScores(const MapGraph& graph,
                               const MapContents& contents);

// (map <- local frame of the trajectory), by the poses of a submap.
Pose2 MapFromLocal(const GraphSubmap& submap);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_MAP_CONTENTS_H_
