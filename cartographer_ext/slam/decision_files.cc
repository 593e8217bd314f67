// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/decision_files.h"

#include "cartographer_ext/loop_closure/decision_log.h"
#include "cartographer_ext/slam/side_files.h"

namespace cartographer_ext {
namespace evaluation {

using proto::LoopDecision;

std::string DecisionRecordsFilename(const std::string& pbstream_filename) {
  return SideFilename(pbstream_filename, ".loops.pb");
}

std::string DecisionCsvFilename(const std::string& pbstream_filename) {
  return SideFilename(pbstream_filename, ".loops.csv");
}

absl::Status WriteDecisionsBeside(
    const std::string& pbstream_filename,
    const loop_closure::DecisionRecords& decisions) {
  SideFileWriter files(DecisionRecordsFilename(pbstream_filename),
                       DecisionCsvFilename(pbstream_filename));
  if (!decisions.empty()) files.Add("", loop_closure::DecisionCsvHead());
  decisions.ForEach([&files](const LoopDecision& decision) {
    std::string bytes;
    loop_closure::AppendDecision(decision, &bytes);
    files.Add(bytes, loop_closure::DecisionCsvRow(decision));
  });
  return files.Finish();
}

absl::StatusOr<std::vector<LoopDecision>> ReadDecisions(
    const std::string& records_filename) {
  return ReadTimedSideFile<LoopDecision>(
      records_filename, "decision", loop_closure::ParseDecisions,
      [](const LoopDecision& record) { return record.node_time(); });
}

DecisionCounts CountDecisions(const std::vector<LoopDecision>& decisions) {
  DecisionCounts counts;
  for (const LoopDecision& decision : decisions) counts.Add(decision);
  return counts;
}

DecisionCounts CountDecisions(const loop_closure::DecisionRecords& decisions) {
  DecisionCounts counts;
  decisions.ForEach(
      [&counts](const LoopDecision& decision) { counts.Add(decision); });
  return counts;
}

}  // namespace evaluation
}  // namespace cartographer_ext
