// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/baseline.h"

#include <cerrno>
#include <fstream>
#include <utility>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace collection {

absl::StatusOr<std::map<std::string, MapRecord>> ReadBaseline(
    const std::string& filename) {
  std::ifstream stream(filename);
  if (!stream) {
    return absl::ErrnoToStatus(errno, absl::StrCat("cannot open ", filename));
  }
  std::map<std::string, MapRecord> baseline;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.empty()) continue;
    auto record = RecordFromJson(nlohmann::json::parse(line, nullptr, false));
    if (!record.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(
          filename, ": line ", number, ": ", record.status().message()));
    }
    const std::string name = record->filename;
    baseline[name] = *std::move(record);
  }
  return baseline;
}

std::vector<MapChange> Compare(const std::map<std::string, MapRecord>& baseline,
                               const std::vector<MapRecord>& records) {
  std::map<std::string, MapChange> changes;
  for (const auto& entry : baseline) {
    changes[entry.first] = {entry.first, entry.second.verdict, "", "gone"};
  }
  for (const MapRecord& record : records) {
    MapChange& change = changes[record.filename];
    change.filename = record.filename;
    change.after = record.verdict;
    const int difference = Severity(change.after) - Severity(change.before);
    change.kind = change.before.empty() ? "new"
                  : difference > 0      ? "worse"
                  : difference < 0      ? "better"
                                        : "same";
  }
  std::vector<MapChange> all;
  for (auto& entry : changes) all.push_back(std::move(entry.second));
  return all;
}

nlohmann::ordered_json ToJson(const MapChange& change) {
  return {{"filename", change.filename},
          {"before", change.before},
          {"after", change.after},
          {"kind", change.kind}};
}

}  // namespace collection
}  // namespace cartographer_ext
