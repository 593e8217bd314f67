// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// All evidence about each loop of a run.
#ifndef CARTOGRAPHER_EXT_REPORT_LOOP_EVIDENCE_H_
#define CARTOGRAPHER_EXT_REPORT_LOOP_EVIDENCE_H_

#include <string>
#include <vector>

#include "cartographer_ext/report/report_data.h"
#include "cartographer_ext/rerun/loop_outcome.h"

namespace cartographer_ext {
namespace report {

// Submap and node of a candidate.
evaluation::LoopPair PairOf(const proto::LoopDecision& decision);

// A loop of the graph, or a rejected candidate.
struct LoopEvidence {
  evaluation::GraphId submap_id, node_id;
  bool accepted = true;
  Pose2 relative_pose;  // (submap <- node), the loop's
  double score = -1.;   // on the grid; negative: unknown
  bool in_graph = false;
  // Against the optimised map.
  double residual_translation = 0.;  // metres
  double residual_rotation = 0.;     // radians
  // Cycles with nearby loops, and the share of open ones.
  int partners = 0;
  double open_share = 0.;
  evaluation::LoopVerdict truth = evaluation::LoopVerdict::kUnknown;
  double truth_translation = 0.;  // metres
  // Record of the decision, if any.
  const proto::LoopDecision* decision = nullptr;

  // Wrong by ground truth if known; otherwise more than half a metre off the
  // map.
  bool suspicious() const;
  // Sort key: error in metres.
  double badness() const;
};

// The loops in the order of the constraints, then the rejected candidates that
// have a pose, in the order of the records. Points into `run`.
std::vector<LoopEvidence> CollectEvidence(
    const ReportRun& run, const evaluation::MapContents& contents);

// Several lines, for a tooltip.
std::string Describe(const LoopEvidence& evidence);

// For example "low temporal score".
std::string ReasonInWords(proto::LoopDecision::Reason reason);

// "rejected: low temporal score", "not searched: budget", "undecided".
std::string VerdictInWords(const proto::LoopDecision& decision);

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_LOOP_EVIDENCE_H_
