// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What is told of one map among many: enough for a table, a page and a
// comparison with an earlier day.
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
  // be judged, and `reasons` says why.
  std::string verdict;
  std::vector<std::string> reasons;
  int64_t nodes = 0;
  int64_t submaps = 0;
  int64_t loops = 0;
  double path = 0.;           // metres
  double severe_share = 0.;   // of the nodes that see a place again
  double open_cycles = 0.;    // share of short cycles of two loops
  double wall_doubling = 1.;  // all visits to one visit
  int64_t wrong_turns = 0;
  std::string picture;  // a small one, as a data URI; may be empty
  std::string report;   // file name of its own page; empty without one
};

// 0 sound or unknown, 1 doubtful, 2 broken, 3 failed.
int Severity(const std::string& verdict);

nlohmann::ordered_json ToJson(const MapRecord& record);
absl::StatusOr<MapRecord> RecordFromJson(const nlohmann::json& json);

// Lines of JSON, without pictures.
std::string ToJsonLines(const std::vector<MapRecord>& records);
// With a head line.
std::string ToCsv(const std::vector<MapRecord>& records);

// The whole work on one map, which may crash on a damaged file and therefore
// has a process of its own: request { "filename", "report" } (the second empty
// without a page), answer as those of tuning/worker_pool.h with "metrics" the
// record.
nlohmann::json AnswerMapRequest(const nlohmann::json& request);

}  // namespace collection
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COLLECTION_MAP_RECORD_H_
