// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Metrics of the loop closure, in addition to the stock ones:
//   cartographer_ext_loop_decisions{verdict=,reason=}     counter
//   cartographer_ext_loop_searches{matcher=,search_region=}  counter
//   cartographer_ext_loop_cpu_seconds{stage=}             counter
//   cartographer_ext_loop_scores{score=}                  histogram
//   cartographer_ext_loop_undecided, cartographer_ext_loop_submap_matchers,
//   cartographer_ext_loop_cache_bytes                     gauges
//
// They belong to the process, not to a pose graph, because Cartographer
// declares metrics in this way. Its RegisterMetrics is a static function,
// called once for all pose graphs and before the first of them is built.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_CONSTRAINT_METRICS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_CONSTRAINT_METRICS_H_

#include <map>

#include "cartographer/common/time.h"
#include "cartographer/metrics/counter.h"
#include "cartographer/metrics/family_factory.h"
#include "cartographer/metrics/gauge.h"
#include "cartographer/metrics/histogram.h"
#include "cartographer_ext/loop_decision.pb.h"

namespace cartographer_ext {
namespace loop_closure {

// Handles of the metrics above.
struct ConstraintMetrics {
  using Counter = cartographer::metrics::Counter;
  using Gauge = cartographer::metrics::Gauge;
  using Histogram = cartographer::metrics::Histogram;

  // The metrics of the process; without effect until `Register`.
  static ConstraintMetrics* Global();
  static void Register(cartographer::metrics::FamilyFactory* factory);

  void CountDecision(const proto::LoopDecision& decision) const;

  Counter* searched_local = Counter::Null();
  Counter* searched_global = Counter::Null();
  Counter* found_local = Counter::Null();
  Counter* found_global = Counter::Null();
  Counter* build_cpu = Counter::Null();
  Counter* search_cpu = Counter::Null();
  Counter* refinement_cpu = Counter::Null();
  Counter* verification_cpu = Counter::Null();
  Counter* planning_cpu = Counter::Null();
  Histogram* grid_scores = Histogram::Null();
  Histogram* temporal_scores = Histogram::Null();
  Histogram* final_scores = Histogram::Null();
  Gauge* undecided = Gauge::Null();
  Gauge* num_matchers = Gauge::Null();
  Gauge* cache_bytes = Gauge::Null();

 private:
  // By reason.
  std::map<int, Counter*> decisions_;
};

// Counts the CPU seconds of the thread during its lifetime.
class StageMeter {
 public:
  explicit StageMeter(ConstraintMetrics::Counter* const counter)
      : counter_(counter) {}
  ~StageMeter() { counter_->Increment(seconds()); }
  StageMeter(const StageMeter&) = delete;
  StageMeter& operator=(const StageMeter&) = delete;

  double seconds() const {
    return cartographer::common::GetThreadCpuTimeSeconds() - start_;
  }

 private:
  ConstraintMetrics::Counter* const counter_;
  const double start_ = cartographer::common::GetThreadCpuTimeSeconds();
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_CONSTRAINT_METRICS_H_
