// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The runs of a search, on disk (line_journal.h), one line per finished run. A
// search that is restarted with the same journal reuses these runs; as the list
// of trials depends only on results, it continues as if it had not been
// interrupted.
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
  // Identification.
  nlohmann::json assignment;  // { key: value }
  std::string input;
  double fidelity = 1.;

  // Result.
  bool ok = false;
  // Killed from outside (out of memory, a scheduler), independently of the
  // configuration; a resumed search tries it again.
  bool killed = false;
  std::string message;                    // why not
  std::map<std::string, double> metrics;  // relations, ate, cpu_seconds, ...
  double wall_seconds = 0.;
  double cpu_seconds = 0.;
};

// Fills in the result from the answer of a worker.
void TakeAnswer(const nlohmann::json& answer, RunRecord* record);

// Identifies the run among all of a journal.
std::string RunKey(const RunRecord& record);

nlohmann::ordered_json ToJson(const RunRecord& record);
absl::StatusOr<RunRecord> RunFromJson(const nlohmann::json& json);

class Journal {
 public:
  // Opens or starts the journal. `fingerprint` identifies everything else that
  // the runs depend on; a journal with a different fingerprint is an error.
  // Errors name the file and, if applicable, the line. With an empty name the
  // journal is kept in memory only.
  static absl::StatusOr<std::unique_ptr<Journal>> Open(
      const std::string& filename, const std::string& fingerprint);

  // The runs it held when it was opened, in the order of the file.
  const std::vector<RunRecord>& runs() const { return runs_; }

  // Whether an incomplete last line was removed.
  bool was_torn() const { return lines_->was_torn(); }

  // On disk if it returns OK.
  absl::Status Append(const RunRecord& record);

 private:
  Journal() = default;

  std::unique_ptr<io::LineJournal> lines_;
  std::vector<RunRecord> runs_;
};

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_JOURNAL_H_
