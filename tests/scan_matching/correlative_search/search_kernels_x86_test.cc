// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/search_kernels_x86.h"

#include <string>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

// That they do the same as the plain ones is tested in search_kernels_test.cc.
TEST(SearchKernelsX86Test, AreTheFastestOfAll) {
  const std::vector<const SearchKernels*> kernels = X86SearchKernels();
  const std::vector<const SearchKernels*> all = AllSearchKernels();
  ASSERT_EQ(all.size(), 1 + kernels.size());
  for (size_t i = 0; i != kernels.size(); ++i) {
    EXPECT_EQ(all[i + 1], kernels[i]);
  }
  EXPECT_EQ(&BestSearchKernels(), all.back());
#ifdef __x86_64__
  ASSERT_FALSE(kernels.empty());
  EXPECT_EQ(std::string(kernels.front()->name), "sse2");
#endif
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
