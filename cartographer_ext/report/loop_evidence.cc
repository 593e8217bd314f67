// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/loop_evidence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace report {
namespace {

using evaluation::LoopPair;
using evaluation::LoopVerdict;

constexpr double kLargeResidual = 0.5;  // metres

}  // namespace

LoopPair PairOf(const proto::LoopDecision& decision) {
  return {{decision.submap_trajectory_id(), decision.submap_index()},
          {decision.node_trajectory_id(), decision.node_index()}};
}

bool LoopEvidence::suspicious() const {
  if (truth != LoopVerdict::kUnknown) return truth == LoopVerdict::kWrong;
  return in_graph && residual_translation > kLargeResidual;
}

double LoopEvidence::badness() const {
  return truth == LoopVerdict::kUnknown ? residual_translation
                                        : truth_translation;
}

std::vector<LoopEvidence> CollectEvidence(
    const ReportRun& run, const evaluation::MapContents& contents) {
  std::map<LoopPair, const proto::LoopDecision*> decisions;
  for (const proto::LoopDecision& decision : run.decisions()) {
    decisions[PairOf(decision)] = &decision;
  }
  std::vector<LoopEvidence> result;
  const std::vector<double> scores =
      evaluation::LoopScores(run.graph, contents);
  const auto& evaluation = run.evaluation;
  size_t position = 0;
  for (const evaluation::GraphConstraint& constraint : run.graph.constraints) {
    if (!constraint.is_loop) continue;
    LoopEvidence evidence;
    evidence.submap_id = constraint.submap_id;
    evidence.node_id = constraint.node_id;
    evidence.in_graph = true;
    evidence.relative_pose = constraint.relative_pose;
    evidence.score = scores[position];
    if (evaluation.loops.has_value() &&
        position < evaluation.loops->loops.size()) {
      const evaluation::LoopJudgement& judgement =
          evaluation.loops->loops[position];
      evidence.residual_translation = judgement.residual_translation;
      evidence.residual_rotation = judgement.residual_rotation;
      evidence.truth = judgement.verdict;
      evidence.truth_translation = judgement.translation_error;
    }
    if (evaluation.consistency.has_value() &&
        position < evaluation.consistency->cycles.partners.size()) {
      evidence.partners = evaluation.consistency->cycles.partners[position];
      evidence.open_share =
          evaluation.consistency->cycles.inconsistent_fraction[position];
    }
    const auto decision =
        decisions.find({evidence.submap_id, evidence.node_id});
    if (decision != decisions.end()) evidence.decision = decision->second;
    result.push_back(evidence);
    ++position;
  }
  for (const proto::LoopDecision& decision : run.decisions()) {
    if (decision.verdict() != proto::LoopDecision::REJECTED ||
        !decision.search().has_refined()) {
      continue;
    }
    LoopEvidence evidence;
    std::tie(evidence.submap_id, evidence.node_id) = PairOf(decision);
    evidence.accepted = false;
    evidence.relative_pose =
        Pose2(decision.search().refined().x(), decision.search().refined().y(),
              decision.search().refined().theta());
    evidence.score = decision.search().grid_score();
    evidence.decision = &decision;
    result.push_back(evidence);
  }
  return result;
}

std::string ReasonInWords(const proto::LoopDecision::Reason reason) {
  const std::string name = proto::LoopDecision::Reason_Name(reason);
  if (name.empty()) return absl::StrCat("reason ", static_cast<int>(reason));
  return absl::StrReplaceAll(absl::AsciiStrToLower(name), {{"_", " "}});
}

std::string VerdictInWords(const proto::LoopDecision& decision) {
  constexpr absl::string_view kSkipped = "skipped ";
  const std::string reason = ReasonInWords(decision.reason());
  if (absl::StartsWith(reason, kSkipped)) {
    return absl::StrCat("not searched: ", reason.substr(kSkipped.size()));
  }
  switch (decision.verdict()) {
    case proto::LoopDecision::ACCEPTED:
      return absl::StrCat("accepted: ", reason);
    case proto::LoopDecision::REJECTED:
      return absl::StrCat("rejected: ", reason);
    default:
      return "undecided at the end";
  }
}

std::string Describe(const LoopEvidence& evidence) {
  std::string text =
      absl::StrCat("submap ", evaluation::ToString(evidence.submap_id),
                   " - node ", evaluation::ToString(evidence.node_id));
  if (!evidence.accepted) absl::StrAppend(&text, ", rejected");
  if (evidence.score >= 0.) {
    absl::StrAppendFormat(&text, "\nscore on the grid %.3f", evidence.score);
  }
  if (evidence.in_graph) {
    absl::StrAppendFormat(&text, "\nresidual in the map %.2f m, %.1f deg",
                          evidence.residual_translation,
                          RadToDeg(evidence.residual_rotation));
    if (evidence.partners > 0) {
      absl::StrAppendFormat(&text, "\n%.0f %% of %d cycles are open",
                            100. * evidence.open_share, evidence.partners);
    }
  }
  if (evidence.truth != LoopVerdict::kUnknown) {
    absl::StrAppendFormat(
        &text, "\ntruth: %s, off by %.2f m",
        evidence.truth == LoopVerdict::kCorrect ? "right" : "wrong",
        evidence.truth_translation);
  }
  if (evidence.decision == nullptr) return text;
  const proto::LoopDecision& decision = *evidence.decision;
  if (decision.has_temporal()) {
    absl::StrAppendFormat(&text, "\ntemporal score %.3f, threshold %.3f",
                          decision.temporal().score(),
                          decision.temporal().threshold());
  }
  if (decision.has_fusion()) {
    absl::StrAppendFormat(&text, "\nfused score %.3f",
                          decision.fusion().final_score());
    if (decision.fusion().probability() > 0.) {
      absl::StrAppendFormat(&text, ", right with probability %.3f",
                            decision.fusion().probability());
    }
  }
  if (decision.has_innovation()) {
    absl::StrAppendFormat(&text, "\ninnovation %.1f of %.1f",
                          decision.innovation().chi_square(),
                          decision.innovation().bound());
  }
  if (decision.has_subset()) {
    absl::StrAppendFormat(&text, "\n%d revisits support, %d contradict",
                          decision.subset().support(),
                          decision.subset().contradictions());
  }
  absl::StrAppend(&text, "\n", VerdictInWords(decision));
  return text;
}

}  // namespace report
}  // namespace cartographer_ext
