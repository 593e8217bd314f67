// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The submaps that scans are inserted into: two that overlap by half, as in
// Cartographer's ActiveSubmaps2D, with one addition.
//
// A submap is full after a number of scans, however far apart they are. A laser
// of short range sees nothing for hundreds of metres outdoors or in a hall, and
// its next scans would still belong to the submap from before: a grid of
// hundreds of metres that is bent by all the drift in between, in which nothing
// is found and which takes gigabytes. So a scan that lies elsewhere ends both
// submaps, and new ones begin.
//
// The pose graph wants each submap to be the older one of a node, and to be
// finished by a node, before the next one but one begins. So the first scan
// elsewhere only finishes the older submap, without being inserted, if there are
// two; the next one finishes the newer submap and begins a new one.
//
// TSDF submaps are those of ActiveSubmaps2D, without the addition.
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_SUBMAPS_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_SUBMAPS_H_

#include <memory>
#include <vector>

#include "Eigen/Core"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/proto/submaps_options_2d.pb.h"
#include "cartographer/mapping/range_data_inserter_interface.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "cartographer/sensor/range_data.h"

namespace cartographer_ext {
namespace front_end {

// See above. Not thread-safe.
class LocalSubmaps {
 public:
  using Submaps =
      std::vector<std::shared_ptr<const cartographer::mapping::Submap2D>>;

  explicit LocalSubmaps(
      const cartographer::mapping::proto::SubmapsOptions2D& options);
  ~LocalSubmaps();
  LocalSubmaps(const LocalSubmaps&) = delete;
  LocalSubmaps& operator=(const LocalSubmaps&) = delete;

  // Inserts a scan (in the local frame, metres) `count` >= 1 times, but not
  // beyond a full submap: the scan belongs to those it was inserted into first,
  // and the host looks there for what is finished. Returns the one or two
  // submaps that the node of this scan belongs to, older first.
  Submaps Insert(const cartographer::sensor::RangeData& scan, int count);
  // The same for a scan that lies elsewhere.
  Submaps InsertElsewhere(const cartographer::sensor::RangeData& scan);

  // Whether a tenth of the returns, or more, lies in known cells. True without
  // submaps and without returns, and for TSDFs.
  bool Overlaps(const cartographer::sensor::RangeData& scan) const;
  // To match the next scan against: the older submap, unless that was left.
  // Null before the first insertion.
  std::shared_ptr<const cartographer::mapping::Submap2D> Reference() const;

 private:
  Submaps All() const;
  void Begin(const Eigen::Vector2f& origin);
  void DropFinished();
  // Finishes the only submap, and begins another with this scan.
  Submaps Leave(const cartographer::sensor::RangeData& scan);

  const cartographer::mapping::proto::SubmapsOptions2D options_;
  // Only for TSDFs; all others are not used then.
  const std::unique_ptr<cartographer::mapping::ActiveSubmaps2D> tsdfs_;
  std::unique_ptr<cartographer::mapping::RangeDataInserterInterface> inserter_;
  cartographer::mapping::ValueConversionTables conversion_tables_;
  std::vector<std::shared_ptr<cartographer::mapping::Submap2D>> submaps_;
  // The older submap is finished, the newer one must be by the next scan.
  bool leaving_ = false;
  // The older submap is elsewhere.
  bool left_ = false;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_SUBMAPS_H_
