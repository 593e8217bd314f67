// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Changes of the verdicts of maps since an earlier evaluation.
#ifndef CARTOGRAPHER_EXT_COLLECTION_BASELINE_H_
#define CARTOGRAPHER_EXT_COLLECTION_BASELINE_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/collection/map_record.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace collection {

// Reads lines of JSON written by ToJsonLines, by the name of the map. Errors
// name file and line.
absl::StatusOr<std::map<std::string, MapRecord>> ReadBaseline(
    const std::string& filename);

struct MapChange {
  std::string filename;
  std::string before, after;  // verdicts; empty: missing
  // "worse", "better", "same", "new", "gone". By severity: a map that can no
  // longer be read is worse than a broken one.
  std::string kind;
};

// All maps of both, in order of name.
std::vector<MapChange> Compare(const std::map<std::string, MapRecord>& baseline,
                               const std::vector<MapRecord>& records);

nlohmann::ordered_json ToJson(const MapChange& change);

}  // namespace collection
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COLLECTION_BASELINE_H_
