// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/large_pages.h"

#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr size_t kLargePage = 2 << 20;

}  // namespace

void* AllocateOnLargePages(const size_t bytes) {
  if (bytes < kLargePage / 2) {
    void* const memory = std::malloc(bytes == 0 ? 1 : bytes);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
  }
  const size_t rounded = (bytes + kLargePage - 1) / kLargePage * kLargePage;
  void* memory = nullptr;
  if (rounded < bytes || posix_memalign(&memory, kLargePage, rounded) != 0) {
    throw std::bad_alloc();
  }
#ifdef MADV_HUGEPAGE
  // Advice; without it the memory is the same, but slower.
  madvise(memory, rounded, MADV_HUGEPAGE);
#endif
  return memory;
}

}  // namespace optimization
}  // namespace cartographer_ext
