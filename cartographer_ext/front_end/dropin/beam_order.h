// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives the beams of sweeps without times their times, in the order that fits the
// map (beam_times.h).
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_BEAM_ORDER_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_BEAM_ORDER_H_

#include "Eigen/Geometry"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/proto/local_trajectory_builder_options_2d.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/dropin/scan_assembler.h"
#include "cartographer_ext/front_end/point_cloud/beam_times.h"
#include "cartographer_ext/scan_matching/dropin/degeneracy_aware_scan_matcher_2d.h"

namespace cartographer_ext {
namespace front_end {

// Learns sweep by sweep. Not thread-safe.
class BeamOrderLearner {
 public:
  // Not `enabled`: all beams stay as if measured at once.
  BeamOrderLearner(
      const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D&
          options,
      bool enabled);

  // Sets the times of the beams of a sweep of one laser in which all are the same.
  // `scan` is what it is made of: the points in the order of the beams. `interval`
  // as for ScanAssembler.
  void SetTimes(const cartographer::sensor::TimedPointCloudData& scan,
                double interval,
                cartographer::sensor::TimedPointCloudOriginData* sweep);

  // Compares the orders by the sweep of the last SetTimes(). `interval`, `motion`
  // and `alignment` as for ScanAssembler; `pose` is that of its match, (local <-
  // robot).
  void Learn(const cartographer::sensor::TimedPointCloudOriginData& sweep,
             double interval, const Pose2& motion,
             const Eigen::Quaterniond& alignment, const Pose2& pose,
             const cartographer::mapping::Submap2D& submap);

  BeamOrder order() const { return times_.order(); }

 private:
  // Log-likelihood of a sweep where it fits near `pose`.
  struct Fit {
    double mean = 0.;  // over its parts
    int num_parts = 0;
  };
  Fit FitNear(const Pose2& pose, const cartographer::sensor::PointCloud& cloud,
              const cartographer::mapping::Submap2D& submap) const;

  const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D options_;
  const bool enabled_;
  const scan_matching::DegeneracyAwareScanMatcher2D matcher_;
  BeamTimes times_;
  // The last sweep was one of a laser without times.
  bool is_untimed_ = false;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_BEAM_ORDER_H_
