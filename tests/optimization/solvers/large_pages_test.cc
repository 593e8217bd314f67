// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/large_pages.h"

#include <cstdint>
#include <limits>
#include <new>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr size_t kLargePage = 2 << 20;

bool IsOnALargePage(const void* const memory) {
  return reinterpret_cast<uintptr_t>(memory) % kLargePage == 0;
}

TEST(LargePagesTest, LargeArraysBeginWithALargePage) {
  for (const size_t bytes :
       {kLargePage / 2, kLargePage - 1, kLargePage, 3 * kLargePage + 1}) {
    char* const memory = static_cast<char*>(AllocateOnLargePages(bytes));
    EXPECT_TRUE(IsOnALargePage(memory)) << bytes;
    memory[0] = 1;
    memory[bytes - 1] = 2;
    EXPECT_EQ(memory[0] + memory[bytes - 1], 3);
    std::free(memory);
  }
}

TEST(LargePagesTest, SmallArraysShareLargePages) {
  // Each with one of its own would take a thousand times as much memory.
  void* const first = AllocateOnLargePages(1000);
  void* const second = AllocateOnLargePages(0);
  EXPECT_FALSE(IsOnALargePage(first) && IsOnALargePage(second));
  EXPECT_NE(first, second);
  std::free(first);
  std::free(second);
}

TEST(LargePagesTest, WhatDoesNotExistIsRefused) {
  EXPECT_THROW(AllocateOnLargePages(std::numeric_limits<size_t>::max()),
               std::bad_alloc);
  EXPECT_THROW(AllocateOnLargePages(std::numeric_limits<size_t>::max() / 2),
               std::bad_alloc);
}

TEST(LargePagesTest, AVectorGrowsAndIsCopied) {
  LargeVector<double> values;
  for (int i = 0; i != 500000; ++i) values.push_back(i);
  EXPECT_TRUE(IsOnALargePage(values.data()));
  const LargeVector<double> copy = values;
  values.clear();
  values.shrink_to_fit();
  EXPECT_EQ(copy[499999], 499999.);
  EXPECT_TRUE(IsOnALargePage(copy.data()));
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
