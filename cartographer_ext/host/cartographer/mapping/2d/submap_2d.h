// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_2D_SUBMAP_2D_H_
#define CARTOGRAPHER_MAPPING_2D_SUBMAP_2D_H_

#include <memory>
#include <vector>

#include "Eigen/Core"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/2d/map_limits.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "cartographer/mapping/proto/submap_visualization.pb.h"
#include "cartographer/mapping/proto/submaps_options_2d.pb.h"
#include "cartographer/mapping/range_data_inserter_interface.h"
#include "cartographer/mapping/submaps.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {

// Reads `num_range_data`, `grid_options_2d` and `range_data_inserter`. This
// host reads TSDF submaps from files but does not build them: the grid type
// TSDF is fatal here.
proto::SubmapsOptions2D CreateSubmapsOptions2D(
    common::LuaParameterDictionary* parameter_dictionary);

class Submap2D : public Submap {
 public:
  // `origin` is the submap's place in the local frame, metres; the submap is
  // not rotated against it. The cells lie in the local frame, too.
  Submap2D(const Eigen::Vector2f& origin, std::unique_ptr<Grid2D> grid,
           ValueConversionTables* conversion_tables);
  Submap2D(const proto::Submap2D& proto,
           ValueConversionTables* conversion_tables);

  proto::Submap ToProto(bool include_grid_data) const override;
  void UpdateFromProto(const proto::Submap& proto) override;
  void ToResponseProto(const transform::Rigid3d& global_submap_pose,
                       proto::SubmapQuery::Response* response) const override;

  // Null when the submap was read without its grid.
  const Grid2D* grid() const { return grid_.get(); }

  // Only until Finish, which crops the grid to the known cells.
  void InsertRangeData(const sensor::RangeData& range_data,
                       const RangeDataInserterInterface* range_data_inserter);
  void Finish();

 private:
  void ReadState(const proto::Submap2D& proto);

  std::unique_ptr<Grid2D> grid_;
  ValueConversionTables* conversion_tables_;
};

// The one or two submaps that take range data: the older one, against which
// scans are matched, and a younger one that is still too empty for that. A
// submap gets a successor after `num_range_data` insertions, and is finished
// after twice as many; then the successor takes its place.
class ActiveSubmaps2D {
 public:
  explicit ActiveSubmaps2D(const proto::SubmapsOptions2D& options);
  ActiveSubmaps2D(const ActiveSubmaps2D&) = delete;
  ActiveSubmaps2D& operator=(const ActiveSubmaps2D&) = delete;

  // Inserts into the active submaps and returns them, older first. A submap
  // that has just been finished is still among them.
  std::vector<std::shared_ptr<const Submap2D>> InsertRangeData(
      const sensor::RangeData& range_data);

  std::vector<std::shared_ptr<const Submap2D>> submaps() const;

 private:
  // Starts a submap at `origin` when the newest is half full, in place of the
  // one that was finished then.
  void MakeRoom(const Eigen::Vector2f& origin);
  std::unique_ptr<Grid2D> EmptyGrid(const Eigen::Vector2f& center);

  const proto::SubmapsOptions2D options_;
  const std::unique_ptr<RangeDataInserterInterface> range_data_inserter_;
  ValueConversionTables conversion_tables_;
  std::vector<std::shared_ptr<Submap2D>> submaps_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_2D_SUBMAP_2D_H_
