// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/journal.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/io/bounded_json.h"

namespace cartographer_ext {
namespace tuning {
void TakeAnswer(const nlohmann::json& answer, RunRecord* const record) {
  record->ok = io::TruthIn(answer, "ok", false);
  record->killed = io::TruthIn(answer, "killed", false);
  record->message = io::TextIn(answer, "message");
  record->wall_seconds = io::NumberIn(answer, "wall_seconds", 0.);
  record->cpu_seconds = io::NumberIn(answer, "cpu_seconds", 0.);
  record->metrics.clear();
  if (!record->ok) return;
  const auto metrics = answer.find("metrics");
  if (metrics == answer.end() || !metrics->is_object()) return;
  for (const auto& item : metrics->items()) {
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
  record.wall_seconds = io::NumberIn(json, "wall_seconds", 0.);
  record.cpu_seconds = io::NumberIn(json, "cpu_seconds", 0.);
  return record;
}

absl::StatusOr<std::unique_ptr<Journal>> Journal::Open(
    const std::string& filename, const std::string& fingerprint) {
  std::unique_ptr<Journal> journal(new Journal);
  auto lines = io::LineJournal::Open(
      filename,
      {"cartographer_ext_tune", "tuning journal", "search",
       "the configuration or how recordings are read differs"},
      fingerprint, [&journal](const nlohmann::json& line) {
        auto record = RunFromJson(line);
        if (!record.ok()) return record.status();
        journal->runs_.push_back(*std::move(record));
        return absl::OkStatus();
      });
  if (!lines.ok()) return lines.status();
  journal->lines_ = *std::move(lines);
  return journal;
}

absl::Status Journal::Append(const RunRecord& record) {
  return lines_->Append(ToJson(record));
}

}  // namespace tuning
}  // namespace cartographer_ext
