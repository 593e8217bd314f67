// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Judging many maps from the command line: options and outputs.
#ifndef CARTOGRAPHER_EXT_COLLECTION_COLLECTION_RUN_H_
#define CARTOGRAPHER_EXT_COLLECTION_COLLECTION_RUN_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/collection/baseline.h"
#include "cartographer_ext/collection/map_record.h"
#include "cartographer_ext/tuning/workers/worker_pool.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace collection {

// Output files; empty: not written.
struct CollectionFiles {
  std::string overview;           // HTML
  std::string reports_directory;  // created if missing
  std::string csv;
  std::string json_lines;
  std::string journal;
  std::string baseline;  // input: JSON lines of an earlier run
};

struct CollectionResult {
  std::vector<MapRecord> records;
  std::vector<MapChange> changes;  // empty without a baseline
};

// Judges the maps with a line of progress and writes the files.
absl::StatusOr<CollectionResult> RunCollection(
    const std::vector<std::string>& filenames, const CollectionFiles& files,
    tuning::WorkerPool* pool);

nlohmann::ordered_json ToJson(const CollectionResult& result);
std::string ToText(const CollectionResult& result);

// An error that counts and names the maps that could not be judged; OK if there
// are none.
absl::Status CheckAllJudged(const std::vector<MapRecord>& records);

// Valid values of -fail_on: "", "broken", "doubtful", "worse".
bool IsFailOn(const std::string& fail_on);

// Whether a verdict is as bad as `fail_on` or worse.
bool FailsOn(const std::string& verdict, const std::string& fail_on);

// Whether this holds for any map, or, with "worse", for any map since the
// baseline.
bool FailsOn(const CollectionResult& result, const std::string& fail_on);

}  // namespace collection
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COLLECTION_COLLECTION_RUN_H_
