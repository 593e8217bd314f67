// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/submap_2d.h"

#include <algorithm>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/2d/probability_grid_range_data_inserter_2d.h"
#include "cartographer/mapping/internal/2d/tsdf_2d.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

constexpr int kInitialCellsPerAxis = 100;

std::unique_ptr<Grid2D> GridFromProto(const proto::Grid2D& proto,
                                      ValueConversionTables* const tables) {
  switch (proto.grid_case()) {
    case proto::Grid2D::kProbabilityGrid2D:
      return absl::make_unique<ProbabilityGrid>(proto, tables);
    case proto::Grid2D::kTsdf2D:
      return absl::make_unique<TSDF2D>(proto, tables);
    case proto::Grid2D::GRID_NOT_SET:
      break;
  }
  LOG(FATAL) << "the submap's grid is of no known type";
  return nullptr;
}

// Ends with a message that names the option when submaps of this kind cannot be
// built.
void CheckCanBeBuilt(const proto::SubmapsOptions2D& options) {
  const proto::GridOptions2D::GridType grid_type =
      options.grid_options_2d().grid_type();
  const auto inserter_type =
      options.range_data_inserter_options().range_data_inserter_type();
  if (grid_type == proto::GridOptions2D::TSDF) {
    LOG(FATAL) << "submaps.grid_options_2d.grid_type: TSDF submaps can be read "
                  "from files but not built by this host; use "
                  "PROBABILITY_GRID.";
  }
  CHECK(grid_type == proto::GridOptions2D::PROBABILITY_GRID &&
        inserter_type ==
            proto::RangeDataInserterOptions::PROBABILITY_GRID_INSERTER_2D)
      << "submaps: grid_type " << proto::GridOptions2D::GridType_Name(grid_type)
      << " does not go with range_data_inserter_type "
      << proto::RangeDataInserterOptions::RangeDataInserterType_Name(
             inserter_type);
  CHECK_GT(options.num_range_data(), 0);
}

}  // namespace

proto::SubmapsOptions2D CreateSubmapsOptions2D(
    common::LuaParameterDictionary* const table) {
  auto options = common::ReadOptions<proto::SubmapsOptions2D>(table);
  *options.mutable_grid_options_2d() =
      common::ReadTable(table, "grid_options_2d", &CreateGridOptions2D);
  *options.mutable_range_data_inserter_options() = common::ReadTable(
      table, "range_data_inserter", &CreateRangeDataInserterOptions);
  CheckCanBeBuilt(options);
  return options;
}

Submap2D::Submap2D(const Eigen::Vector2f& origin, std::unique_ptr<Grid2D> grid,
                   ValueConversionTables* const conversion_tables)
    : Submap(transform::Embed3D(
          transform::Rigid2d::Translation(origin.cast<double>()))),
      grid_(std::move(grid)),
      conversion_tables_(conversion_tables) {}

Submap2D::Submap2D(const proto::Submap2D& proto,
                   ValueConversionTables* const conversion_tables)
    : Submap(transform::ToRigid3(proto.local_pose())),
      conversion_tables_(conversion_tables) {
  ReadState(proto);
}

proto::Submap Submap2D::ToProto(const bool include_grid_data) const {
  CHECK(grid_ != nullptr || !include_grid_data);
  proto::Submap result;
  proto::Submap2D& proto = *result.mutable_submap_2d();
  if (include_grid_data) *proto.mutable_grid() = grid_->ToProto();
  proto.set_finished(insertion_finished());
  proto.set_num_range_data(num_range_data());
  *proto.mutable_local_pose() = transform::ToProto(local_pose());
  return result;
}

void Submap2D::UpdateFromProto(const proto::Submap& proto) {
  CHECK(proto.has_submap_2d());
  ReadState(proto.submap_2d());
}

// Sets everything but the pose, which does not change.
void Submap2D::ReadState(const proto::Submap2D& proto) {
  if (proto.has_grid()) {
    grid_ = GridFromProto(proto.grid(), conversion_tables_);
    if (proto.finished()) grid_->MakeCompact();
  }
  set_insertion_finished(proto.finished());
  set_num_range_data(proto.num_range_data());
}

void Submap2D::ToResponseProto(
    const transform::Rigid3d&,
    proto::SubmapQuery::Response* const response) const {
  if (grid_ == nullptr) return;
  response->set_submap_version(num_range_data());
  grid_->DrawToSubmapTexture(response->add_textures(), local_pose());
}

void Submap2D::InsertRangeData(
    const sensor::RangeData& range_data,
    const RangeDataInserterInterface* const range_data_inserter) {
  CHECK(grid_ != nullptr);
  CHECK(!insertion_finished());
  range_data_inserter->Insert(range_data, grid_.get());
  set_num_range_data(num_range_data() + 1);
}

void Submap2D::Finish() {
  CHECK(grid_ != nullptr);
  CHECK(!insertion_finished());
  std::unique_ptr<Grid2D> cropped = grid_->ComputeCroppedGrid();
  cropped->MakeCompact();
  grid_ = std::move(cropped);
  set_insertion_finished(true);
}

ActiveSubmaps2D::ActiveSubmaps2D(const proto::SubmapsOptions2D& options)
    : options_(options),
      range_data_inserter_(
          absl::make_unique<ProbabilityGridRangeDataInserter2D>(
              options.range_data_inserter_options()
                  .probability_grid_range_data_inserter_options_2d())) {
  CheckCanBeBuilt(options);
}

std::vector<std::shared_ptr<const Submap2D>> ActiveSubmaps2D::submaps() const {
  return {submaps_.begin(), submaps_.end()};
}

std::vector<std::shared_ptr<const Submap2D>> ActiveSubmaps2D::InsertRangeData(
    const sensor::RangeData& range_data) {
  MakeRoom(range_data.origin.head<2>());
  for (auto& submap : submaps_) {
    submap->InsertRangeData(range_data, range_data_inserter_.get());
  }
  Submap2D* const older = submaps_.front().get();
  const int capacity = 2 * options_.num_range_data();
  if (older->num_range_data() == capacity) {
    older->Finish();
  }
  return submaps();
}

// The successor is due at the moment the older submap is full, so one that is
// finished never meets another insertion.
void ActiveSubmaps2D::MakeRoom(const Eigen::Vector2f& origin) {
  const bool successor_is_due =
      submaps_.empty() ||
      submaps_.back()->num_range_data() == options_.num_range_data();
  if (!successor_is_due) {
    return;
  }
  const auto first_unfinished =
      std::find_if(submaps_.begin(), submaps_.end(),
                   [](const std::shared_ptr<Submap2D>& submap) {
                     return !submap->insertion_finished();
                   });
  submaps_.erase(submaps_.begin(), first_unfinished);
  CHECK_LT(submaps_.size(), 2);
  submaps_.push_back(std::make_shared<Submap2D>(origin, EmptyGrid(origin),
                                                &conversion_tables_));
}

std::unique_ptr<Grid2D> ActiveSubmaps2D::EmptyGrid(
    const Eigen::Vector2f& center) {
  // A float, so that files hold the same resolution as Cartographer's.
  const float resolution = options_.grid_options_2d().resolution();
  const double half_size = 0.5 * kInitialCellsPerAxis * resolution;
  const Eigen::Vector2d max = center.cast<double>().array() + half_size;
  return absl::make_unique<ProbabilityGrid>(
      MapLimits(resolution, max,
                CellLimits(kInitialCellsPerAxis, kInitialCellsPerAxis)),
      &conversion_tables_);
}

}  // namespace mapping
}  // namespace cartographer
