// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_COMMON_TIME_H_
#define CARTOGRAPHER_COMMON_TIME_H_

#include <chrono>
#include <ostream>
#include <ratio>

#include "cartographer/common/port.h"

namespace cartographer {
namespace common {

// Seconds from 0001-01-01 to 1970-01-01, both UTC.
constexpr int64 kUtsEpochOffsetFromUnixEpochInSeconds = 719162ll * 86400ll;

// Counts ticks of 100 ns since the start of the year 1, leap seconds ignored.
struct UniversalTimeScaleClock {
  using rep = int64;
  using period = std::ratio<1, 10000000>;
  using duration = std::chrono::duration<rep, period>;
  using time_point = std::chrono::time_point<UniversalTimeScaleClock>;
  static constexpr bool is_steady = true;
};

using Duration = UniversalTimeScaleClock::duration;
using Time = UniversalTimeScaleClock::time_point;

// Truncates to whole ticks.
Duration FromSeconds(double seconds);
Duration FromMilliseconds(int64 milliseconds);

double ToSeconds(Duration duration);
double ToSeconds(std::chrono::steady_clock::duration duration);

Time FromUniversal(int64 ticks);
int64 ToUniversal(Time time);

// Prints the ticks.
std::ostream& operator<<(std::ostream& os, Time time);

// CPU seconds spent by the calling thread.
double GetThreadCpuTimeSeconds();

}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_TIME_H_
