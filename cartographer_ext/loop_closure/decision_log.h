// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Decision records as bytes and as a table. The bytes are a sequence of
// length-delimited messages (a varint length, then the message), which any
// protobuf library can read; the table is CSV with a header line, one candidate
// per line, and empty cells for stages that did not run. docs/side_files.md has
// the columns; times are Unix seconds.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_LOG_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_LOG_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/loop_decision.pb.h"

namespace cartographer_ext {
namespace loop_closure {

// Appends one record.
void AppendDecision(const proto::LoopDecision& decision, std::string* bytes);

// Parses all records; DataLoss with the byte offset if they are truncated or
// cannot be decoded.
absl::StatusOr<std::vector<proto::LoopDecision>> ParseDecisions(
    absl::string_view bytes);

// The header line of the table, and the others.
absl::string_view DecisionCsvHead();
std::string DecisionCsvRow(const proto::LoopDecision& decision);
std::string DecisionCsvRows(const std::vector<proto::LoopDecision>& decisions);
std::string DecisionCsv(const std::vector<proto::LoopDecision>& decisions);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_LOG_H_
