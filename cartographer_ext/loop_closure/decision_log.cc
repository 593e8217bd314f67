// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_log.h"

#include <cstdint>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/common/delimited_messages.h"
#include "cartographer_ext/common/host_ticks.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;

constexpr char kHead[] =
    "candidate,submap_trajectory,submap,node_trajectory,node,node_time,verdict,"
    "reason,full_submap,linear_window,angular_window,grid_score,prior_"
    "translation_"
    "sigma,prior_rotation_sigma,predicted_x,predicted_y,predicted_theta,"
    "refined_x,"
    "refined_y,refined_theta,temporal_outcome,temporal_score,window,num_query,"
    "num_reference,travelled,threshold,score_variance,lambda,final_score,"
    "probability,false_weight,false_mean_grid,false_mean_temporal,true_weight,"
    "true_mean_grid,true_mean_temporal,innovation_x,innovation_y,"
    "innovation_theta,innovation_chi_square,innovation_bound,closed_sigma,"
    "neighbours_found,neighbours_missed,support,contradictions,subset_size,num_"
    "tests,exact,translation_weight,"
    "rotation_weight,search_seconds,temporal_seconds,fusion_seconds,"
    "refinement_seconds,subset_seconds\n";

// Collects the cells of a line; a stage that did not run leaves its cells
// empty.
class Line {
 public:
  void Begin(const bool present) { present_ = present; }
  void Number(const double value) { Text(absl::StrFormat("%.9g", value)); }
  void Integer(const int64_t value) { Text(absl::StrCat(value)); }
  void Text(const std::string& text) {
    cells_.push_back(present_ ? text : std::string());
  }
  std::string Join() const {
    return absl::StrCat(absl::StrJoin(cells_, ","), "\n");
  }

 private:
  bool present_ = true;
  std::vector<std::string> cells_;
};

// Also for values that a newer version may have written.
std::string EnumText(const std::string& name, const int value) {
  return name.empty() ? absl::StrCat(value) : absl::AsciiStrToLower(name);
}

void AddFusion(const LoopDecision& decision, Line* const line) {
  const auto& fusion = decision.fusion();
  line->Begin(decision.has_fusion());
  line->Number(fusion.lambda());
  line->Number(fusion.final_score());
  line->Begin(fusion.probability() > 0.);
  line->Number(fusion.probability());
  for (const auto* const component :
       {&fusion.false_loops(), &fusion.true_loops()}) {
    line->Begin(fusion.has_true_loops());
    line->Number(component->weight());
    line->Number(component->mean_grid());
    line->Number(component->mean_temporal());
  }
}

}  // namespace

void AppendDecision(const LoopDecision& decision, std::string* const bytes) {
  AppendDelimited(decision, bytes);
}

absl::StatusOr<std::vector<LoopDecision>> ParseDecisions(
    const absl::string_view bytes) {
  return ParseDelimited<LoopDecision>(bytes, "decision record");
}

absl::string_view DecisionCsvHead() { return kHead; }

std::string DecisionCsvRow(const LoopDecision& decision) {
  Line line;
  line.Integer(decision.candidate());
  line.Integer(decision.submap_trajectory_id());
  line.Integer(decision.submap_index());
  line.Integer(decision.node_trajectory_id());
  line.Integer(decision.node_index());
  line.Text(UnixSecondsOfTicks(decision.node_time()));
  line.Text(EnumText(LoopDecision::Verdict_Name(decision.verdict()),
                     decision.verdict()));
  line.Text(EnumText(LoopDecision::Reason_Name(decision.reason()),
                     decision.reason()));
  const auto& search = decision.search();
  line.Begin(decision.has_search());
  line.Integer(search.full_submap());
  line.Number(search.linear_window());
  line.Number(search.angular_window());
  line.Number(search.grid_score());
  line.Number(search.prior_translation_sigma());
  line.Number(search.prior_rotation_sigma());
  line.Begin(search.has_predicted());
  line.Number(search.predicted().x());
  line.Number(search.predicted().y());
  line.Number(search.predicted().theta());
  line.Begin(search.has_refined());
  line.Number(search.refined().x());
  line.Number(search.refined().y());
  line.Number(search.refined().theta());
  const auto& temporal = decision.temporal();
  line.Begin(decision.has_temporal());
  line.Text(EnumText(LoopDecision::Temporal::Outcome_Name(temporal.outcome()),
                     temporal.outcome()));
  line.Begin(decision.has_temporal() &&
             temporal.outcome() == LoopDecision::Temporal::SCORED);
  line.Number(temporal.score());
  line.Begin(decision.has_temporal());
  line.Integer(temporal.window());
  line.Integer(temporal.num_query());
  line.Integer(temporal.num_reference());
  line.Number(temporal.travelled());
  line.Number(temporal.threshold());
  line.Number(temporal.score_variance());
  AddFusion(decision, &line);
  const auto& innovation = decision.innovation();
  line.Begin(decision.has_innovation());
  line.Number(innovation.pose().x());
  line.Number(innovation.pose().y());
  line.Number(innovation.pose().theta());
  line.Number(innovation.chi_square());
  line.Number(innovation.bound());
  line.Begin(innovation.closed_sigma() > 0.);
  line.Number(innovation.closed_sigma());
  line.Begin(decision.has_neighbours());
  line.Integer(decision.neighbours().num_found());
  line.Integer(decision.neighbours().num_missed());
  const auto& subset = decision.subset();
  line.Begin(decision.has_subset());
  line.Integer(subset.support());
  line.Integer(subset.contradictions());
  line.Integer(subset.subset_size());
  line.Integer(subset.num_tests());
  line.Integer(subset.exact());
  line.Begin(decision.has_information());
  line.Number(decision.information().translation_weight());
  line.Number(decision.information().rotation_weight());
  const auto& times = decision.times();
  line.Begin(decision.has_times());
  line.Number(times.search_seconds());
  line.Number(times.temporal_seconds());
  line.Number(times.fusion_seconds());
  line.Number(times.refinement_seconds());
  line.Number(times.subset_seconds());
  return line.Join();
}

std::string DecisionCsvRows(const std::vector<LoopDecision>& decisions) {
  std::string rows;
  for (const LoopDecision& decision : decisions) {
    absl::StrAppend(&rows, DecisionCsvRow(decision));
  }
  return rows;
}

std::string DecisionCsv(const std::vector<LoopDecision>& decisions) {
  return absl::StrCat(DecisionCsvHead(), DecisionCsvRows(decisions));
}

}  // namespace loop_closure
}  // namespace cartographer_ext
