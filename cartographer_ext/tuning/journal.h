// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What has been run, on disk (line_journal.h): a line for each finished run. A
// search that is started again with the same journal finds every run there
// instead of doing it again; as the list of trials depends on results only, it
// goes on as if nothing had happened.
#ifndef CARTOGRAPHER_EXT_TUNING_JOURNAL_H_
#define CARTOGRAPHER_EXT_TUNING_JOURNAL_H_

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/io/line_journal.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace tuning {

// One configuration on one recording.
struct RunRecord {
  // What identifies it.
  nlohmann::json assignment;  // { key: value }
  std::string input;
  double fidelity = 1.;

  // What came out.
  bool ok = false;
  // Ended from outside (out of memory, a scheduler): says nothing about the
  // configuration, so that a search that goes on tries it again.
  bool killed = false;
  std::string message;                    // why not
  std::map<std::string, double> metrics;  // relations, ate, cpu_seconds, ...
  double wall_seconds = 0.;
  double cpu_seconds = 0.;
};

// Fills in what came out from the answer of a worker.
void TakeAnswer(const nlohmann::json& answer, RunRecord* record);

// Identifies the run among all of a journal.
std::string RunKey(const RunRecord& record);

nlohmann::ordered_json ToJson(const RunRecord& record);
absl::StatusOr<RunRecord> RunFromJson(const nlohmann::json& json);

class Journal {
 public:
  // Opens or starts the journal. `fingerprint` identifies what the runs depend on
  // besides their key; a journal of another fingerprint is an error. Errors name
  // the file, and the line where there is one. An empty name gives a journal
  // that is not kept.
  static absl::StatusOr<std::unique_ptr<Journal>> Open(
      const std::string& filename, const std::string& fingerprint);

  // The runs it held when it was opened, in the order of the file.
  const std::vector<RunRecord>& runs() const { return runs_; }

  // Whether half a line was cut off its end.
  bool was_torn() const { return lines_->was_torn(); }

  // On disk when it returns OK.
  absl::Status Append(const RunRecord& record);

 private:
  Journal() = default;

  std::unique_ptr<io::LineJournal> lines_;
  std::vector<RunRecord> runs_;
};

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_JOURNAL_H_
