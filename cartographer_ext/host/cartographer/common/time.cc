// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/time.h"

#include <time.h>

#include <cmath>
#include <limits>
#include <string>

#include "glog/logging.h"

namespace cartographer {
namespace common {

Duration FromSeconds(const double seconds) {
  const double ticks = seconds * 1e7;
  // The conversion of values beyond the range is undefined.
  if (std::isnan(ticks)) return Duration::zero();
  if (ticks >= 9.2e18) return Duration::max();
  if (ticks <= -9.2e18) return Duration::min();
  return Duration(static_cast<int64>(ticks));
}

Duration FromMilliseconds(const int64 milliseconds) {
  return std::chrono::duration_cast<Duration>(
      std::chrono::milliseconds(milliseconds));
}

double ToSeconds(const Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

double ToSeconds(const std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

Time FromUniversal(const int64 ticks) { return Time(Duration(ticks)); }

int64 ToUniversal(const Time time) { return time.time_since_epoch().count(); }

std::ostream& operator<<(std::ostream& os, const Time time) {
  return os << ToUniversal(time);
}

double GetThreadCpuTimeSeconds() {
  timespec spent;
  CHECK_EQ(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent), 0);
  return static_cast<double>(spent.tv_sec) + 1e-9 * spent.tv_nsec;
}

}  // namespace common
}  // namespace cartographer
