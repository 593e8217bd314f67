// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/resource_usage.h"

#include <sys/resource.h>
#include <time.h>

#include <fstream>
#include <string>

namespace cartographer_ext {
namespace evaluation {
namespace {

double Seconds(const clockid_t clock) {
  timespec time = {};
  if (clock_gettime(clock, &time) != 0) return 0.;
  return static_cast<double>(time.tv_sec) +
         1e-9 * static_cast<double>(time.tv_nsec);
}

// A line such as "VmHWM:   1234 kB" of the status of this process; -1 where
// there is none.
int64_t StatusBytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.compare(0, key.size() + 1, key + ":") != 0) continue;
    return std::stoll(line.substr(key.size() + 1)) * 1024;
  }
  return -1;
}

}  // namespace

double ProcessCpuSeconds() { return Seconds(CLOCK_PROCESS_CPUTIME_ID); }

int64_t PeakMemoryBytes() {
  rusage usage = {};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<int64_t>(usage.ru_maxrss) * 1024;  // given in KiB
}

int64_t ResetPeakMemory() {
  // "5" sets the high water mark back to what is resident now.
  std::ofstream("/proc/self/clear_refs") << "5";
  const int64_t resident = StatusBytes("VmRSS");
  return resident >= 0 ? resident : PeakMemoryBytes();
}

int64_t PeakMemorySinceReset() {
  const int64_t peak = StatusBytes("VmHWM");
  return peak >= 0 ? peak : PeakMemoryBytes();
}

}  // namespace evaluation
}  // namespace cartographer_ext
