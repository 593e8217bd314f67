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

// Unix seconds with seven decimals, exact, of ticks >= 0.
inline std::string UnixSecondsOfTicks(const int64_t ticks) {
  constexpr int64_t kTicksPerSecond = 10000000;
  constexpr int64_t kUnixEpochSeconds = INT64_C(719162) * 86400;
  return absl::StrFormat("%d.%07d", ticks / kTicksPerSecond - kUnixEpochSeconds,
                         ticks % kTicksPerSecond);
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_HOST_TICKS_H_
