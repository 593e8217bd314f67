// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tools/flag_values.h"

#include <cmath>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/configuration/option_ranges.h"
#include "cartographer_ext/io/tokens.h"
#include "gflags/gflags.h"

namespace cartographer_ext {
namespace tools {
namespace {

// Of a map, metres per cell.
constexpr double kMinResolution = 0.001;
constexpr double kMaxResolution = 10.;

absl::Status OutOfRange(const std::string& name, const std::string& value,
                        const std::string& range) {
  return absl::InvalidArgumentError(
      absl::StrCat("-", name, " is \"", value, "\", must be ", range));
}

}  // namespace

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
