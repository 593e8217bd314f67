// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/submap_2d.h"

#include <utility>

#include "absl/memory/memory.h"
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
  CHECK(grid_type != proto::GridOptions2D::TSDF)
      << "submaps.grid_options_2d.grid_type: TSDF submaps can be read from "
         "files but not built by this host; use PROBABILITY_GRID.";
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
    common::LuaParameterDictionary* const parameter_dictionary) {
  proto::SubmapsOptions2D options;
  options.set_num_range_data(
      parameter_dictionary->GetNonNegativeInt("num_range_data"));
  const auto grid_dictionary =
      parameter_dictionary->GetDictionary("grid_options_2d");
  *options.mutable_grid_options_2d() =
      CreateGridOptions2D(grid_dictionary.get());
  const auto inserter_dictionary =
      parameter_dictionary->GetDictionary("range_data_inserter");
  *options.mutable_range_data_inserter_options() =
      CreateRangeDataInserterOptions(inserter_dictionary.get());
  CheckCanBeBuilt(options);
  return options;
}

Submap2D::Submap2D(const Eigen::Vector2f& origin, std::unique_ptr<Grid2D> grid,
                   ValueConversionTables* const conversion_tables)
    : Submap(transform::Rigid3d::Translation(
          Eigen::Vector3d(origin.x(), origin.y(), 0.))),
      grid_(std::move(grid)),
      conversion_tables_(conversion_tables) {}

Submap2D::Submap2D(const proto::Submap2D& proto,
                   ValueConversionTables* const conversion_tables)
    : Submap(transform::ToRigid3(proto.local_pose())),
      conversion_tables_(conversion_tables) {
  if (proto.has_grid()) grid_ = GridFromProto(proto.grid(), conversion_tables_);
  set_num_range_data(proto.num_range_data());
  set_insertion_finished(proto.finished());
}

proto::Submap Submap2D::ToProto(const bool include_grid_data) const {
  proto::Submap result;
  proto::Submap2D* const submap = result.mutable_submap_2d();
  *submap->mutable_local_pose() = transform::ToProto(local_pose());
  submap->set_num_range_data(num_range_data());
  submap->set_finished(insertion_finished());
  if (include_grid_data) {
    CHECK(grid_ != nullptr);
    *submap->mutable_grid() = grid_->ToProto();
  }
  return result;
}

void Submap2D::UpdateFromProto(const proto::Submap& proto) {
  CHECK(proto.has_submap_2d());
  const proto::Submap2D& submap = proto.submap_2d();
  set_num_range_data(submap.num_range_data());
  set_insertion_finished(submap.finished());
  if (submap.has_grid()) {
    grid_ = GridFromProto(submap.grid(), conversion_tables_);
  }
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
  grid_ = grid_->ComputeCroppedGrid();
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
  const int num_range_data = options_.num_range_data();
  if (submaps_.empty() || submaps_.back()->num_range_data() == num_range_data) {
    AddSubmap(range_data.origin.head<2>());
  }
  for (const std::shared_ptr<Submap2D>& submap : submaps_) {
    submap->InsertRangeData(range_data, range_data_inserter_.get());
  }
  if (submaps_.front()->num_range_data() == 2 * num_range_data) {
    submaps_.front()->Finish();
  }
  return submaps();
}

void ActiveSubmaps2D::AddSubmap(const Eigen::Vector2f& origin) {
  if (submaps_.size() == 2) {
    CHECK(submaps_.front()->insertion_finished());
    submaps_.erase(submaps_.begin());
  }
  // As a float: files must hold the same resolution as the real thing's.
  const float resolution = options_.grid_options_2d().resolution();
  const double half_size = 0.5 * kInitialCellsPerAxis * resolution;
  const MapLimits limits(
      resolution, origin.cast<double>() + Eigen::Vector2d::Constant(half_size),
      CellLimits(kInitialCellsPerAxis, kInitialCellsPerAxis));
  submaps_.push_back(std::make_shared<Submap2D>(
      origin, absl::make_unique<ProbabilityGrid>(limits, &conversion_tables_),
      &conversion_tables_));
}

}  // namespace mapping
}  // namespace cartographer
