// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Decision records beside a map: run.pbstream has run.loops.pb
// (length-delimited LoopDecision messages) and run.loops.csv (the same as a
// table).
#ifndef CARTOGRAPHER_EXT_SLAM_DECISION_FILES_H_
#define CARTOGRAPHER_EXT_SLAM_DECISION_FILES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/loop_closure/decision_counts.h"
#include "cartographer_ext/loop_closure/decision_records.h"
#include "cartographer_ext/loop_decision.pb.h"

namespace cartographer_ext {
namespace evaluation {

// Names of both files beside `pbstream_filename`.
std::string DecisionRecordsFilename(const std::string& pbstream_filename);
std::string DecisionCsvFilename(const std::string& pbstream_filename);

// Writes both files atomically; without records removes files of these names
// that an earlier run may have left.
absl::Status WriteDecisionsBeside(
    const std::string& pbstream_filename,
    const loop_closure::DecisionRecords& decisions);

// NotFound if there is no such file.
absl::StatusOr<std::vector<proto::LoopDecision>> ReadDecisions(
    const std::string& records_filename);

using DecisionCounts = loop_closure::DecisionCounts;

DecisionCounts CountDecisions(
    const std::vector<proto::LoopDecision>& decisions);
DecisionCounts CountDecisions(const loop_closure::DecisionRecords& decisions);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_DECISION_FILES_H_
