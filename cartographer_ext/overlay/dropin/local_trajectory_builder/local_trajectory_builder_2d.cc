// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/local_trajectory_builder_2d.h"

#include "absl/memory/memory.h"
#include "cartographer_ext/front_end/dropin/adaptive_local_trajectory_builder_2d.h"
#include "cartographer_ext/front_end_options.pb.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/overlay/signature.h"
#include "cartographer_ext/overlay/start_line.h"

#ifndef CARTOGRAPHER_EXT_OVERLAY_LOCAL_TRAJECTORY_BUILDER_2D_H_
#error \
    "The overlay of cartographer_ext is not first on the include path: another package puts Cartographer's sources before it."
#endif

namespace cartographer {
namespace mapping {
namespace {

using Stock = StockLocalTrajectoryBuilder2D;
using ::cartographer_ext::front_end::AdaptiveLocalTrajectoryBuilder2D;

CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    Stock::AddRangeData,
    std::unique_ptr<Stock::MatchingResult> (Stock::*)(
        const std::string&, const sensor::TimedPointCloudData&));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(Stock::AddImuData,
                                  void (Stock::*)(const sensor::ImuData&));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(Stock::AddOdometryData,
                                  void (Stock::*)(const sensor::OdometryData&));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(Stock::RegisterMetrics,
                                  void (*)(metrics::FamilyFactory*));

}  // namespace

LocalTrajectoryBuilder2D::LocalTrajectoryBuilder2D(
    const proto::LocalTrajectoryBuilderOptions2D& options,
    const std::vector<std::string>& expected_range_sensor_ids) {
  ::cartographer_ext::proto::FrontEndOptions extension;
  if (::cartographer_ext::options::GetExtension(options, &extension)) {
    ::cartographer_ext::LogStart("LocalTrajectoryBuilder2D",
                                 "TRAJECTORY_BUILDER_2D.cartographer_ext",
                                 extension);
    adaptive_ = absl::make_unique<AdaptiveLocalTrajectoryBuilder2D>(
        options, ::cartographer_ext::front_end::ToFrontEndOptions(extension),
        expected_range_sensor_ids);
  } else {
    stock_ = absl::make_unique<Stock>(options, expected_range_sensor_ids);
  }
}

LocalTrajectoryBuilder2D::~LocalTrajectoryBuilder2D() = default;

std::unique_ptr<LocalTrajectoryBuilder2D::MatchingResult>
LocalTrajectoryBuilder2D::AddRangeData(
    const std::string& sensor_id,
    const sensor::TimedPointCloudData& range_data) {
  return stock_ != nullptr ? stock_->AddRangeData(sensor_id, range_data)
                           : adaptive_->AddRangeData(sensor_id, range_data);
}

void LocalTrajectoryBuilder2D::AddImuData(const sensor::ImuData& imu_data) {
  if (stock_ != nullptr) {
    stock_->AddImuData(imu_data);
  } else {
    adaptive_->AddImuData(imu_data);
  }
}

void LocalTrajectoryBuilder2D::AddOdometryData(
    const sensor::OdometryData& odometry_data) {
  if (stock_ != nullptr) {
    stock_->AddOdometryData(odometry_data);
  } else {
    adaptive_->AddOdometryData(odometry_data);
  }
}

void LocalTrajectoryBuilder2D::RegisterMetrics(
    metrics::FamilyFactory* const family_factory) {
  Stock::RegisterMetrics(family_factory);
  AdaptiveLocalTrajectoryBuilder2D::RegisterMetrics(family_factory);
}

}  // namespace mapping
}  // namespace cartographer
