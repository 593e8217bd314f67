// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_2D_PROBABILITY_GRID_H_
#define CARTOGRAPHER_MAPPING_2D_PROBABILITY_GRID_H_

#include <memory>
#include <vector>

#include "cartographer/common/port.h"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/2d/map_limits.h"

namespace cartographer {
namespace mapping {

// Occupancy probabilities in [0.1, 0.9].
class ProbabilityGrid : public Grid2D {
 public:
  ProbabilityGrid(const MapLimits& limits,
                  ValueConversionTables* conversion_tables);
  ProbabilityGrid(const proto::Grid2D& proto,
                  ValueConversionTables* conversion_tables);

  // The cell must be unknown.
  void SetProbability(const Eigen::Array2i& cell_index, float probability);

  // Replaces the cell's value by its entry in `table` (see
  // ComputeLookupTableToApplyCorrespondenceCostOdds) and marks it. A marked
  // cell is left alone, and false returned.
  bool ApplyLookupTable(const Eigen::Array2i& cell_index,
                        const std::vector<uint16>& table);

  GridType GetGridType() const override { return GridType::PROBABILITY_GRID; }

  // Unknown cells and those outside the grid have the lowest probability.
  float GetProbability(const Eigen::Array2i& cell_index) const {
    if (!limits().Contains(cell_index)) return kMinProbability;
    return CorrespondenceCostToProbability(
        ValueToCorrespondenceCost(CellValue(cell_index)));
  }

  proto::Grid2D HeadToProto() const override;
  std::unique_ptr<Grid2D> ComputeCroppedGrid() const override;
  void MakeCompact() override { MakeCostCellsCompact(); }
  bool DrawToSubmapTexture(proto::SubmapQuery::Response::SubmapTexture* texture,
                           transform::Rigid3d local_pose) const override;

  // Not part of Cartographer's interface: unchecked access for inserters. Every
  // cell changed through an updater must lie inside the grid and be inside a
  // box given to ExtendKnownCells.
  class Updater {
   public:
    explicit Updater(ProbabilityGrid* grid)
        : grid_(grid),
          cells_(grid->mutable_correspondence_cost_cells()->data()),
          stride_(grid->limits().cell_limits().num_x_cells),
          updated_(grid->mutable_update_indices()) {}

    int stride() const { return stride_; }
    // `table` has 32768 entries.
    void Apply(const int flat_index, const uint16* const table) const {
      uint16& cell = cells_[flat_index];
      if (cell & kUpdateMarker) return;
      cell = table[cell];
      updated_->push_back(flat_index);
    }
    void ExtendKnownCells(const Eigen::AlignedBox2i& box) const {
      grid_->mutable_known_cells_box()->extend(box);
    }

   private:
    ProbabilityGrid* grid_;
    uint16* cells_;
    int stride_;
    std::vector<int>* updated_;
  };

 private:
  ValueConversionTables* conversion_tables_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_2D_PROBABILITY_GRID_H_
