// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_2D_GRID_2D_H_
#define CARTOGRAPHER_MAPPING_2D_GRID_2D_H_

#include <memory>
#include <vector>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/common/port.h"
#include "cartographer/mapping/2d/cell_storage.h"
#include "cartographer/mapping/2d/map_limits.h"
#include "cartographer/mapping/grid_interface.h"
#include "cartographer/mapping/probability_values.h"
#include "cartographer/mapping/proto/grid_2d.pb.h"
#include "cartographer/mapping/proto/grid_2d_options.pb.h"
#include "cartographer/mapping/proto/submap_visualization.pb.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "cartographer/transform/rigid_transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

// Reads `grid_type` and `resolution`.
proto::GridOptions2D CreateGridOptions2D(
    common::LuaParameterDictionary* parameter_dictionary);

enum class GridType { PROBABILITY_GRID, TSDF };

// A grid of 16-bit correspondence costs (see probability_values.h for the
// encoding). An update is a series of cell changes, each of which marks its
// cell, ended by FinishUpdate; grids grow and are saved between updates only.
class Grid2D : public GridInterface {
 public:
  // All cells unknown. `conversion_tables` must outlive the grid.
  Grid2D(const MapLimits& limits, float min_correspondence_cost,
         float max_correspondence_cost,
         ValueConversionTables* conversion_tables);
  // The number of cells must fit the limits; who reads files checks that first.
  Grid2D(const proto::Grid2D& proto, ValueConversionTables* conversion_tables);

  const MapLimits& limits() const { return limits_; }

  // Removes the marks.
  void FinishUpdate();

  // Unknown cells and those outside the grid have the maximum cost.
  float GetCorrespondenceCost(const Eigen::Array2i& cell_index) const {
    if (!limits_.Contains(cell_index)) return max_correspondence_cost_;
    return value_to_cost_[CellValue(cell_index)];
  }

  virtual GridType GetGridType() const = 0;
  float GetMinCorrespondenceCost() const { return min_correspondence_cost_; }
  float GetMaxCorrespondenceCost() const { return max_correspondence_cost_; }

  bool IsKnown(const Eigen::Array2i& cell_index) const {
    return limits_.Contains(cell_index) &&
           CellValue(cell_index) != kUnknownCorrespondenceValue;
  }

  // The smallest rectangle with all known cells: index of its first cell and
  // its size. One cell at the origin when nothing is known.
  void ComputeCroppedLimits(Eigen::Array2i* offset, CellLimits* limits) const;

  // Doubles the grid around its middle until it contains `point` (metres).
  // Indices found before have another meaning afterwards.
  virtual void GrowLimits(const Eigen::Vector2f& point);

  virtual std::unique_ptr<Grid2D> ComputeCroppedGrid() const = 0;
  virtual proto::Grid2D ToProto() const;

  // Gray and alpha of the known rectangle; the pose is (submap <- picture).
  virtual bool DrawToSubmapTexture(
      proto::SubmapQuery::Response::SubmapTexture* texture,
      transform::Rigid3d local_pose) const = 0;

  // Not part of Cartographer's interface, as is what follows. Keeps the cells
  // in less memory; nothing may be changed afterwards.
  virtual void MakeCompact() {}
  // What ToProto says but for the cells.
  virtual proto::Grid2D HeadToProto() const;

  // For this host's own inner loops; the cells must lie inside the grid.
  const float* value_to_correspondence_cost() const { return value_to_cost_; }
  bool is_compact() const { return cells_.data() == nullptr; }
  uint16 CellValue(const Eigen::Array2i& cell_index) const {
    return is_compact() ? compact_cells_.At(cell_index.x(), cell_index.y())
                        : cells_[ToFlatIndex(cell_index)];
  }
  // The values of `count` cells from (x, y) on, with x growing; `buffer` has
  // room for them and may be used.
  const uint16* CellRun(const int x, const int y, const int count,
                        uint16* const buffer) const {
    return is_compact() ? compact_cells_.Run(x, y, count, buffer)
                        : cells_.data() + ToFlatIndex({x, y});
  }
  // GetCorrespondenceCost of `count` cells, inside the grid or not.
  void CopyCorrespondenceCosts(int x, int y, int count, float* costs) const;

