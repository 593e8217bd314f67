// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/collection_run.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/collection/map_survey.h"
#include "cartographer_ext/collection/overview_page.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/progress.h"

namespace cartographer_ext {
namespace collection {
namespace {

absl::Status WriteIfWanted(const std::string& filename,
                           const std::string& content) {
  return filename.empty() ? absl::OkStatus()
                          : WriteFileAtomically(filename, content);
}

absl::Status WriteFiles(const CollectionResult& result,
                        const CollectionFiles& files) {
  absl::Status status =
      WriteIfWanted(files.json_lines, ToJsonLines(result.records));
  if (status.ok()) status = WriteIfWanted(files.csv, ToCsv(result.records));
  if (!status.ok() || files.overview.empty()) return status;
  return WriteFileAtomically(
      files.overview,
      MakeOverview(result.records, result.changes, files.overview));
}

}  // namespace

absl::StatusOr<CollectionResult> RunCollection(
    const std::vector<std::string>& filenames, const CollectionFiles& files,
    tuning::WorkerPool* const pool) {
  std::map<std::string, MapRecord> baseline;
  if (!files.baseline.empty()) {
    auto read = ReadBaseline(files.baseline);
    if (!read.ok()) return read.status();
    baseline = *std::move(read);
  }
  if (!files.reports_directory.empty()) {
    std::error_code error;
    std::filesystem::create_directories(files.reports_directory, error);
    if (error) {
      return absl::InvalidArgumentError(
          absl::StrCat(files.reports_directory, ": ", error.message()));
    }
  }
  Progress progress("maps", static_cast<int64_t>(filenames.size()));
  SurveyOptions options;
  options.reports_directory = files.reports_directory;
  options.journal_filename = files.journal;
  options.on_progress = [&progress](const int64_t done, const MapRecord& last) {
    progress.Update(done, absl::StrCat(last.filename, ": ", last.verdict));
  };
  auto records = SurveyMaps(filenames, options, pool);
  progress.Finish();
  if (!records.ok()) return records.status();
  CollectionResult result;
  result.records = *std::move(records);
  if (!files.baseline.empty()) {
    result.changes = Compare(baseline, result.records);
  }
  const absl::Status status = WriteFiles(result, files);
  if (!status.ok()) return status;
  return result;
}

nlohmann::ordered_json ToJson(const CollectionResult& result) {
  nlohmann::ordered_json json;
  json["verdicts"] = CountVerdicts(result.records);
  json["maps"] = nlohmann::ordered_json::array();
  for (const MapRecord& record : result.records) {
    json["maps"].push_back(ToJson(record));
    json["maps"].back().erase("picture");
  }
  json["changes"] = nlohmann::ordered_json::array();
  for (const MapChange& change : result.changes) {
    if (change.kind != "same") json["changes"].push_back(ToJson(change));
  }
  return json;
}

std::string ToText(const CollectionResult& result) {
  std::string text;
  for (const MapRecord& record : result.records) {
    absl::StrAppendFormat(&text, "%-8s %5.1f %%  %s\n", record.verdict,
                          100. * record.severe_share, record.filename);
  }
  for (const MapChange& change : result.changes) {
    if (change.kind != "worse" && change.kind != "better") continue;
    absl::StrAppend(&text, change.filename, ": ", change.kind, ", was ",
                    change.before, ", is ", change.after, "\n");
  }
  absl::StrAppend(&text, result.records.size(),
                  " maps: ", CountsInWords(result.records), "\n");
  return text;
}

absl::Status CheckAllJudged(const std::vector<MapRecord>& records) {
  std::string message;
  int failed = 0;
  for (const MapRecord& record : records) {
    if (record.verdict != "failed") continue;
    ++failed;
    absl::StrAppend(&message, "\n  ", record.filename, ": ",
                    record.reasons.empty() ? "" : record.reasons.front());
  }
  if (failed == 0) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      failed, " of ", records.size(), " maps could not be judged:", message));
}

bool IsFailOn(const std::string& fail_on) {
  return fail_on.empty() || fail_on == "broken" || fail_on == "doubtful" ||
         fail_on == "worse";
}

bool FailsOn(const std::string& verdict, const std::string& fail_on) {
  return Severity(fail_on) > 0 && Severity(verdict) >= Severity(fail_on);
}

bool FailsOn(const CollectionResult& result, const std::string& fail_on) {
  return std::any_of(result.changes.begin(), result.changes.end(),
                     [&](const MapChange& change) {
                       return fail_on == "worse" && change.kind == "worse";
                     }) ||
         std::any_of(result.records.begin(), result.records.end(),
                     [&](const MapRecord& record) {
                       return FailsOn(record.verdict, fail_on);
                     });
}

}  // namespace collection
}  // namespace cartographer_ext
