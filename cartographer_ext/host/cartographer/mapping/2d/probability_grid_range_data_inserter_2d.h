// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_2D_PROBABILITY_GRID_RANGE_DATA_INSERTER_2D_H_
#define CARTOGRAPHER_MAPPING_2D_PROBABILITY_GRID_RANGE_DATA_INSERTER_2D_H_

#include <vector>

#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/common/port.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/proto/probability_grid_range_data_inserter_options_2d.pb.h"
#include "cartographer/mapping/range_data_inserter_interface.h"
#include "cartographer/sensor/range_data.h"

namespace cartographer {
namespace mapping {

// Reads `hit_probability` (above 0.5), `miss_probability` (below 0.5) and the
// optional `insert_free_space`.
proto::ProbabilityGridRangeDataInserterOptions2D
CreateProbabilityGridRangeDataInserterOptions2D(
    common::LuaParameterDictionary* parameter_dictionary);

// Cells with a return become more occupied, cells the rays pass become freer.
// One insertion changes each cell once; where a cell has a return, that counts.
class ProbabilityGridRangeDataInserter2D : public RangeDataInserterInterface {
 public:
  explicit ProbabilityGridRangeDataInserter2D(
      const proto::ProbabilityGridRangeDataInserterOptions2D& options);
  ProbabilityGridRangeDataInserter2D(
      const ProbabilityGridRangeDataInserter2D&) = delete;
  ProbabilityGridRangeDataInserter2D& operator=(
      const ProbabilityGridRangeDataInserter2D&) = delete;

  // `grid` must be a ProbabilityGrid; it grows as needed. Points that are not
  // finite are skipped.
  void Insert(const sensor::RangeData& range_data,
              GridInterface* grid) const override;

 private:
  const proto::ProbabilityGridRangeDataInserterOptions2D options_;
  const std::vector<uint16> hit_table_;
  const std::vector<uint16> miss_table_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_2D_PROBABILITY_GRID_RANGE_DATA_INSERTER_2D_H_
