// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/beam_order.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cartographer/sensor/internal/voxel_filter.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/front_end/dropin/sweep_returns.h"
#include "cartographer_ext/options/option_description.h"
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::sensor::TimedPointCloudOriginData;

// Fewer beams are hardly a scan.
constexpr size_t kMinBeams = 10;
// Fewer scans in the map repeat the distortion of the first one.
constexpr int kMinScansInMap = 5;

// Of a pose that is known only roughly, metres and radians.
constexpr double kNearSigma = 0.1;

proto::ScanMatcherOptions Defaults() {
  proto::ScanMatcherOptions defaults;
  options::SetDefaults(&defaults);
  return defaults;
}

const char* ToText(const BeamOrder order) {
  if (order == BeamOrder::kAtOnce) return "if measured at once";
  return order == BeamOrder::kCounterclockwise
             ? "if the laser turns counterclockwise once a scan"
             : "if the laser turns clockwise once a scan";
}

bool HasTimes(const TimedPointCloudOriginData& sweep) {
  const float first = sweep.ranges.front().point_time.time;
  return std::any_of(
      sweep.ranges.begin(), sweep.ranges.end(),
      [first](const auto& range) { return range.point_time.time != first; });
}

void Stamp(const BeamTimes& beam_times, const BeamOrder order,
           TimedPointCloudOriginData* const sweep) {
  const std::vector<float> times =
      beam_times.Times(order, PlanarReturns(*sweep));
  for (size_t i = 0; i < times.size(); ++i) {
    sweep->ranges[i].point_time.time = times[i];
  }
}

}  // namespace

BeamOrderLearner::BeamOrderLearner(
    const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D&
        options,
    const bool enabled)
    : options_(options),
      enabled_(enabled),
      matcher_(options.ceres_scan_matcher_options(), Defaults()) {}

void BeamOrderLearner::SetTimes(
    const cartographer::sensor::TimedPointCloudData& scan,
    const double interval, TimedPointCloudOriginData* const sweep) {
  is_untimed_ = enabled_ && options_.num_accumulated_range_data() <= 1 &&
                sweep->origins.size() == 1 &&
                sweep->ranges.size() >= kMinBeams && !HasTimes(*sweep);
  if (!is_untimed_) return;
  times_.AddScan(PlanarReturns(scan), interval);
  if (order() != BeamOrder::kAtOnce) Stamp(times_, order(), sweep);
}

BeamOrderLearner::Fit BeamOrderLearner::FitNear(
    const Pose2& pose, const cartographer::sensor::PointCloud& cloud,
    const cartographer::mapping::Submap2D& submap) const {
  scan_matching::Prediction near;
  near.pose = pose;
  near.covariance = Squared(kNearSigma) * Eigen::Matrix3d::Identity();
  near.scans_in_map = submap.num_range_data();
  cartographer::transform::Rigid2d matched = ToRigid2d(pose);
  matcher_.MatchWithPrediction(near, matched, cloud, *submap.grid(), &matched,
                               nullptr);
  Fit fit;
  fit.num_parts = std::max(1, scan_matching::NumPatches(cloud));
  fit.mean =
      scan_matching::PoseEvidence(ToPose2(matched), cloud, *submap.grid(),
                                  scan_matching::PosePrecision::kExact)
          .log_likelihood() /
      fit.num_parts;
  return fit;
}

void BeamOrderLearner::Learn(const TimedPointCloudOriginData& sweep,
                             const double interval, const Pose2& motion,
                             const Eigen::Quaterniond& alignment,
                             const Pose2& pose,
                             const cartographer::mapping::Submap2D& submap) {
  if (!is_untimed_ || submap.num_range_data() < kMinScansInMap) return;
  const std::vector<BeamOrder> candidates = times_.Candidates(motion.theta);
  if (candidates.empty()) return;
  const auto fit = [&](const BeamOrder order) {
    TimedPointCloudOriginData stamped = sweep;
    Stamp(times_, order, &stamped);
    ScanAssembler assembler(options_, WallFillingOptions(), false);
    // The map has the translation of the order in force in it.
    assembler.Add(stamped, interval, Pose2(0., 0., motion.theta), alignment);
    return FitNear(pose,
                   cartographer::sensor::AdaptiveVoxelFilter(
                       assembler.Take().range_data.returns,
                       options_.adaptive_voxel_filter_options()),
                   submap);
  };
  const BeamOrder before = order();
  const Fit now = fit(before);
  for (const BeamOrder candidate : candidates) {
    const Fit other = fit(candidate);
    times_.AddEvidence(candidate, 0.5 * (now.num_parts + other.num_parts) *
                                      (other.mean - now.mean));
  }
  LOG_IF(INFO, order() != before)
      << "cartographer_ext: scans without times of beams fit the map better "
      << ToText(order()) << ", as they are taken from now on";
}

}  // namespace front_end
}  // namespace cartographer_ext
