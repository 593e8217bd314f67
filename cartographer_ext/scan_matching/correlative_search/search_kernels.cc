// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/search_kernels.h"

#include "cartographer_ext/scan_matching/correlative_search/search_kernels_plain.h"
#include "cartographer_ext/scan_matching/correlative_search/search_kernels_x86.h"

namespace cartographer_ext {
namespace scan_matching {

const SearchKernels& BestSearchKernels() {
  static const SearchKernels* const best = AllSearchKernels().back();
  return *best;
}

std::vector<const SearchKernels*> AllSearchKernels() {
  std::vector<const SearchKernels*> all = {&PlainSearchKernels()};
  for (const SearchKernels* const kernels : X86SearchKernels()) {
    all.push_back(kernels);
  }
  return all;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
