// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tools/flag_values.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "absl/strings/cord.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/common/similar_word.h"
#include "cartographer_ext/configuration/option_ranges.h"
#include "cartographer_ext/io/tokens.h"
#include "gflags/gflags.h"

namespace cartographer_ext {
namespace tools {
namespace {

// Of a map, metres per cell.
constexpr double kMinResolution = 0.001;
constexpr double kMaxResolution = 10.;

constexpr char kUsagePayload[] = "cartographer_ext/wrong_usage";

absl::Status OutOfRange(const std::string& name, const std::string& value,
                        const std::string& range) {
  return absl::InvalidArgumentError(
      absl::StrCat("-", name, " is \"", value, "\", must be ", range));
}

// Of the flag, or of a word of its list.
absl::Status CheckChoice(const FlagChoices& choices, const std::string& value) {
  const std::vector<std::string>& known = choices.values;
  if (std::find(known.begin(), known.end(), value) != known.end()) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat(
      "-", choices.flag, "=", value, " is none of ", absl::StrJoin(known, ", "),
      DidYouMean(SimilarWord(value, known))));
}

absl::Status CheckEnding(const FlagChoices& choices, const std::string& value) {
  std::error_code error;
  if (std::filesystem::exists(value, error) &&
      !std::filesystem::is_regular_file(value, error)) {
    return absl::OkStatus();
  }
  for (const std::string& ending : choices.values) {
    if (absl::EndsWithIgnoreCase(value, ending)) return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("-", choices.flag, "=", value, " must end in ",
                   absl::StrJoin(choices.values, " or "),
                   ": other formats are not written"));
}

absl::Status CheckOne(const FlagChoices& choices) {
  gflags::CommandLineFlagInfo info;
  if (!gflags::GetCommandLineFlagInfo(choices.flag.c_str(), &info) ||
      (info.current_value.empty() && info.default_value.empty())) {
    return absl::OkStatus();
  }
  switch (choices.kind) {
    case FlagChoices::Kind::kOne:
      return CheckChoice(choices, info.current_value);
    case FlagChoices::Kind::kEnding:
      return CheckEnding(choices, info.current_value);
    case FlagChoices::Kind::kList:
      for (const std::string& word : std::vector<std::string>(absl::StrSplit(
               info.current_value, absl::ByAnyChar(", "), absl::SkipEmpty()))) {
        const absl::Status status = CheckChoice(choices, word);
        if (!status.ok()) return status;
      }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckFlagChoices(const std::vector<FlagChoices>& choices) {
  std::vector<FlagChoices> all = choices;
  std::vector<gflags::CommandLineFlagInfo> flags;
  gflags::GetAllFlags(&flags);
  for (const gflags::CommandLineFlagInfo& flag : flags) {
    const bool is_listed = std::any_of(
        choices.begin(), choices.end(),
        [&](const FlagChoices& entry) { return entry.flag == flag.name; });
    if (is_listed || !absl::EndsWith(flag.name, "picture_filename")) continue;
    all.push_back({flag.name, {".png"}, FlagChoices::Kind::kEnding});
  }
  for (const FlagChoices& entry : all) {
    const absl::Status status = CheckOne(entry);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status WrongUsage(absl::Status status) {
  if (!status.ok()) status.SetPayload(kUsagePayload, absl::Cord());
  return status;
}

bool IsWrongUsage(const absl::Status& status) {
  return status.GetPayload(kUsagePayload).has_value();
}

absl::Status CheckFlagValue(const std::string& name, const std::string& value) {
  if (value == "-" && (absl::EndsWith(name, "pbstream_filename") ||
                       absl::EndsWith(name, "picture_filename") ||
                       absl::EndsWith(name, "filestem"))) {
    return absl::InvalidArgumentError(absl::StrCat(
        "-", name, " cannot be -, which is standard output for JSON and text"));
  }
  gflags::CommandLineFlagInfo info;
  double number = 0., default_number = 0.;
  if (!gflags::GetCommandLineFlagInfo(name.c_str(), &info) ||
      info.type == "string" || info.type == "bool" ||
      !absl::SimpleAtod(value, &number) ||
      !absl::SimpleAtod(info.default_value, &default_number)) {
    return absl::OkStatus();
  }
  const double least = default_number < 0. ? -1. : 0.;
  if (!(number >= least)) {
    return OutOfRange(name, value, absl::StrCat("a number >= ", least));
  }
  if (std::isinf(number) && !absl::StartsWith(name, "max_")) {
    return OutOfRange(name, value, "finite");
  }
  if ((name == "num_background_threads" || name == "threads" ||
       name == "workers") &&
      number > evaluation::kMaxBackgroundThreads) {
    return absl::InvalidArgumentError(absl::StrCat(
        "-", name, " must be at most ", evaluation::kMaxBackgroundThreads));
  }
  if (name == "resolution" &&
      !(number >= kMinResolution && number <= kMaxResolution)) {
    return OutOfRange(name, value,
                      absl::StrCat("at least ", kMinResolution, " and at most ",
                                   kMaxResolution, " (metres per cell)"));
  }
  return absl::OkStatus();
}

std::string ShortestNumber(const std::string& text) {
  double number = 0.;
  if (!absl::SimpleAtod(text, &number)) return text;
  return io::FormatDouble(number);
}

std::string Printable(const std::string& text) {
  std::string result = text;
  for (char& character : result) {
    const auto code = static_cast<unsigned char>(character);
    if ((code < 0x20 && character != '\n' && character != '\t') ||
        code == 0x7f) {
      character = '?';
    }
  }
  return result;
}

}  // namespace tools
}  // namespace cartographer_ext
