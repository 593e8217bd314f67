// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/evaluation/decision_files.h"

#include <cstdio>
#include <fstream>
#include <iterator>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/loop_closure/decision_log.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using proto::LoopDecision;

std::string Stem(const std::string& pbstream_filename) {
  return std::string(absl::StripSuffix(pbstream_filename, ".pbstream"));
}

}  // namespace

std::string DecisionRecordsFilename(const std::string& pbstream_filename) {
  return absl::StrCat(Stem(pbstream_filename), ".loops.pb");
}

std::string DecisionCsvFilename(const std::string& pbstream_filename) {
  return absl::StrCat(Stem(pbstream_filename), ".loops.csv");
}

absl::Status WriteDecisionsBeside(const std::string& pbstream_filename,
                                  const std::vector<LoopDecision>& decisions) {
  const std::string records = DecisionRecordsFilename(pbstream_filename);
  const std::string csv = DecisionCsvFilename(pbstream_filename);
  if (decisions.empty()) {
    std::remove(records.c_str());
    std::remove(csv.c_str());
    return absl::OkStatus();
  }
  std::string bytes;
  for (const LoopDecision& decision : decisions) {
    loop_closure::AppendDecision(decision, &bytes);
  }
  const absl::Status status = WriteFileAtomically(records, bytes);
  if (!status.ok()) return status;
  return WriteFileAtomically(csv, loop_closure::DecisionCsv(decisions));
}

absl::StatusOr<std::vector<LoopDecision>> ReadDecisions(
    const std::string& records_filename) {
  std::ifstream file(records_filename, std::ios::binary);
  if (!file) {
    return absl::NotFoundError(absl::StrCat("cannot read ", records_filename));
  }
  const std::string bytes((std::istreambuf_iterator<char>(file)),
                          std::istreambuf_iterator<char>());
  auto decisions = loop_closure::ParseDecisions(bytes);
  if (decisions.ok()) return decisions;
  return absl::Status(
      decisions.status().code(),
      absl::StrCat(records_filename, ": ", decisions.status().message()));
}

DecisionCounts CountDecisions(const std::vector<LoopDecision>& decisions) {
  DecisionCounts counts;
  for (const LoopDecision& decision : decisions) {
    if (decision.verdict() == LoopDecision::ACCEPTED) {
      ++counts.accepted;
    } else if (decision.verdict() == LoopDecision::UNDECIDED) {
      ++counts.undecided;
    } else if (decision.reason() >= LoopDecision::SKIPPED_REDUNDANT) {
      ++counts.skipped;
    } else if (decision.reason() == LoopDecision::LOW_GRID_SCORE) {
      ++counts.not_found;
    } else {
      ++counts.rejected;
    }
  }
  return counts;
}

}  // namespace evaluation
}  // namespace cartographer_ext
