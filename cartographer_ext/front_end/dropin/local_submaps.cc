// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/local_submaps.h"

#include <cstddef>

#include "absl/memory/memory.h"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/2d/map_limits.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/2d/probability_grid_range_data_inserter_2d.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace front_end {
namespace {

namespace mapping = cartographer::mapping;
using cartographer::sensor::RangeData;

constexpr int kInitialCellsPerAxis = 100;
constexpr double kLeastOverlap = 0.1;

bool IsTsdf(const mapping::proto::SubmapsOptions2D& options) {
  return options.grid_options_2d().grid_type() ==
         mapping::proto::GridOptions2D::TSDF;
}

}  // namespace

LocalSubmaps::LocalSubmaps(const mapping::proto::SubmapsOptions2D& options)
    : options_(options),
      tsdfs_(IsTsdf(options)
                 ? absl::make_unique<mapping::ActiveSubmaps2D>(options)
                 : nullptr) {
  if (tsdfs_ != nullptr) return;
  CHECK_GT(options_.num_range_data(), 0);
  inserter_ = absl::make_unique<mapping::ProbabilityGridRangeDataInserter2D>(
      options_.range_data_inserter_options()
          .probability_grid_range_data_inserter_options_2d());
}

LocalSubmaps::~LocalSubmaps() = default;

LocalSubmaps::Submaps LocalSubmaps::All() const {
  return Submaps(submaps_.begin(), submaps_.end());
}

void LocalSubmaps::Begin(const Eigen::Vector2f& origin) {
  // A float, so that the cells are those of ActiveSubmaps2D.
  const float resolution = options_.grid_options_2d().resolution();
  const double half_size = 0.5 * kInitialCellsPerAxis * resolution;
  const Eigen::Vector2d max = origin.cast<double>().array() + half_size;
  submaps_.push_back(std::make_shared<mapping::Submap2D>(
      origin,
      absl::make_unique<mapping::ProbabilityGrid>(
          mapping::MapLimits(
              resolution, max,
              mapping::CellLimits(kInitialCellsPerAxis, kInitialCellsPerAxis)),
          &conversion_tables_),
      &conversion_tables_));
}

void LocalSubmaps::DropFinished() {
  if (submaps_.size() == 2 && submaps_.front()->insertion_finished()) {
    submaps_.erase(submaps_.begin());
  }
}

LocalSubmaps::Submaps LocalSubmaps::Leave(const RangeData& scan) {
  CHECK_EQ(submaps_.size(), 1u);
  submaps_.front()->Finish();
  Begin(scan.origin.head<2>());
  submaps_.back()->InsertRangeData(scan, inserter_.get());
  leaving_ = false;
  left_ = true;
  return All();
}

LocalSubmaps::Submaps LocalSubmaps::InsertElsewhere(const RangeData& scan) {
  if (tsdfs_ != nullptr || submaps_.empty()) return Insert(scan, 1);
  DropFinished();
  if (submaps_.size() == 1) return Leave(scan);
  submaps_.front()->Finish();
  leaving_ = true;
  return All();
}

LocalSubmaps::Submaps LocalSubmaps::Insert(const RangeData& scan,
                                           const int count) {
  const int most = options_.num_range_data();
  if (tsdfs_ != nullptr) {
    Submaps submaps = tsdfs_->InsertRangeData(scan);
    for (int i = 1; i < count && submaps.back()->num_range_data() < most; ++i) {
      submaps = tsdfs_->InsertRangeData(scan);
    }
    return submaps;
  }
  DropFinished();
  if (leaving_) return Leave(scan);
  // After a submap that was left both begin at once, otherwise the newer one
  // when the older one is half full.
  if (submaps_.empty() || left_ || submaps_.back()->num_range_data() == most) {
    Begin(scan.origin.head<2>());
  }
  left_ = false;
  for (int i = 0; i < count; ++i) {
    for (const auto& submap : submaps_) {
      submap->InsertRangeData(scan, inserter_.get());
    }
    if (submaps_.back()->num_range_data() == most) break;
  }
  if (submaps_.size() == 2 && submaps_.back()->num_range_data() == most) {
    submaps_.front()->Finish();
  }
  return All();
}

bool LocalSubmaps::Overlaps(const RangeData& scan) const {
  if (submaps_.empty() || scan.returns.empty()) return true;
  size_t num_known = 0;
  for (const auto& point : scan.returns) {
    for (const auto& submap : submaps_) {
      const mapping::Grid2D& grid = *submap->grid();
      if (grid.IsKnown(grid.limits().GetCellIndex(point.position.head<2>()))) {
        ++num_known;
        break;
      }
    }
  }
  return static_cast<double>(num_known) >=
         kLeastOverlap * static_cast<double>(scan.returns.size());
}

std::shared_ptr<const mapping::Submap2D> LocalSubmaps::Reference() const {
  if (tsdfs_ != nullptr) {
    const Submaps submaps = tsdfs_->submaps();
    return submaps.empty() ? nullptr : submaps.front();
  }
  if (submaps_.empty()) return nullptr;
  return left_ ? submaps_.back() : submaps_.front();
}

}  // namespace front_end
}  // namespace cartographer_ext
