// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Metrics of local SLAM with our block, all below
// mapping_2d_adaptive_local_trajectory_builder_:
//   scans{odometry=ok|absent|stale|...}  counter
//   degenerate_scans                     counter
//   searches{outcome=kept|relocated}     counter
//   scores                               histogram, mean probability
//   time_offset                          gauge, seconds
//   odometry_scale                       gauge
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_FRONT_END_METRICS_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_FRONT_END_METRICS_H_

#include "cartographer/metrics/family_factory.h"
#include "cartographer_ext/match_record.pb.h"

namespace cartographer_ext {
namespace front_end {

// Must precede CountMatch(); not synchronized with it.
void RegisterFrontEndMetrics(
    cartographer::metrics::FamilyFactory* family_factory);

// Counts one matched scan.
void CountMatch(const proto::MatchRecord& record);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_FRONT_END_METRICS_H_
