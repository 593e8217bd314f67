// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/tsdf_2d.h"

#include <algorithm>
#include <cmath>

#include "absl/memory/memory.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

TSDF2D::TSDF2D(const MapLimits& limits, const float truncation_distance,
               const float max_weight,
               ValueConversionTables* const conversion_tables)
    : Grid2D(limits, -truncation_distance, truncation_distance,
             conversion_tables),
      conversion_tables_(conversion_tables),
      value_converter_(truncation_distance, max_weight, conversion_tables),
      weight_cells_(correspondence_cost_cells().size(),
                    TSDValueConverter::getUnknownWeightValue()) {}

TSDF2D::TSDF2D(const proto::Grid2D& proto,
               ValueConversionTables* const conversion_tables)
    : Grid2D(proto, conversion_tables),
      conversion_tables_(conversion_tables),
      value_converter_(proto.tsdf_2d().truncation_distance(),
                       proto.tsdf_2d().max_weight(), conversion_tables) {
  CHECK(proto.has_tsdf_2d());
  const auto& weights = proto.tsdf_2d().weight_cells();
  CHECK_EQ(static_cast<size_t>(weights.size()),
           correspondence_cost_cells().size());
  weight_cells_.resize(weights.size());
  std::transform(weights.begin(), weights.end(), weight_cells_.begin(),
                 [](const int cell) { return static_cast<uint16>(cell); });
}

void TSDF2D::SetCell(const Eigen::Array2i& cell_index, const float tsd,
                     const float weight) {
  const int flat_index = ToFlatIndex(cell_index);
  uint16& cell = (*mutable_correspondence_cost_cells())[flat_index];
  if (cell & kUpdateMarker) return;
  cell = kUpdateMarker | value_converter_.TSDToValue(tsd);
  weight_cells_[flat_index] = value_converter_.WeightToValue(weight);
  mutable_update_indices()->push_back(flat_index);
  mutable_known_cells_box()->extend(cell_index.matrix());
}

bool TSDF2D::CellIsUpdated(const Eigen::Array2i& cell_index) const {
  return correspondence_cost_cells()[ToFlatIndex(cell_index)] & kUpdateMarker;
}

float TSDF2D::GetTSD(const Eigen::Array2i& cell_index) const {
  return GetTSDAndWeight(cell_index).first;
}

float TSDF2D::GetWeight(const Eigen::Array2i& cell_index) const {
  return GetTSDAndWeight(cell_index).second;
}

std::pair<float, float> TSDF2D::GetTSDAndWeight(
    const Eigen::Array2i& cell_index) const {
  if (!limits().Contains(cell_index)) {
    return {value_converter_.getMinTSD(), value_converter_.getMinWeight()};
  }
  const int flat_index = ToFlatIndex(cell_index);
  return {value_converter_.ValueToTSD(correspondence_cost_cells()[flat_index]),
          value_converter_.ValueToWeight(weight_cells_[flat_index])};
}

void TSDF2D::GrowLimits(const Eigen::Vector2f& point) {
  Grid2D::GrowLimits(point,
                     {mutable_correspondence_cost_cells(), &weight_cells_},
                     {TSDValueConverter::getUnknownTSDValue(),
                      TSDValueConverter::getUnknownWeightValue()});
}

proto::Grid2D TSDF2D::ToProto() const {
  proto::Grid2D result = Grid2D::ToProto();
  proto::TSDF2D* const tsdf = result.mutable_tsdf_2d();
  tsdf->set_truncation_distance(value_converter_.getMaxTSD());
  tsdf->set_max_weight(value_converter_.getMaxWeight());
  tsdf->mutable_weight_cells()->Reserve(static_cast<int>(weight_cells_.size()));
  for (const uint16 cell : weight_cells_) tsdf->add_weight_cells(cell);
  return result;
}

std::unique_ptr<Grid2D> TSDF2D::ComputeCroppedGrid() const {
  Eigen::Array2i offset;
  const MapLimits cropped_limits = CroppedMapLimits(&offset);
  auto cropped = absl::make_unique<TSDF2D>(
      cropped_limits, value_converter_.getMaxTSD(),
      value_converter_.getMaxWeight(), conversion_tables_);
  for (const Eigen::Array2i& xy_index :
       XYIndexRangeIterator(cropped_limits.cell_limits())) {
    const Eigen::Array2i source = xy_index + offset;
    if (!IsKnown(source)) continue;
    cropped->SetCell(xy_index, GetTSD(source), GetWeight(source));
  }
  cropped->FinishUpdate();
  return cropped;
}

bool TSDF2D::DrawToSubmapTexture(
    proto::SubmapQuery::Response::SubmapTexture* const texture,
    const transform::Rigid3d local_pose) const {
  // Dark near surfaces, bright far from them, gray where little is known.
  DrawTexture(
      [this](const Eigen::Array2i& cell_index) {
        const int flat_index = ToFlatIndex(cell_index);
        const float distance = std::abs(value_converter_.ValueToTSD(
            correspondence_cost_cells()[flat_index]));
        const float certainty =
            value_converter_.ValueToWeight(weight_cells_[flat_index]) /
            value_converter_.getMaxWeight();
        const double farness =
            std::sqrt(distance / value_converter_.getMaxTSD());
        return static_cast<int>(
            std::round(certainty * (255. * farness - 128.)));
      },
      local_pose, texture);
  return true;
}

}  // namespace mapping
}  // namespace cartographer
