// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace tuning {
namespace {

constexpr int kVersion = 1;
constexpr char kVersionKey[] = "cartographer_ext_tune";

absl::Status FileError(const std::string& filename, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(filename, ": ", what));
}

absl::Status SystemError(const std::string& filename, const int error) {
  return FileError(filename, strerror(error));
}

std::string Dump(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false,
                   nlohmann::ordered_json::error_handler_t::replace) +
         "\n";
}

double Number(const nlohmann::json& json, const char* const key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : 0.;
}

// A line has the run, its values or metrics, and scalars. Deeper structures take
// a stack as deep as they are once they exist, so they never do.
nlohmann::json ParseLine(const std::string& content, const size_t begin,
                         const size_t end) {
  constexpr int kMaxDepth = 3;
  bool is_too_deep = false;
  auto json = nlohmann::json::parse(
      content.begin() + static_cast<ptrdiff_t>(begin),
      content.begin() + static_cast<ptrdiff_t>(end),
      [&is_too_deep](const int depth, nlohmann::json::parse_event_t,
                     nlohmann::json&) {
        if (depth > kMaxDepth) is_too_deep = true;
        return !is_too_deep;
      },
      false);
  return is_too_deep ? nlohmann::json() : json;
}

}  // namespace

void TakeAnswer(const nlohmann::json& answer, RunRecord* const record) {
  record->ok = answer.value("ok", false);
  record->killed = answer.value("killed", false);
  record->message = answer.value("message", "");
  record->wall_seconds = answer.value("wall_seconds", 0.);
  record->cpu_seconds = answer.value("cpu_seconds", 0.);
  record->metrics.clear();
  if (!record->ok) return;
  for (const auto& item : answer["metrics"].items()) {
    if (item.value().is_number()) {
      record->metrics[item.key()] = item.value().get<double>();
    }
  }
}

std::string RunKey(const RunRecord& record) {
  // Fidelities are a handful of fractions.
  return absl::StrCat(
      record.assignment.dump(-1, ' ', false,
                             nlohmann::json::error_handler_t::replace),
      "|", record.input, "|", absl::StrFormat("%.6f", record.fidelity));
}

nlohmann::ordered_json ToJson(const RunRecord& record) {
  nlohmann::ordered_json json;
  json["values"] = record.assignment;
  json["input"] = record.input;
  json["fidelity"] = record.fidelity;
  json["status"] = record.ok ? "ok" : "failed";
  if (!record.ok) json["message"] = record.message;
  if (record.killed) json["killed"] = true;
  json["metrics"] = record.metrics;
  json["wall_seconds"] = record.wall_seconds;
  json["cpu_seconds"] = record.cpu_seconds;
  return json;
}

absl::StatusOr<RunRecord> RunFromJson(const nlohmann::json& json) {
  const absl::Status error =
      absl::InvalidArgumentError("not a run of a tuning journal");
  if (!json.is_object()) return error;
  for (const char* key : {"values", "input", "fidelity", "status", "metrics"}) {
    if (!json.contains(key)) return error;
  }
  RunRecord record;
  if (!json["values"].is_object() || !json["input"].is_string() ||
      !json["fidelity"].is_number() || !json["metrics"].is_object() ||
      (json["status"] != "ok" && json["status"] != "failed")) {
    return error;
  }
  record.assignment = json["values"];
  record.input = json["input"].get<std::string>();
  record.fidelity = json["fidelity"].get<double>();
  record.ok = json["status"] == "ok";
  record.killed = json.contains("killed") && json["killed"] == true;
  if (json.contains("message") && json["message"].is_string()) {
    record.message = json["message"].get<std::string>();
  }
  for (const auto& item : json["metrics"].items()) {
    if (!item.value().is_number()) continue;  // null: it was not finite
    record.metrics[item.key()] = item.value().get<double>();
  }
  record.wall_seconds = Number(json, "wall_seconds");
  record.cpu_seconds = Number(json, "cpu_seconds");
  return record;
}

Journal::Journal(std::string filename, const int descriptor)
    : filename_(std::move(filename)), descriptor_(descriptor) {}

Journal::~Journal() {
  if (descriptor_ >= 0) close(descriptor_);
}

absl::StatusOr<std::unique_ptr<Journal>> Journal::Open(
    const std::string& filename, const std::string& fingerprint) {
  if (filename.empty()) {
    return std::unique_ptr<Journal>(new Journal(filename, -1));
  }
  const int descriptor =
      open(filename.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) return SystemError(filename, errno);
  std::unique_ptr<Journal> journal(new Journal(filename, descriptor));
  struct stat state;
  if (fstat(descriptor, &state) != 0) return SystemError(filename, errno);
  if (!S_ISREG(state.st_mode)) return FileError(filename, "not a plain file");
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return FileError(filename, errno == EWOULDBLOCK
                                   ? "another search is writing to it"
                                   : strerror(errno));
  }
  const absl::Status status = journal->ReadAll(fingerprint);
  if (!status.ok()) return status;
  return journal;
}

absl::Status Journal::ReadAll(const std::string& fingerprint) {
  std::string content;
  char buffer[65536];
  while (true) {
    const ssize_t count = pread(descriptor_, buffer, sizeof(buffer),
                                static_cast<off_t>(content.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return SystemError(filename_, errno);
    if (count == 0) break;
    content.append(buffer, static_cast<size_t>(count));
  }
  const size_t whole = content.rfind('\n') + 1;  // 0 when there is none
  if (whole < content.size()) {
    was_torn_ = true;
    if (ftruncate(descriptor_, static_cast<off_t>(whole)) != 0) {
      return SystemError(filename_, errno);
    }
  }
  int line_number = 0;
  for (size_t begin = 0; begin < whole;) {
    const size_t end = content.find('\n', begin);
    const auto json = ParseLine(content, begin, end);
    ++line_number;
    begin = end + 1;
    if (line_number == 1) {
      if (!json.is_object() || !json.contains(kVersionKey) ||
          !json.contains("fingerprint")) {
        return FileError(filename_, "line 1: not a tuning journal");
      }
      if (json[kVersionKey] != kVersion) {
        return FileError(filename_, "line 1: of another version");
      }
      if (json["fingerprint"] != fingerprint) {
        return FileError(filename_,
                         "is of another search: the configuration or how "
                         "recordings are read differs; use another journal");
      }
      continue;
    }
    auto record = RunFromJson(json);
    if (!record.ok()) {
      return FileError(filename_, absl::StrCat("line ", line_number, ": ",
                                               record.status().message()));
    }
    runs_.push_back(*std::move(record));
  }
  if (line_number > 0) return absl::OkStatus();
  nlohmann::ordered_json header;
  header[kVersionKey] = kVersion;
  header["fingerprint"] = fingerprint;
  return WriteLine(Dump(header));
}

absl::Status Journal::Append(const RunRecord& record) {
  if (descriptor_ < 0) return absl::OkStatus();
  return WriteLine(Dump(ToJson(record)));
}

absl::Status Journal::WriteLine(const std::string& line) {
  size_t written = 0;
  while (written < line.size()) {
    const ssize_t count =
        write(descriptor_, line.data() + written, line.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      return FileError(filename_,
                       absl::StrCat("cannot be written: ", strerror(errno)));
    }
    written += static_cast<size_t>(count);
  }
  if (fsync(descriptor_) != 0) {
    return FileError(filename_,
                     absl::StrCat("cannot be written: ", strerror(errno)));
  }
  return absl::OkStatus();
}

}  // namespace tuning
}  // namespace cartographer_ext
