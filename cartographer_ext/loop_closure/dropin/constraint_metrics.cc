// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"

#include <string>

#include "absl/strings/ascii.h"

namespace cartographer_ext {
namespace loop_closure {

using proto::LoopDecision;

ConstraintMetrics* ConstraintMetrics::Global() {
  static ConstraintMetrics* const metrics = new ConstraintMetrics;
  return metrics;
}

void ConstraintMetrics::Register(
    cartographer::metrics::FamilyFactory* const factory) {
  ConstraintMetrics* const metrics = Global();
  auto* const decisions =
      factory->NewCounterFamily("cartographer_ext_loop_decisions",
                                "Loop candidates by verdict and reason");
  const auto* const reasons = LoopDecision::Reason_descriptor();
  for (int i = 0; i < reasons->value_count(); ++i) {
    const int reason = reasons->value(i)->number();
    if (reason == LoopDecision::NONE) continue;
    const char* const verdict =
        reason < LoopDecision::LOW_GRID_SCORE      ? "accepted"
        : reason < LoopDecision::SKIPPED_REDUNDANT ? "rejected"
                                                   : "skipped";
    metrics->decisions_[reason] = decisions->Add(
        {{"verdict", verdict},
         {"reason", absl::AsciiStrToLower(reasons->value(i)->name())}});
  }
  auto* const searches = factory->NewCounterFamily(
      "cartographer_ext_loop_searches", "Searches for loops");
  metrics->searched_local =
      searches->Add({{"search_region", "local"}, {"matcher", "searched"}});
  metrics->searched_global =
      searches->Add({{"search_region", "global"}, {"matcher", "searched"}});
  metrics->found_local =
      searches->Add({{"search_region", "local"}, {"matcher", "found"}});
  metrics->found_global =
      searches->Add({{"search_region", "global"}, {"matcher", "found"}});
  auto* const cpu =
      factory->NewCounterFamily("cartographer_ext_loop_cpu_seconds",
                                "CPU seconds of the stages of loop closure");
  metrics->build_cpu = cpu->Add({{"stage", "build"}});
  metrics->search_cpu = cpu->Add({{"stage", "search"}});
  metrics->refinement_cpu = cpu->Add({{"stage", "refinement"}});
  metrics->verification_cpu = cpu->Add({{"stage", "verification"}});
  metrics->planning_cpu = cpu->Add({{"stage", "planning"}});
  auto* const scores = factory->NewHistogramFamily(
      "cartographer_ext_loop_scores", "Scores of the candidates found",
      cartographer::metrics::Histogram::FixedWidth(0.05, 20));
  metrics->grid_scores = scores->Add({{"score", "grid"}});
  metrics->temporal_scores = scores->Add({{"score", "temporal"}});
  metrics->final_scores = scores->Add({{"score", "final"}});
  metrics->undecided =
      factory
          ->NewGaugeFamily("cartographer_ext_loop_undecided",
                           "Loop candidates that wait for more evidence")
          ->Add({});
  metrics->num_matchers =
      factory
          ->NewGaugeFamily("cartographer_ext_loop_submap_matchers",
                           "Submaps that can be searched")
          ->Add({});
  metrics->cache_bytes =
      factory
          ->NewGaugeFamily("cartographer_ext_loop_cache_bytes",
                           "Search structures of submaps that are kept")
          ->Add({});
}

void ConstraintMetrics::CountDecision(const LoopDecision& decision) const {
  const auto it = decisions_.find(decision.reason());
  if (it != decisions_.end()) it->second->Increment();
  if (decision.has_temporal() &&
      decision.temporal().outcome() == LoopDecision::Temporal::SCORED) {
    temporal_scores->Observe(decision.temporal().score());
  }
  if (decision.has_fusion()) {
    final_scores->Observe(decision.fusion().final_score());
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
