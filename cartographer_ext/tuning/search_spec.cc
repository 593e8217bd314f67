// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/search_spec.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include <algorithm>
#include <set>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/common/similar_word.h"
#include "cartographer_ext/configuration/lua_value.h"

namespace cartographer_ext {
namespace tuning {
namespace {

absl::Status InFile(const std::string& filename, const absl::Status& status) {
  return absl::InvalidArgumentError(
      absl::StrCat(filename, ": ", status.message()));
}

absl::StatusOr<std::vector<std::string>> ParseTexts(const nlohmann::json& value,
                                                    const std::string& key) {
  std::vector<std::string> texts;
  const bool is_empty = value.is_object() && value.empty();  // Lua's {}
  for (const nlohmann::json& entry : value) {
    if (!value.is_array() || !entry.is_string()) {
      return absl::InvalidArgumentError(key + " is not a list of strings");
    }
    texts.push_back(entry.get<std::string>());
  }
  if (!value.is_array() && !is_empty) {
    return absl::InvalidArgumentError(key + " is not a list of strings");
  }
  return texts;
}

absl::Status ParseInto(const nlohmann::json& table, SearchSpec* const spec) {
  static const std::vector<std::string> known = {
      "configuration", "parameters",     "objective", "aggregation",
      "target_recall", "no_input_worse", "inputs",    "holdout"};
  if (!table.is_object()) {
    return absl::InvalidArgumentError("does not return a table with names");
  }
  for (const auto& item : table.items()) {
    if (std::count(known.begin(), known.end(), item.key()) > 0) continue;
    return absl::InvalidArgumentError(
        item.key() == "map_builder"
            ? "is a configuration, not a search file, which names parameters"
            : absl::StrCat("unknown key '", item.key(), "'",
                           DidYouMean(SimilarWord(item.key(), known))));
  }
  if (!table.contains("parameters")) {
    return absl::InvalidArgumentError("parameters is missing");
  }
  auto parameters = ParseParameters(table["parameters"]);
  if (!parameters.ok()) return parameters.status();
  spec->parameters = *std::move(parameters);
  if (table.contains("configuration")) {
    if (!table["configuration"].is_string()) {
      return absl::InvalidArgumentError("configuration is not a file name");
    }
    spec->configuration = table["configuration"].get<std::string>();
  }
  if (table.contains("objective")) {
    auto weights = ParseWeights(table["objective"]);
    if (!weights.ok()) return weights.status();
    spec->objective.weights = *std::move(weights);
  }
  if (table.contains("aggregation")) {
    if (!table["aggregation"].is_string()) {
      return absl::InvalidArgumentError("aggregation is not a string");
    }
    const auto aggregation =
        ParseAggregation(table["aggregation"].get<std::string>());
    if (!aggregation.ok()) return aggregation.status();
    spec->objective.aggregation = *aggregation;
  }
  if (table.contains("target_recall")) {
    const nlohmann::json& recall = table["target_recall"];
    if (!recall.is_number() || !(recall.get<double>() > 0.) ||
        !(recall.get<double>() <= 1.)) {
      return absl::InvalidArgumentError(
          "target_recall must be above 0 and at most 1");
    }
    spec->objective.target_recall = recall.get<double>();
  }
  if (table.contains("no_input_worse")) {
    if (!table["no_input_worse"].is_boolean()) {
      return absl::InvalidArgumentError("no_input_worse must be true or false");
    }
    spec->no_input_worse = table["no_input_worse"].get<bool>();
  }
  for (const char* key : {"inputs", "holdout"}) {
    if (!table.contains(key)) continue;
    auto texts = ParseTexts(table[key], key);
    if (!texts.ok()) return texts.status();
    (std::string(key) == "inputs" ? spec->inputs : spec->holdout) =
        *std::move(texts);
  }
  return absl::OkStatus();
}

std::string BaseName(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

absl::StatusOr<int64_t> FileSize(const std::string& filename) {
  struct stat state;
  if (stat(filename.c_str(), &state) != 0) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, ": ", strerror(errno)));
  }
  if (S_ISDIR(state.st_mode)) {
    return absl::InvalidArgumentError(absl::StrCat(filename, ": is a folder"));
  }
  return static_cast<int64_t>(state.st_size);
}

std::string WithoutSuffixes(std::string path) {
  for (const char* suffix : {".gz", ".xz", ".bz2"}) {
    if (absl::EndsWith(path, suffix)) {
      path.resize(path.size() - strlen(suffix));
      break;
    }
  }
  for (const char* suffix : {".clf", ".log", ".bag", ".pbstream"}) {
    if (absl::EndsWith(path, suffix)) {
      path.resize(path.size() - strlen(suffix));
      break;
    }
  }
  return path;
}

}  // namespace

