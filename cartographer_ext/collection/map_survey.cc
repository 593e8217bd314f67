// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/map_survey.h"

#include <sys/stat.h>

#include <deque>
#include <map>
#include <regex>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/io/line_journal.h"

namespace cartographer_ext {
namespace collection {
namespace {

constexpr double kWaitSeconds = 0.2;

// Size and time of the last change, empty where there is no such file.
std::string StateOf(const std::string& filename) {
  struct stat state;
  if (stat(filename.c_str(), &state) != 0) return "";
  return absl::StrCat(state.st_size, " ", state.st_mtim.tv_sec, " ",
                      state.st_mtim.tv_nsec);
}

// The log of a process that ended at a failed check has its time and number.
std::string WithoutLogPrefix(const std::string& message) {
  static const std::regex* const kPrefix = new std::regex(
      "[IWEF][0-9]{4,8} [0-9]{2}:[0-9]{2}:[0-9]{2}\\.[0-9]+ +[0-9]+ ");
  return std::regex_replace(message, *kPrefix, "");
}

MapRecord FailedRecord(const std::string& filename,
                       const std::string& message) {
  MapRecord record;
  record.filename = filename;
  record.verdict = "failed";
  record.reasons = {WithoutLogPrefix(
      std::string(absl::StripPrefix(message, filename + ": ")))};
  return record;
}

// What an earlier survey found out.
struct KnownMap {
  std::string state;
  MapRecord record;
};

bool IsStillTrue(const KnownMap& known, const std::string& filename,
                 const std::string& report) {
  // A file that could not be read may be available again.
  return !known.state.empty() && known.state == StateOf(filename) &&
         known.record.report ==
             (known.record.verdict == "failed" ? "" : report) &&
         (known.record.report.empty() || !StateOf(report).empty());
}

}  // namespace

std::vector<std::string> ReportFilenames(
    const std::vector<std::string>& filenames,
    const std::string& reports_directory) {
  std::vector<std::string> reports(filenames.size());
  if (reports_directory.empty()) return reports;
  std::set<std::string> taken;
  for (size_t i = 0; i < filenames.size(); ++i) {
    std::string stem(absl::StripSuffix(filenames[i], ".pbstream"));
    for (char& letter : stem) {
      if (!absl::ascii_isalnum(static_cast<unsigned char>(letter)) &&
          letter != '-' && letter != '.') {
        letter = '_';
      }
    }
    stem = std::string(absl::StripLeadingAsciiWhitespace(stem));
    while (!stem.empty() && (stem[0] == '_' || stem[0] == '.'))
      stem.erase(0, 1);
    std::string name = stem;
    for (int k = 2; !taken.insert(name).second; ++k) {
      name = absl::StrCat(stem, "-", k);
    }
    reports[i] = absl::StrCat(reports_directory, "/", name, ".html");
  }
  return reports;
}

absl::StatusOr<std::vector<MapRecord>> SurveyMaps(
    const std::vector<std::string>& filenames, const SurveyOptions& options,
    tuning::WorkerPool* const pool) {
  const std::vector<std::string> reports =
      ReportFilenames(filenames, options.reports_directory);
  std::map<std::string, KnownMap> known;
  const auto journal = io::LineJournal::Open(
      options.journal_filename,
      {"cartographer_ext_evaluate", "journal of maps", "survey",
       "maps are judged with other options"},
      "1", [&known](const nlohmann::json& line) -> absl::Status {
        if (!line.is_object() || !line.contains("state") ||
            !line["state"].is_string() || !line.contains("record")) {
          return absl::InvalidArgumentError("not a line of a journal of maps");
        }
        auto record = RecordFromJson(line["record"]);
        if (!record.ok()) return record.status();
        const std::string filename = record->filename;
        known[filename] = {line["state"], *std::move(record)};
        return absl::OkStatus();
      });
  if (!journal.ok()) return journal.status();

  std::vector<MapRecord> records(filenames.size());
  std::deque<size_t> queue;
  int64_t done = 0;
  for (size_t i = 0; i < filenames.size(); ++i) {
    const auto found = known.find(filenames[i]);
    if (found != known.end() &&
        IsStillTrue(found->second, filenames[i], reports[i])) {
      records[i] = found->second.record;
      ++done;
    } else {
      queue.push_back(i);
    }
  }
  known.clear();
  std::map<int, std::string> states;  // of the files when they were begun
  while (!queue.empty() || pool->num_running() > 0) {
    while (!queue.empty() && pool->num_running() < pool->num_workers()) {
      const size_t i = queue.front();
      queue.pop_front();
      states[static_cast<int>(i)] = StateOf(filenames[i]);
      pool->Start(static_cast<int>(i),
                  {{"filename", filenames[i]}, {"report", reports[i]}});
    }
    const auto result = pool->Wait(kWaitSeconds);
    if (!result.has_value()) continue;
    MapRecord& record = records[static_cast<size_t>(result->id)];
    const std::string& filename = filenames[static_cast<size_t>(result->id)];
    const nlohmann::json& answer = result->answer;
    auto parsed = answer.value("ok", false) && answer.contains("metrics")
                      ? RecordFromJson(answer["metrics"])
                      : absl::InvalidArgumentError(answer.value("message", ""));
    if (parsed.ok()) {
      record = *std::move(parsed);
      record.filename = filename;
    } else {
      record = FailedRecord(filename, std::string(parsed.status().message()));
    }
    const absl::Status status = (*journal)->Append(
        {{"state", states[result->id]}, {"record", ToJson(record)}});
    if (!status.ok()) return status;
    states.erase(result->id);
    if (options.on_progress) options.on_progress(++done, record);
  }
  return records;
}

}  // namespace collection
}  // namespace cartographer_ext
