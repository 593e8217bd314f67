// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/tokens.h"

#include <cmath>
#include <limits>
#include <system_error>

#include "absl/strings/charconv.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr double kMaxSeconds = 9e9;
constexpr double kMaxCoordinate = 1e9;

inline bool IsBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

inline bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Plain decimals of up to 15 digits: numerator and power of ten are exact
// doubles then, so one division rounds correctly.
inline bool ParseShortDecimal(absl::string_view token, double* value) {
  static constexpr double kPowersOfTen[] = {1e0,  1e1,  1e2,  1e3, 1e4,  1e5,
                                            1e6,  1e7,  1e8,  1e9, 1e10, 1e11,
                                            1e12, 1e13, 1e14, 1e15};
  size_t i = 0;
  const bool negative = !token.empty() && token[0] == '-';
  if (negative) ++i;
  if (token.size() - i > 16) return false;
  int64_t mantissa = 0;
  int digits = 0;
  int decimals = -1;
  for (; i < token.size(); ++i) {
    const char c = token[i];
    if (IsDigit(c)) {
      mantissa = 10 * mantissa + (c - '0');
      ++digits;
      if (decimals >= 0) ++decimals;
    } else if (c == '.' && decimals < 0) {
      decimals = 0;
    } else {
      return false;
    }
  }
  if (digits == 0 || digits > 15) return false;
  const double magnitude =
      static_cast<double>(mantissa) / kPowersOfTen[decimals > 0 ? decimals : 0];
  *value = negative ? -magnitude : magnitude;
  return true;
}

}  // namespace

absl::string_view Tokens::Next() {
  size_t begin = 0;
  while (begin < rest_.size() && IsBlank(rest_[begin])) ++begin;
  size_t end = begin;
  while (end < rest_.size() && !IsBlank(rest_[end])) ++end;
  const absl::string_view token = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  return token;
}

bool Tokens::More() {
  size_t begin = 0;
  while (begin < rest_.size() && IsBlank(rest_[begin])) ++begin;
  rest_.remove_prefix(begin);
  return !rest_.empty();
}

bool ParseDouble(absl::string_view token, double* value) {
  if (ParseShortDecimal(token, value)) return true;
  if (!token.empty() && token[0] == '+') {
    token.remove_prefix(1);
    if (!token.empty() && token[0] == '-') return false;
  }
  // Hexadecimal numbers do not occur in our formats.
  if (token.find_first_of("xX") != absl::string_view::npos) return false;
  const char* const end = token.data() + token.size();
  const auto result = absl::from_chars(token.data(), end, *value);
  if (result.ptr != end || token.empty()) return false;
  // Underflow gives (nearly) zero and overflow infinity, as intended.
  if (result.ec == std::errc::result_out_of_range && std::abs(*value) > 1.) {
    *value = std::copysign(std::numeric_limits<double>::infinity(), *value);
  }
  return result.ec == std::errc() ||
         result.ec == std::errc::result_out_of_range;
}

bool ParseFinite(absl::string_view token, double* value) {
  return ParseDouble(token, value) && std::isfinite(*value);
}

bool ParseCoordinate(absl::string_view token, double* value) {
  return ParseFinite(token, value) && std::abs(*value) <= kMaxCoordinate;
}

bool ParseInt(absl::string_view token, int64_t* value) {
  return absl::SimpleAtoi(token, value);
}

bool ParseTime(absl::string_view token, TimeNs* time) {
  int64_t whole = 0;
  int64_t fraction = 0;
  size_t i = 0;
  for (; i < token.size() && IsDigit(token[i]) && i < 11; ++i) {
    whole = 10 * whole + (token[i] - '0');
  }
  const size_t whole_digits = i;
  if (i < token.size() && token[i] == '.') {
    ++i;
    int64_t unit = 100000000;
    bool rounded = false;
    for (; i < token.size() && IsDigit(token[i]); ++i) {
      if (unit > 0) {
        fraction += unit * (token[i] - '0');
        unit /= 10;
      } else if (!rounded) {
        if (token[i] >= '5') ++fraction;
        rounded = true;
      }
    }
  }
  if (i == token.size() && whole_digits > 0) {
    if (whole > static_cast<int64_t>(kMaxSeconds)) return false;
    *time = whole * 1000000000 + fraction;
    return true;
  }
  double seconds;
  if (!ParseFinite(token, &seconds) || seconds < 0. || seconds > kMaxSeconds) {
    return false;
  }
  *time = FromSeconds(seconds);
  return true;
}

std::string FormatTime(TimeNs time) {
  const bool negative = time < 0;
  const uint64_t magnitude =
      negative ? 0 - static_cast<uint64_t>(time) : static_cast<uint64_t>(time);
  return absl::StrFormat("%s%d.%09d", negative ? "-" : "",
                         magnitude / 1000000000, magnitude % 1000000000);
}

std::string FormatDouble(double value) {
  for (const int digits : {15, 16}) {
    std::string text = absl::StrFormat("%.*g", digits, value);
    double again;
    if (ParseDouble(text, &again) && again == value) return text;
  }
  return absl::StrFormat("%.17g", value);
}

}  // namespace io
}  // namespace cartographer_ext