 protected:
  // Grows several arrays of cells of this size together.
  void GrowLimits(const Eigen::Vector2f& point,
                  const std::vector<FlatCells*>& grids,
                  const std::vector<uint16>& grids_unknown_cell_values);

  // Fatal for a compact grid.
  const FlatCells& correspondence_cost_cells() const {
    CHECK(!is_compact());
    return cells_;
  }
  FlatCells* mutable_correspondence_cost_cells() {
    CHECK(!is_compact());
    return &cells_;
  }
  void MakeCostCellsCompact();
  const std::vector<int>& update_indices() const { return update_indices_; }
  std::vector<int>* mutable_update_indices() { return &update_indices_; }
  const Eigen::AlignedBox2i& known_cells_box() const {
    return known_cells_box_;
  }
  Eigen::AlignedBox2i* mutable_known_cells_box() { return &known_cells_box_; }

  int ToFlatIndex(const Eigen::Array2i& cell_index) const {
    DCHECK(limits_.Contains(cell_index)) << cell_index;
    return limits_.cell_limits().num_x_cells * cell_index.y() + cell_index.x();
  }

  // Limits of the known rectangle, for a cropped grid or a picture of it.
  MapLimits CroppedMapLimits(Eigen::Array2i* offset) const;
  // The cells of the known rectangle out of an array of this grid's size.
  FlatCells CropCells(const FlatCells& cells) const;
  // What all kinds of grid have to say about their picture. `delta` maps the
  // index of a known cell to a brightness in [-255, 255], 0 being gray.
  template <typename DeltaFunction>
  void DrawTexture(const DeltaFunction& delta,
                   const transform::Rigid3d& local_pose,
                   proto::SubmapQuery::Response::SubmapTexture* texture) const;

 private:
  void FinishTexture(std::string cells, const transform::Rigid3d& local_pose,
                     proto::SubmapQuery::Response::SubmapTexture* t) const;

  MapLimits limits_;
  FlatCells cells_;  // without memory in a compact grid
  CompactCells compact_cells_;
  float min_correspondence_cost_;
  float max_correspondence_cost_;
  std::vector<int> update_indices_;      // flat indices of marked cells
  Eigen::AlignedBox2i known_cells_box_;  // both corners included
  const float* value_to_cost_;
};

template <typename DeltaFunction>
void Grid2D::DrawTexture(
    const DeltaFunction& delta, const transform::Rigid3d& local_pose,
    proto::SubmapQuery::Response::SubmapTexture* const texture) const {
  Eigen::Array2i offset;
  CellLimits size;
  ComputeCroppedLimits(&offset, &size);
  std::string pixels;
  pixels.reserve(2 * static_cast<size_t>(size.num_x_cells) * size.num_y_cells);
  for (const Eigen::Array2i& xy_index : XYIndexRangeIterator(size)) {
    const Eigen::Array2i cell_index = xy_index + offset;
    uint8 value = 0;
    uint8 alpha = 0;
    if (IsKnown(cell_index)) {
      // Colours are premultiplied: value alone brightens what lies below,
      // alpha alone darkens it. Fully transparent is left to unknown cells.
      const int brightness = delta(cell_index);
      value = static_cast<uint8>(brightness > 0 ? brightness : 0);
      alpha = static_cast<uint8>(brightness < 0 ? -brightness : 0);
      if (brightness == 0) alpha = 1;
    }
    pixels.push_back(static_cast<char>(value));
    pixels.push_back(static_cast<char>(alpha));
  }
  FinishTexture(std::move(pixels), local_pose, texture);
}

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_2D_GRID_2D_H_
