// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/search_kernels_plain.h"

#include <string>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

// All kernels are tested in search_kernels_test.cc, these as the first of the
// sets; the functions by name are what the other sets end with.
TEST(SearchKernelsPlainTest, TheSetConsistsOfTheFunctions) {
  const SearchKernels& kernels = PlainSearchKernels();
  EXPECT_EQ(std::string(kernels.name), "plain");
  EXPECT_EQ(&kernels, AllSearchKernels().front());
  EXPECT_EQ(kernels.find_cells, &plain::FindCells);
  EXPECT_EQ(kernels.sum_values, &plain::SumValues);
  EXPECT_EQ(kernels.find_places, &plain::FindPlaces);
  EXPECT_EQ(kernels.split_columns, &plain::SplitColumns);
  EXPECT_EQ(kernels.round_up, &plain::RoundUp);
}

TEST(SearchKernelsPlainTest, NothingToDo) {
  std::vector<int32_t> places(8, 7);
  EXPECT_EQ(
      plain::FindPlaces(3, 3, 3, nullptr, nullptr, 0, 0, 0, places.data()), 0);
  EXPECT_EQ(plain::SumValues(nullptr, 3, 3, nullptr, nullptr, 0, 0, 0), 0);
  EXPECT_EQ(places, std::vector<int32_t>(8, 7));
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
