// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/probability_grid.h"

#include "absl/memory/memory.h"
#include "cartographer/mapping/probability_values.h"
#include "cartographer/mapping/submaps.h"

namespace cartographer {
namespace mapping {

ProbabilityGrid::ProbabilityGrid(const MapLimits& limits,
                                 ValueConversionTables* const conversion_tables)
    : Grid2D(limits, kMinCorrespondenceCost, kMaxCorrespondenceCost,
             conversion_tables),
      conversion_tables_(conversion_tables) {}

ProbabilityGrid::ProbabilityGrid(const proto::Grid2D& proto,
                                 ValueConversionTables* const conversion_tables)
    : Grid2D(proto, conversion_tables), conversion_tables_(conversion_tables) {
  CHECK(proto.has_probability_grid_2d());
}

void ProbabilityGrid::SetProbability(const Eigen::Array2i& cell_index,
                                     const float probability) {
  const int index = ToFlatIndex(cell_index);
  FlatCells& cells = *mutable_correspondence_cost_cells();
  CHECK_EQ(cells[index], kUnknownCorrespondenceValue) << "the cell is known";
  const float cost = ProbabilityToCorrespondenceCost(probability);
  cells[index] = CorrespondenceCostToValue(cost);
  mutable_known_cells_box()->extend(cell_index.matrix());
}

bool ProbabilityGrid::ApplyLookupTable(const Eigen::Array2i& cell_index,
                                       const std::vector<uint16>& table) {
  DCHECK_EQ(table.size(), kUpdateMarker);
  const size_t updates_before = update_indices().size();
  const Updater updater(this);
  updater.Apply(ToFlatIndex(cell_index), table.data());
  if (update_indices().size() == updates_before) return false;
  mutable_known_cells_box()->extend(cell_index.matrix());
  return true;
}

proto::Grid2D ProbabilityGrid::HeadToProto() const {
  proto::Grid2D result = Grid2D::HeadToProto();
  result.mutable_probability_grid_2d();
  return result;
}

std::unique_ptr<Grid2D> ProbabilityGrid::ComputeCroppedGrid() const {
  Eigen::Array2i offset;
  const MapLimits cropped_limits = CroppedMapLimits(&offset);
  auto cropped =
      absl::make_unique<ProbabilityGrid>(cropped_limits, conversion_tables_);
  *cropped->mutable_correspondence_cost_cells() =
      CropCells(correspondence_cost_cells());
  for (const Eigen::Array2i& xy_index :
       XYIndexRangeIterator(cropped_limits.cell_limits())) {
    if (cropped->IsKnown(xy_index)) {
      cropped->mutable_known_cells_box()->extend(xy_index.matrix());
    }
  }
  return cropped;
}

bool ProbabilityGrid::DrawToSubmapTexture(
    proto::SubmapQuery::Response::SubmapTexture* const texture,
    const transform::Rigid3d local_pose) const {
  DrawTexture(
      [this](const Eigen::Array2i& cell_index) {
        const float probability = CorrespondenceCostToProbability(
            ValueToCorrespondenceCost(CellValue(cell_index)));
        return 128 - ProbabilityToLogOddsInteger(probability);
      },
      local_pose, texture);
  return true;
}

}  // namespace mapping
}  // namespace cartographer
