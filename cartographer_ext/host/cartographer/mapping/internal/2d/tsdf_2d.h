// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_TSDF_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_TSDF_2D_H_

#include <memory>
#include <utility>
#include <vector>

#include "cartographer/common/port.h"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/2d/map_limits.h"
#include "cartographer/mapping/internal/2d/tsd_value_converter.h"

namespace cartographer {
namespace mapping {

// Truncated signed distances to the nearest surface, in metres, each with a
// weight. Its correspondence cost is the distance itself.
class TSDF2D : public Grid2D {
 public:
  TSDF2D(const MapLimits& limits, float truncation_distance, float max_weight,
         ValueConversionTables* conversion_tables);
  TSDF2D(const proto::Grid2D& proto, ValueConversionTables* conversion_tables);

  // Marks the cell as updated; does nothing when it is already.
  void SetCell(const Eigen::Array2i& cell_index, float tsd, float weight);
  bool CellIsUpdated(const Eigen::Array2i& cell_index) const;

  GridType GetGridType() const override { return GridType::TSDF; }

  // Unknown cells and those outside the grid have the lowest distance (whereas
  // their correspondence cost is the highest) and weight 0.
  float GetTSD(const Eigen::Array2i& cell_index) const;
  float GetWeight(const Eigen::Array2i& cell_index) const;
  std::pair<float, float> GetTSDAndWeight(
      const Eigen::Array2i& cell_index) const;

  void GrowLimits(const Eigen::Vector2f& point) override;
  proto::Grid2D ToProto() const override;
  std::unique_ptr<Grid2D> ComputeCroppedGrid() const override;
  bool DrawToSubmapTexture(proto::SubmapQuery::Response::SubmapTexture* texture,
                           transform::Rigid3d local_pose) const override;

 private:
  ValueConversionTables* conversion_tables_;
  TSDValueConverter value_converter_;
  FlatCells weight_cells_;  // same layout as the distances
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_TSDF_2D_H_
