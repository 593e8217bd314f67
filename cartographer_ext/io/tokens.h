// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Words and numbers of text lines. Number parsing does not depend on the locale
// and is exact: the nearest double, the nearest nanosecond.
#ifndef CARTOGRAPHER_EXT_IO_TOKENS_H_
#define CARTOGRAPHER_EXT_IO_TOKENS_H_

#include <cstdint>
#include <string>

#include "absl/strings/string_view.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// Splits a line into words separated by blanks.
class Tokens {
 public:
  explicit Tokens(absl::string_view line) : rest_(line) {}
  // Empty at the end of the line.
  absl::string_view Next();
  // True if another word follows.
  bool More();
  absl::string_view rest() const { return rest_; }

 private:
  absl::string_view rest_;
};

// The whole token as a number; "nan", "inf" and overflow (as infinity) count as
// numbers.
bool ParseDouble(absl::string_view token, double* value);
// The same, but only finite numbers.
bool ParseFinite(absl::string_view token, double* value);
// The same, but only values of at most 1e9 in magnitude, so that sums and
// squares of metres, seconds and radians stay accurate.
bool ParseCoordinate(absl::string_view token, double* value);
bool ParseInt(absl::string_view token, int64_t* value);

// Seconds as decimal text, to the nanosecond (a double keeps only about 100 ns
// of seconds since 1970). Between 0 and 9e9 seconds (the year 2255).
bool ParseTime(absl::string_view token, TimeNs* time);

// Seconds with nine decimals; exact.
std::string FormatTime(TimeNs time);

// The fewest of 15 to 17 significant digits that give the same double again.
std::string FormatDouble(double value);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_TOKENS_H_
