// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/resource_usage.h"

#include <thread>
#include <vector>

#include "cartographer_ext/common/thread_time.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

void Burn(const double seconds) {
  const double start = ThreadCpuSeconds();
  volatile double sum = 0.;
  while (ThreadCpuSeconds() - start < seconds) {
    for (int i = 0; i < 1000; ++i) sum = sum + i;
  }
}

TEST(ResourceUsageTest, CountsTheThreadAndTheProcess) {
  const double thread_before = ThreadCpuSeconds();
  const double process_before = ProcessCpuSeconds();
  std::thread([] { Burn(0.05); }).join();
  EXPECT_LT(ThreadCpuSeconds() - thread_before, 0.04);
  EXPECT_GE(ProcessCpuSeconds() - process_before, 0.05);
  Burn(0.02);
  EXPECT_GE(ThreadCpuSeconds() - thread_before, 0.02);
}

TEST(ResourceUsageTest, PeakMemorySeesALargeBlock) {
  const int64_t before = PeakMemoryBytes();
  EXPECT_GT(before, 1 << 20);
  std::vector<char> block(static_cast<size_t>(before) + (64 << 20), 1);
  EXPECT_EQ(block[block.size() / 2], 1);
  EXPECT_GE(PeakMemoryBytes(), before + (32 << 20));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
