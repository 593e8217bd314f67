// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/grid_2d.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "cartographer/common/internal/read_options.h"
#include "cartographer/transform/transform.h"

namespace cartographer {
namespace mapping {
namespace {

// Files from before these fields existed have zero in both; their grids were
// probability grids.
bool LacksCostRange(const proto::Grid2D& proto) {
  return proto.min_correspondence_cost() == 0.f &&
         proto.max_correspondence_cost() == 0.f;
}

Eigen::AlignedBox2i BoxFromProto(const proto::Grid2D& proto) {
  if (!proto.has_known_cells_box()) return Eigen::AlignedBox2i();
  const proto::Grid2D::CellBox& box = proto.known_cells_box();
  return {Eigen::Vector2i(box.min_x(), box.min_y()),
          Eigen::Vector2i(box.max_x(), box.max_y())};
}

}  // namespace

proto::GridOptions2D CreateGridOptions2D(
    common::LuaParameterDictionary* const table) {
  return common::ReadOptions<proto::GridOptions2D>(table);
}

Grid2D::Grid2D(const MapLimits& limits, const float min_correspondence_cost,
               const float max_correspondence_cost,
               ValueConversionTables* const conversion_tables)
    : limits_(limits),
      cells_(static_cast<size_t>(limits.cell_limits().num_x_cells) *
             limits.cell_limits().num_y_cells),
      min_correspondence_cost_(min_correspondence_cost),
      max_correspondence_cost_(max_correspondence_cost),
      value_to_cost_(conversion_tables
                         ->GetConversionTable(max_correspondence_cost,
                                              min_correspondence_cost,
                                              max_correspondence_cost)
                         ->data()) {
  CHECK_LT(min_correspondence_cost_, max_correspondence_cost_);
}

Grid2D::Grid2D(const proto::Grid2D& proto,
               ValueConversionTables* const conversion_tables)
    : Grid2D(MapLimits(proto.limits()),
             LacksCostRange(proto) ? kMinCorrespondenceCost
                                   : proto.min_correspondence_cost(),
             LacksCostRange(proto) ? kMaxCorrespondenceCost
                                   : proto.max_correspondence_cost(),
             conversion_tables) {
  CHECK_EQ(static_cast<size_t>(proto.cells_size()), cells_.size());
  std::transform(proto.cells().begin(), proto.cells().end(), cells_.begin(),
                 [](const int cell) { return static_cast<uint16>(cell); });
  known_cells_box_ = BoxFromProto(proto);
}

void Grid2D::FinishUpdate() {
  for (const int index : update_indices_) {
    cells_[index] &= static_cast<uint16>(~kUpdateMarker);
  }
  update_indices_.clear();
}

void Grid2D::ComputeCroppedLimits(Eigen::Array2i* const offset,
                                  CellLimits* const limits) const {
  if (known_cells_box_.isEmpty()) {
    *offset = Eigen::Array2i::Zero();
    *limits = CellLimits(1, 1);
    return;
  }
  const Eigen::Vector2i size =
      known_cells_box_.max() - known_cells_box_.min() + Eigen::Vector2i::Ones();
  *offset = known_cells_box_.min().array();
  *limits = CellLimits(size.x(), size.y());
}

void Grid2D::CopyCorrespondenceCosts(const int x, const int y, const int count,
                                     float* const costs) const {
  const CellLimits& size = limits_.cell_limits();
  const bool has_row = y >= 0 && y < size.num_y_cells;
  // Inside are cells [begin, end) of the run.
  const int begin = has_row ? std::min(count, std::max(0, -x)) : count;
  const int end =
      has_row ? std::max(begin, std::min(count, size.num_x_cells - x)) : count;
  std::fill_n(costs, begin, max_correspondence_cost_);
  std::fill(costs + end, costs + count, max_correspondence_cost_);
  constexpr int kAtOnce = 64;
  uint16 buffer[kAtOnce];
  for (int i = begin; i < end; i += kAtOnce) {
    const int num_cells = std::min(kAtOnce, end - i);
    const uint16* const cells = CellRun(x + i, y, num_cells, buffer);
    for (int k = 0; k != num_cells; ++k)
      costs[i + k] = value_to_cost_[cells[k]];
  }
}

void Grid2D::GrowLimits(const Eigen::Vector2f& point) {
  GrowLimits(point, {&cells_}, {kUnknownCorrespondenceValue});
}

void Grid2D::GrowLimits(const Eigen::Vector2f& point,
                        const std::vector<FlatCells*>& grids,
                        const std::vector<uint16>& grids_unknown_cell_values) {
  CHECK(update_indices_.empty()) << "a grid cannot grow during an update";
  CHECK(point.allFinite());
  while (!limits_.Contains(limits_.GetCellIndex(point))) {
    const CellLimits old_size = limits_.cell_limits();
    CHECK_LT(static_cast<int64>(old_size.num_x_cells) * old_size.num_y_cells,
             std::numeric_limits<int>::max() / 4)
        << "range data at " << point.transpose() << " is too far away";
    const CellLimits new_size(2 * old_size.num_x_cells,
                              2 * old_size.num_y_cells);
    const Eigen::Vector2i margin(old_size.num_x_cells / 2,
                                 old_size.num_y_cells / 2);
    for (size_t i = 0; i != grids.size(); ++i) {
      CHECK_EQ(grids_unknown_cell_values[i], 0);
      FlatCells grown(static_cast<size_t>(new_size.num_x_cells) *
                      new_size.num_y_cells);
      auto old_row = grids[i]->cbegin();
      auto new_row = grown.begin() + margin.y() * new_size.num_x_cells;
      for (int row = 0; row != old_size.num_y_cells; ++row) {
        // Cells that are never written take no memory.
        const auto is_known = [](const uint16 cell) { return cell != 0; };
        const auto old_end = old_row + old_size.num_x_cells;
        const auto first = std::find_if(old_row, old_end, is_known);
        auto last = old_end;
        while (last != first && !is_known(*(last - 1))) --last;
        std::copy(first, last, new_row + margin.x() + (first - old_row));
        old_row = old_end;
        new_row += new_size.num_x_cells;
      }
      *grids[i] = std::move(grown);
    }
    const double resolution = limits_.resolution();
    limits_ = MapLimits(
        resolution,
        limits_.max() + resolution * Eigen::Vector2d(margin.y(), margin.x()),
        new_size);
    if (!known_cells_box_.isEmpty()) known_cells_box_.translate(margin);
  }
}

proto::Grid2D Grid2D::ToProto() const {
  proto::Grid2D result = HeadToProto();
  const CellLimits& size = limits_.cell_limits();
  result.mutable_cells()->Reserve(size.num_x_cells * size.num_y_cells);
  std::vector<uint16> buffer(size.num_x_cells);
  for (int y = 0; y != size.num_y_cells; ++y) {
    const uint16* const row = CellRun(0, y, size.num_x_cells, buffer.data());
    result.mutable_cells()->Add(row, row + size.num_x_cells);
  }
  return result;
}

proto::Grid2D Grid2D::HeadToProto() const {
  CHECK(update_indices_.empty()) << "a grid cannot be saved during an update";
  proto::Grid2D result;
  *result.mutable_limits() = mapping::ToProto(limits_);
  if (!known_cells_box_.isEmpty()) {
    proto::Grid2D::CellBox* const box = result.mutable_known_cells_box();
    box->set_min_x(known_cells_box_.min().x());
    box->set_min_y(known_cells_box_.min().y());
    box->set_max_x(known_cells_box_.max().x());
    box->set_max_y(known_cells_box_.max().y());
  }
  result.set_min_correspondence_cost(min_correspondence_cost_);
  result.set_max_correspondence_cost(max_correspondence_cost_);
  return result;
}

MapLimits Grid2D::CroppedMapLimits(Eigen::Array2i* const offset) const {
  CellLimits size;
  ComputeCroppedLimits(offset, &size);
  const double resolution = limits_.resolution();
  return {
      resolution,
      limits_.max() - resolution * Eigen::Vector2d(offset->y(), offset->x()),
      size};
}

void Grid2D::MakeCostCellsCompact() {
  CHECK(update_indices_.empty())
      << "a grid cannot be finished during an update";
  if (is_compact()) return;
  compact_cells_ = CompactCells(cells_, limits_.cell_limits());
  cells_ = FlatCells();
  update_indices_ = std::vector<int>();
}

FlatCells Grid2D::CropCells(const FlatCells& cells) const {
  Eigen::Array2i offset;
  CellLimits size;
  ComputeCroppedLimits(&offset, &size);
  FlatCells cropped;
  cropped.reserve(static_cast<size_t>(size.num_x_cells) * size.num_y_cells);
  for (int row = 0; row != size.num_y_cells; ++row) {
    const auto begin =
        cells.begin() + ToFlatIndex({offset.x(), offset.y() + row});
    cropped.insert(cropped.end(), begin, begin + size.num_x_cells);
  }
  return cropped;
}

void Grid2D::FinishTexture(
    std::string cells, const transform::Rigid3d& local_pose,
    proto::SubmapQuery::Response::SubmapTexture* const texture) const {
  Eigen::Array2i offset;
  const MapLimits cropped = CroppedMapLimits(&offset);
  common::FastGzipString(cells, texture->mutable_cells());
  texture->set_width(cropped.cell_limits().num_x_cells);
  texture->set_height(cropped.cell_limits().num_y_cells);
  texture->set_resolution(cropped.resolution());
  const transform::Rigid3d corner = transform::Rigid3d::Translation(
      Eigen::Vector3d(cropped.max().x(), cropped.max().y(), 0.));
  *texture->mutable_slice_pose() =
      transform::ToProto(local_pose.inverse() * corner);
}

}  // namespace mapping
}  // namespace cartographer
