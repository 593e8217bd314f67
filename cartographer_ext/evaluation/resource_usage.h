// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_EVALUATION_RESOURCE_USAGE_H_
#define CARTOGRAPHER_EXT_EVALUATION_RESOURCE_USAGE_H_

#include <cstdint>

namespace cartographer_ext {
namespace evaluation {

// CPU seconds of all threads of this process so far, user and system.
double ProcessCpuSeconds();

// CPU seconds of the calling thread so far.
double ThreadCpuSeconds();

// Largest resident memory of this process so far, in bytes.
int64_t PeakMemoryBytes();

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EVALUATION_RESOURCE_USAGE_H_
