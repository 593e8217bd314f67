// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_SLAM_RESOURCE_USAGE_H_
#define CARTOGRAPHER_EXT_SLAM_RESOURCE_USAGE_H_

#include <cstdint>

namespace cartographer_ext {
namespace evaluation {

// CPU seconds of all threads of this process so far, user and system.
double ProcessCpuSeconds();

// Largest resident memory of this process so far, in bytes.
int64_t PeakMemoryBytes();

// Resets the peak and returns the current resident memory, in bytes. If the
// system does not support this (Linux only), the peak continues to count from
// the start of the process.
int64_t ResetPeakMemory();

// Largest resident memory since ResetPeakMemory, in bytes.
int64_t PeakMemorySinceReset();

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_RESOURCE_USAGE_H_
