// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/evaluation/resource_usage.h"

#include <sys/resource.h>
#include <time.h>

namespace cartographer_ext {
namespace evaluation {
namespace {

double Seconds(const clockid_t clock) {
  timespec time = {};
  if (clock_gettime(clock, &time) != 0) return 0.;
  return static_cast<double>(time.tv_sec) +
         1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

double ProcessCpuSeconds() { return Seconds(CLOCK_PROCESS_CPUTIME_ID); }

double ThreadCpuSeconds() { return Seconds(CLOCK_THREAD_CPUTIME_ID); }

int64_t PeakMemoryBytes() {
  rusage usage = {};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<int64_t>(usage.ru_maxrss) * 1024;  // given in KiB
}

}  // namespace evaluation
}  // namespace cartographer_ext
