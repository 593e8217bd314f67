// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_COMMON_THREAD_TIME_H_
#define CARTOGRAPHER_EXT_COMMON_THREAD_TIME_H_

#include <time.h>

namespace cartographer_ext {

// CPU seconds of the calling thread; 0 if the system does not measure them.
inline double ThreadCpuSeconds() {
  timespec spent;
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent) != 0) return 0.;
  return static_cast<double>(spent.tv_sec) +
         1e-9 * static_cast<double>(spent.tv_nsec);
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_THREAD_TIME_H_
