// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/scan_assembler.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer/sensor/internal/voxel_filter.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/front_end/dropin/sweep_returns.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::sensor::RangeData;
using cartographer::transform::Rigid3f;

Rigid3f ToRigid3f(const Pose2& pose) {
  return Rigid3f(
      Eigen::Vector3f(static_cast<float>(pose.x), static_cast<float>(pose.y),
                      0.f),
      Eigen::Quaternionf(Eigen::AngleAxisf(static_cast<float>(pose.theta),
                                           Eigen::Vector3f::UnitZ())));
}

}  // namespace

ScanAssembler::ScanAssembler(
    const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D&
        options,
    const WallFillingOptions& filling, const bool smooth_ranges)
    : options_(options),
      filling_(filling),
      smooth_ranges_(smooth_ranges),
      smoother_(0.5 *
                options.submaps_options().grid_options_2d().resolution()) {}

void ScanAssembler::Add(
    const cartographer::sensor::TimedPointCloudOriginData& sweep,
    const double interval, const Pose2& motion,
    const Eigen::Quaterniond& alignment) {
  if (num_sweeps_ == 0) accumulated_ = RangeData();
  ++num_sweeps_;
  const Rigid3f levelled = Rigid3f::Rotation(alignment.cast<float>());
  float offset = 0.f;
  Rigid3f pose = ToRigid3f(motion) * levelled;
  const std::vector<float> factors = SmoothingFactors(sweep);
  for (size_t i = 0; i < sweep.ranges.size(); ++i) {
    const auto& range = sweep.ranges[i];
    if (range.point_time.time != offset) {
      offset = range.point_time.time;
      const double ratio =
          interval > 0. ? std::max(0., (interval + offset) / interval) : 1.;
      pose = ToRigid3f(Interpolate(Pose2(), motion, ratio)) * levelled;
    }
    const Eigen::Vector3f origin = pose * sweep.origins.at(range.origin_index);
    cartographer::sensor::RangefinderPoint hit;
    hit.position = pose * range.point_time.position;
    const Eigen::Vector3f ray = hit.position - origin;
    const float length = ray.norm();
    // False for NaN.
    if (!(length >= options_.min_range())) continue;
    if (length <= options_.max_range()) {
      if (factors[i] != 1.f) hit.position = origin + factors[i] * ray;
      accumulated_.returns.push_back(hit);
    } else if (std::isfinite(length)) {
      // Only the first part of the ray is certainly free.
      hit.position = origin + options_.missing_data_ray_length() / length * ray;
      accumulated_.misses.push_back(hit);
    }
  }
  newest_motion_ = motion;
  // All rays of a scan have one origin: the laser if there is only one, else
  // the robot's origin.
  newest_origin_ = sweep.origins.size() == 1
                       ? (levelled * sweep.origins.front()).eval()
                       : Eigen::Vector3f::Zero().eval();
}

std::vector<float> ScanAssembler::SmoothingFactors(
    const cartographer::sensor::TimedPointCloudOriginData& sweep) {
  // The beams of several lasers are mixed by their stamps.
  if (!smooth_ranges_ || sweep.origins.size() != 1) {
    return std::vector<float>(sweep.ranges.size(), 1.f);
  }
  std::vector<Eigen::Vector2f> points = PlanarReturns(sweep);
  for (Eigen::Vector2f& point : points) {
    const float length = point.norm();
    if (!(length >= options_.min_range() && length <= options_.max_range())) {
      point.setZero();
    }
  }
  return smoother_.Smooth(points);
}

AssembledScan ScanAssembler::Take() {
  num_sweeps_ = 0;
  accumulated_.origin = ToRigid3f(newest_motion_) * newest_origin_;
  const RangeData cropped = cartographer::sensor::CropRangeData(
      cartographer::sensor::TransformRangeData(
          accumulated_, ToRigid3f(newest_motion_).inverse()),
      options_.min_z(), options_.max_z());
  AssembledScan scan;
  scan.range_data =
      RangeData{cropped.origin,
                cartographer::sensor::VoxelFilter(cropped.returns,
                                                  options_.voxel_filter_size()),
                cartographer::sensor::VoxelFilter(
                    cropped.misses, options_.voxel_filter_size())};
  std::vector<Eigen::Vector3f> returns;
  returns.reserve(cropped.returns.size());
  for (const auto& point : cropped.returns) returns.push_back(point.position);
  for (const Eigen::Vector3f& position : FillWalls(filling_, returns)) {
    scan.filling.push_back({position});
  }
  return scan;
}

}  // namespace front_end
}  // namespace cartographer_ext
