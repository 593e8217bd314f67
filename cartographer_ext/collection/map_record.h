// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Summary of one map among many, for a table, a page and a comparison with an
// earlier evaluation.
#ifndef CARTOGRAPHER_EXT_COLLECTION_MAP_RECORD_H_
#define CARTOGRAPHER_EXT_COLLECTION_MAP_RECORD_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace collection {

struct MapRecord {
  std::string filename;
  // "sound", "unknown", "doubtful", "broken", or "failed": the file could not
  // be judged, for the reason in `reasons`.
  std::string verdict;
  std::vector<std::string> reasons;
  int64_t nodes = 0;
  int64_t submaps = 0;
  int64_t loops = 0;
  double path = 0.;           // metres
  double severe_share = 0.;   // of the nodes that revisit a place
  double open_cycles = 0.;    // share of short cycles of two loops
  double wall_doubling = 1.;  // all visits to one visit
  int64_t wrong_turns = 0;
  std::string picture;  // thumbnail as a data URI; may be empty
  std::string report;   // file name of its own page; empty without one
};

// 0 sound or unknown, 1 doubtful, 2 broken, 3 failed.
int Severity(const std::string& verdict);

nlohmann::ordered_json ToJson(const MapRecord& record);
absl::StatusOr<MapRecord> RecordFromJson(const nlohmann::json& json);

// Lines of JSON, without pictures.
std::string ToJsonLines(const std::vector<MapRecord>& records);
// With a header line.
std::string ToCsv(const std::vector<MapRecord>& records);

// Evaluates one map; runs in a separate process because it may crash on a
// damaged file. Request { "filename", "report" } (the second is empty without a
// page); the answer is as in tuning/worker_pool.h with the record as "metrics".
nlohmann::json AnswerMapRequest(const nlohmann::json& request);

}  // namespace collection
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COLLECTION_MAP_RECORD_H_
