// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Memory for large arrays, on large pages where the system has them. The first
// access to each page costs thousands of instructions: with pages of 4 KB new
// memory for a factor takes several times as long as the factorisation.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_LARGE_PAGES_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_LARGE_PAGES_H_

#include <cstddef>
#include <cstdlib>
#include <vector>

namespace cartographer_ext {
namespace optimization {

// Memory of so many bytes, to be returned by std::free(): from half a large page
// on aligned to large pages, which are asked for. Pages that are not accessed
// take no memory. Throws std::bad_alloc.
void* AllocateOnLargePages(size_t bytes);

// For containers with this memory.
template <typename T>
class LargePageAllocator {
 public:
  using value_type = T;

  LargePageAllocator() = default;
  template <typename Other>
  LargePageAllocator(const LargePageAllocator<Other>&) {}  // NOLINT

  T* allocate(const size_t size) {
    return static_cast<T*>(AllocateOnLargePages(size * sizeof(T)));
  }
  void deallocate(T* const values, size_t) { std::free(values); }

  friend bool operator==(const LargePageAllocator&, const LargePageAllocator&) {
    return true;
  }
  friend bool operator!=(const LargePageAllocator&, const LargePageAllocator&) {
    return false;
  }
};

template <typename T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_LARGE_PAGES_H_
