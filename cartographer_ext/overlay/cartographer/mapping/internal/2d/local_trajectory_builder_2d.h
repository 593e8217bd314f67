// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Comes before Cartographer's header of the same path. The class found
// there becomes StockLocalTrajectoryBuilder2D; the class of the original name
// forwards to it, or, where the options have our block, to ours.
#pragma GCC system_header

#include "cartographer_ext/swaps.h"

#if !defined(CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER) || \
    defined(LocalTrajectoryBuilder2D)
// Not selected, or this is the stock source with its class renamed.
#include_next "cartographer/mapping/internal/2d/local_trajectory_builder_2d.h"
#else
#ifndef CARTOGRAPHER_EXT_OVERLAY_LOCAL_TRAJECTORY_BUILDER_2D_H_
#define CARTOGRAPHER_EXT_OVERLAY_LOCAL_TRAJECTORY_BUILDER_2D_H_

#define LocalTrajectoryBuilder2D StockLocalTrajectoryBuilder2D
#include_next "cartographer/mapping/internal/2d/local_trajectory_builder_2d.h"
#undef LocalTrajectoryBuilder2D

#include <memory>
#include <string>
#include <vector>

namespace cartographer_ext {
namespace front_end {
class AdaptiveLocalTrajectoryBuilder2D;
}  // namespace front_end
}  // namespace cartographer_ext

namespace cartographer {
namespace mapping {

// Exactly one of the two builders exists, chosen once by the options.
class LocalTrajectoryBuilder2D {
 public:
  using InsertionResult = StockLocalTrajectoryBuilder2D::InsertionResult;
  using MatchingResult = StockLocalTrajectoryBuilder2D::MatchingResult;

  explicit LocalTrajectoryBuilder2D(
      const proto::LocalTrajectoryBuilderOptions2D& options,
      const std::vector<std::string>& expected_range_sensor_ids);
  ~LocalTrajectoryBuilder2D();
  LocalTrajectoryBuilder2D(const LocalTrajectoryBuilder2D&) = delete;
  LocalTrajectoryBuilder2D& operator=(const LocalTrajectoryBuilder2D&) = delete;

  std::unique_ptr<MatchingResult> AddRangeData(
      const std::string& sensor_id,
      const sensor::TimedPointCloudData& range_data);
  void AddImuData(const sensor::ImuData& imu_data);
  void AddOdometryData(const sensor::OdometryData& odometry_data);

  // The stock families, and ours under names of their own.
  static void RegisterMetrics(metrics::FamilyFactory* family_factory);

 private:
  std::unique_ptr<StockLocalTrajectoryBuilder2D> stock_;
  std::unique_ptr<
      ::cartographer_ext::front_end::AdaptiveLocalTrajectoryBuilder2D>
      adaptive_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_EXT_OVERLAY_LOCAL_TRAJECTORY_BUILDER_2D_H_
#endif
