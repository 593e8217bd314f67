// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/statement.h"

#include <cmath>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/common/similar_word.h"

namespace cartographer_ext {
namespace simulation {
namespace {

// Makes a value, which may be binary, fit for an error message.
std::string Quoted(absl::string_view text) {
  std::string quoted = "'";
  for (const char c : text.substr(0, 40)) {
    quoted += (c >= 32 && c < 127) ? c : '?';
  }
  return quoted + (text.size() > 40 ? "...'" : "'");
}

}  // namespace

Statement::Statement(absl::string_view line, std::string where)
    : where_(std::move(where)) {
  line = line.substr(0, line.find('#'));
  for (const absl::string_view token :
       absl::StrSplit(line, absl::ByAnyChar(" \t\r\f\v"), absl::SkipEmpty())) {
    const size_t equals = token.find('=');
    if (keyword_.empty()) {
      keyword_ = std::string(token);
    } else if (equals != absl::string_view::npos) {
      options_.push_back({std::string(token.substr(0, equals)),
                          std::string(token.substr(equals + 1)), false});
    } else {
      values_.emplace_back(token);
    }
  }
}

void Statement::Fail(absl::string_view message) {
  if (!status_.ok()) return;
  status_ = absl::InvalidArgumentError(
      absl::StrCat(where_, ": ", Quoted(keyword_), ": ", message));
}

bool Statement::Parse(absl::string_view text, absl::string_view what,
                      const double min, const double max, double* number) {
  double value = 0.;
  if (!absl::SimpleAtod(text, &value) || !std::isfinite(value)) {
    Fail(absl::StrCat(what, " ", Quoted(text), " is not a number"));
    return false;
  }
  if (value < min || value > max) {
    Fail(absl::StrCat(what, " ", value, " is outside [", min, ", ", max, "]"));
    return false;
  }
  *number = value;
  return true;
}

double Statement::Number(absl::string_view what, const double min,
                         const double max) {
  double number = 0.;
  if (!has_values()) {
    Fail(absl::StrCat(what, " is missing"));
    return number;
  }
  Parse(values_[next_value_++], what, min, max, &number);
  return number;
}

std::string Statement::Word(absl::string_view what) {
  if (!has_values()) {
    Fail(absl::StrCat(what, " is missing"));
    return "";
  }
  const std::string& word = values_[next_value_++];
  for (const char c : word) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       (c >= '0' && c <= '9') || c == '_' || c == '-' ||
                       c == '.';
    if (!plain) {
      Fail(absl::StrCat(what, " ", Quoted(word),
                        " may hold letters, digits and _ - . only"));
      return "";
    }
  }
  return word;
}

Eigen::Vector2d Statement::Point(absl::string_view what) {
  const double x =
      Number(absl::StrCat(what, " x"), -kMaxCoordinate, kMaxCoordinate);
  const double y =
      Number(absl::StrCat(what, " y"), -kMaxCoordinate, kMaxCoordinate);
  return Eigen::Vector2d(x, y);
}

std::vector<Eigen::Vector2d> Statement::Points(const size_t min_count) {
  std::vector<Eigen::Vector2d> points;
  while (has_values() && status_.ok()) points.push_back(Point("point"));
  if (points.size() < min_count) {
    Fail(absl::StrCat("needs at least ", min_count, " points, got ",
                      points.size()));
  }
  return points;
}

bool Statement::Has(absl::string_view key) const {
  for (const KeyValue& option : options_) {
    if (option.key == key) return true;
  }
  return false;
}

double Statement::Option(absl::string_view key, const double fallback,
                         const double min, const double max) {
  known_options_.emplace_back(key);
  double number = fallback;
  bool seen = false;
  for (KeyValue& option : options_) {
    if (option.key != key) continue;
    if (seen) Fail(absl::StrCat("option ", key, " is given twice"));
    seen = true;
    option.used = true;
    Parse(option.value, absl::StrCat("option ", key), min, max, &number);
  }
  return number;
}

std::string Statement::WordOption(absl::string_view key,
                                  absl::string_view fallback) {
  known_options_.emplace_back(key);
  std::string word(fallback);
  bool seen = false;
  for (KeyValue& option : options_) {
    if (option.key != key) continue;
    if (seen) Fail(absl::StrCat("option ", key, " is given twice"));
    seen = true;
    option.used = true;
    word = option.value;
  }
  return word;
}

std::vector<std::vector<double>> Statement::ListOptions(absl::string_view key,
                                                        const size_t count,
                                                        const double limit) {
  known_options_.emplace_back(key);
  std::vector<std::vector<double>> lists;
  for (KeyValue& option : options_) {
    if (option.key != key) continue;
    option.used = true;
    std::vector<double> list;
    for (const absl::string_view part : absl::StrSplit(option.value, ',')) {
      double number = 0.;
      if (!Parse(part, absl::StrCat("option ", key), -limit, limit, &number)) {
        return lists;
      }
      list.push_back(number);
    }
    if (list.size() != count) {
      Fail(absl::StrCat("option ", key, " needs ", count,
                        " comma separated numbers, got ", list.size()));
      return lists;
    }
    lists.push_back(list);
  }
  return lists;
}

absl::Status Statement::Finish() {
  if (has_values()) {
    Fail(absl::StrCat("unexpected value ", Quoted(values_[next_value_])));
  }
  for (const KeyValue& option : options_) {
    if (!option.used) {
      Fail(absl::StrCat("unknown option ", Quoted(option.key),
                        DidYouMean(SimilarWord(option.key, known_options_))));
    }
  }
  return status_;
}

}  // namespace simulation
}  // namespace cartographer_ext
