// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/front_end_metrics.h"

#include <array>
#include <string>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "cartographer/metrics/counter.h"
#include "cartographer/metrics/gauge.h"
#include "cartographer/metrics/histogram.h"

namespace cartographer_ext {
namespace front_end {
namespace {

namespace metrics = cartographer::metrics;
using proto::MatchRecord;

constexpr char kPrefix[] = "mapping_2d_adaptive_local_trajectory_builder_";
constexpr int kNumStates = MatchRecord::OdometryState_MAX + 1;

struct Handles {
  std::array<metrics::Counter*, kNumStates> scans;
  metrics::Counter* degenerate = metrics::Counter::Null();
  metrics::Counter* kept = metrics::Counter::Null();
  metrics::Counter* relocated = metrics::Counter::Null();
  metrics::Histogram* scores = metrics::Histogram::Null();
  metrics::Gauge* time_offset = metrics::Gauge::Null();
  metrics::Gauge* odometry_scale = metrics::Gauge::Null();

  Handles() { scans.fill(metrics::Counter::Null()); }
};

Handles* GetHandles() {
  static auto* const handles = new Handles;
  return handles;
}

}  // namespace

void RegisterFrontEndMetrics(metrics::FamilyFactory* const family_factory) {
  Handles* const handles = GetHandles();
  auto* const scans = family_factory->NewCounterFamily(
      absl::StrCat(kPrefix, "scans"), "Scans by what was found of odometry");
  for (int i = 0; i < kNumStates; ++i) {
    handles->scans[i] = scans->Add(
        {{"odometry", absl::AsciiStrToLower(MatchRecord::OdometryState_Name(
                          static_cast<MatchRecord::OdometryState>(i)))}});
  }
  handles->degenerate =
      family_factory
          ->NewCounterFamily(absl::StrCat(kPrefix, "degenerate_scans"),
                             "Scans that do not determine the whole pose")
          ->Add({});
  auto* const searches = family_factory->NewCounterFamily(
      absl::StrCat(kPrefix, "searches"),
      "Correlative searches around doubtful predictions");
  handles->kept = searches->Add({{"outcome", "kept"}});
  handles->relocated = searches->Add({{"outcome", "relocated"}});
  handles->scores =
      family_factory
          ->NewHistogramFamily(absl::StrCat(kPrefix, "scores"),
                               "Mean probability under the points of a scan",
                               metrics::Histogram::FixedWidth(0.05, 20))
          ->Add({});
  handles->time_offset =
      family_factory
          ->NewGaugeFamily(absl::StrCat(kPrefix, "time_offset"),
                           "Seconds from odometry to scan stamps")
          ->Add({});
  handles->odometry_scale =
      family_factory
          ->NewGaugeFamily(absl::StrCat(kPrefix, "odometry_scale"),
                           "Estimated scale of odometry translation")
          ->Add({});
}

void CountMatch(const MatchRecord& record) {
  Handles* const handles = GetHandles();
  if (MatchRecord::OdometryState_IsValid(record.odometry())) {
    handles->scans[record.odometry()]->Increment();
  }
  if (record.degeneracy() != MatchRecord::NONE) {
    handles->degenerate->Increment();
  }
  if (record.searched()) {
    (record.source() == MatchRecord::SEARCH ? handles->relocated
                                            : handles->kept)
        ->Increment();
  }
  handles->scores->Observe(record.score());
  handles->time_offset->Set(record.time_offset());
  handles->odometry_scale->Set(record.odometry_scale());
}

}  // namespace front_end
}  // namespace cartographer_ext
