// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Cartographer counts ticks of 100 ns since the year 1 (UTC); tables and other
// programs use Unix seconds.
#ifndef CARTOGRAPHER_EXT_COMMON_HOST_TICKS_H_
#define CARTOGRAPHER_EXT_COMMON_HOST_TICKS_H_

#include <cstdint>
#include <string>

#include "absl/strings/str_format.h"

namespace cartographer_ext {

constexpr int64_t kHostTicksPerSecond = 10000000;
constexpr int64_t kUnixEpochSeconds = INT64_C(719162) * 86400;
constexpr int64_t kUnixEpochTicks = kUnixEpochSeconds * kHostTicksPerSecond;
// 146 years: the difference of any two times that are so far from 1970 is still
// a number of nanoseconds of 64 bits.
constexpr int64_t kEraTicks = (INT64_C(1) << 62) / 100;
constexpr int64_t kMaxHostTicks = kUnixEpochTicks + kEraTicks;

// Whether a file may hold these: a clock shows the date, or it began at the
// start of the count, in the year 1.
constexpr bool AreHostTicks(const int64_t ticks) {
  return ticks >= 0 && ticks <= kMaxHostTicks &&
         (ticks <= kEraTicks || ticks >= kUnixEpochTicks - kEraTicks);
}

// Unix seconds with seven decimals, exact, of ticks >= 0.
inline std::string UnixSecondsOfTicks(const int64_t ticks) {
  return absl::StrFormat("%d.%07d",
                         ticks / kHostTicksPerSecond - kUnixEpochSeconds,
                         ticks % kHostTicksPerSecond);
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_HOST_TICKS_H_
