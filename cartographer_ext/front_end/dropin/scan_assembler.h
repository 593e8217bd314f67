// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Assembles the range data of one match from one or more sweeps: smooths ranges
// whose noise is half a cell of the grid or more (range_smoother.h) where the
// options say so, corrects the motion distortion, separates returns and misses,
// aligns them with gravity, crops and filters them as the stock builder does.
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_SCAN_ASSEMBLER_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_SCAN_ASSEMBLER_H_

#include "Eigen/Geometry"
#include "cartographer/mapping/proto/local_trajectory_builder_options_2d.pb.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/point_cloud/range_smoother.h"
#include "cartographer_ext/front_end/point_cloud/wall_filling.h"

namespace cartographer_ext {
namespace front_end {

// The range data of one match in the gravity-aligned frame.
struct AssembledScan {
  cartographer::sensor::RangeData range_data;
  // Additional returns that complete walls, for the grid only.
  cartographer::sensor::PointCloud filling;
};

// Assembles scans, see above. Not thread-safe.
class ScanAssembler {
 public:
  ScanAssembler(
      const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D&
          options,
      const WallFillingOptions& filling, bool smooth_ranges);

  // Adds a sweep. Points are stamped relative to its end. `interval` is the
  // time since the last match (seconds, positive) and `motion` the motion since
  // then, (robot at the last match <- robot at the end of the sweep),
  // interpolated at the stamp of each point. `alignment` is (gravity aligned <-
  // tracking) now.
  void Add(const cartographer::sensor::TimedPointCloudOriginData& sweep,
           double interval, const Pose2& motion,
           const Eigen::Quaterniond& alignment);

  int num_sweeps() const { return num_sweeps_; }

  // All sweeps since the last call, in the gravity-aligned frame at the end of
  // the last one. Rays start at the laser, or at the robot's origin if there
  // are several lasers (in the stock builder always there).
  AssembledScan Take();

 private:
  // Of each range of the sweep, see RangeSmoother.
  std::vector<float> SmoothingFactors(
      const cartographer::sensor::TimedPointCloudOriginData& sweep);

  const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D options_;
  const WallFillingOptions filling_;
  const bool smooth_ranges_;
  RangeSmoother smoother_;  // down to half a cell of the grid
  int num_sweeps_ = 0;
  // In the gravity-aligned frame of the last match.
  cartographer::sensor::RangeData accumulated_;
  // In the gravity-aligned frame at the end of the newest sweep.
  Eigen::Vector3f newest_origin_ = Eigen::Vector3f::Zero();
  Pose2 newest_motion_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_SCAN_ASSEMBLER_H_