absl::StatusOr<SearchSpec> ReadSearchSpec(const std::string& filename) {
  const size_t slash = filename.find_last_of('/');
  const std::string directory =
      slash == std::string::npos ? "." : filename.substr(0, slash + 1);
  const auto code =
      evaluation::ReadFromDirectories(BaseName(filename), {directory});
  if (!code.ok()) return InFile(filename, code.status());
  const auto table =
      evaluation::EvaluateLua(*code, BaseName(filename), {directory});
  if (!table.ok()) return table.status();
  SearchSpec spec;
  const absl::Status status = ParseInto(*table, &spec);
  if (!status.ok()) return InFile(filename, status);
  return spec;
}

absl::StatusOr<TuneInput> ParseInput(const std::string& text) {
  TuneInput input;
  const std::pair<std::string, std::string> parts =
      absl::StrSplit(text, absl::MaxSplits('=', 1));
  input.recording = parts.first;
  const size_t hash = input.recording.find(".world#");
  std::string seed_text;
  if (hash != std::string::npos) {
    seed_text = input.recording.substr(hash + strlen(".world#"));
    if (!absl::SimpleAtoi(seed_text, &input.seed)) {
      return absl::InvalidArgumentError(
          absl::StrCat(text, ": '", seed_text, "' is not a seed"));
    }
    input.recording.resize(hash + strlen(".world"));
  }
  input.is_world = absl::EndsWith(input.recording, ".world");
  input.is_pbstream = absl::EndsWith(input.recording, ".pbstream");
  const auto size = FileSize(input.recording);
  if (!size.ok()) return size.status();
  input.name = absl::StrCat(BaseName(input.recording),
                            input.is_world ? absl::StrCat("#", input.seed) : "",
                            "@", *size);
  std::vector<std::string> truths;
  if (!parts.second.empty()) {
    truths.push_back(parts.second);
  } else if (!input.is_world) {
    // A world has its own ground truth.
    const std::string stem = WithoutSuffixes(input.recording);
    for (const char* suffix : {".relations", ".tum"}) {
      if (FileSize(stem + suffix).ok()) truths.push_back(stem + suffix);
    }
  }
  for (const std::string& truth : truths) {
    const auto truth_size = FileSize(truth);
    if (!truth_size.ok()) return truth_size.status();
    absl::StrAppend(&input.name, "+", BaseName(truth), "@", *truth_size);
    (absl::EndsWith(truth, ".tum") ? input.reference_filename
                                   : input.relations_filename) = truth;
  }
  return input;
}

absl::StatusOr<std::vector<TuneInput>> ParseInputs(
    const std::vector<std::string>& texts) {
  std::vector<TuneInput> inputs;
  std::set<std::string> names;
  for (const std::string& text : texts) {
    auto input = ParseInput(text);
    if (!input.ok()) return input.status();
    if (!names.insert(input->name).second) {
      return absl::InvalidArgumentError(
          absl::StrCat(text, ": the same input twice"));
    }
    inputs.push_back(*std::move(input));
  }
  return inputs;
}

absl::Status CheckTruth(const std::vector<TuneInput>& inputs,
                        const Objective& objective) {
  for (const TuneInput& input : inputs) {
    if (input.is_world) continue;
    for (const auto& weight : objective.weights) {
      const std::string& metric = weight.first;
      const bool needs_relations =
          absl::StartsWith(metric, "relations") || metric == "broken_fraction";
      const bool needs_reference = metric == "ate" || metric == "rpe";
      if (needs_relations && input.relations_filename.empty()) {
        return absl::InvalidArgumentError(absl::StrCat(
            input.recording, ": no '", metric,
            "' without reference relations: give FILE=TRUTH.relations or put "
            "them beside it; the objective self_consistency needs none"));
      }
      if (needs_reference && input.reference_filename.empty()) {
        return absl::InvalidArgumentError(absl::StrCat(
            input.recording, ": no '", metric,
            "' without a reference trajectory: give FILE=TRUTH.tum or put it "
            "beside it; the objective self_consistency needs none"));
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace tuning
}  // namespace cartographer_ext
