// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/baseline.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/io/bounded_json.h"
#include "cartographer_ext/io/line_reader.h"

namespace cartographer_ext {
namespace collection {
namespace {

// A record holds numbers, texts and lists of them.
constexpr int kMaxDepth = 3;

}  // namespace

absl::StatusOr<std::map<std::string, MapRecord>> ReadBaseline(
    const std::string& filename) {
  auto reader = io::LineReader::Open(filename);
  if (!reader.ok()) return reader.status();
  std::map<std::string, MapRecord> baseline;
  absl::string_view line;
  while (true) {
    const absl::StatusOr<bool> more = (*reader)->Next(&line);
    if (!more.ok()) return more.status();
    if (!*more) return baseline;
    if (line.empty()) continue;
    auto record = RecordFromJson(io::ParseBoundedJson(line, kMaxDepth));
    if (!record.ok()) {
      return absl::InvalidArgumentError(
          absl::StrCat((*reader)->Location(), ": ", record.status().message()));
    }
    const std::string name = record->filename;
    baseline[name] = *std::move(record);
  }
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
