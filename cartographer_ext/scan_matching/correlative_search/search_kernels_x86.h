// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The kernels of search_kernels.h for the vector instructions of x86-64.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_KERNELS_X86_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_KERNELS_X86_H_

#include <vector>

#include "cartographer_ext/scan_matching/correlative_search/search_kernels.h"

namespace cartographer_ext {
namespace scan_matching {

// Those that this machine has, the fastest last; none on other machines.
std::vector<const SearchKernels*> X86SearchKernels();

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_KERNELS_X86_H_
