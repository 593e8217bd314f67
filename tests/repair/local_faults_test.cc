// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/local_faults.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace repair {
namespace {

TEST(LocalFaultsTest, NamesTheLostTurn) {
  evaluation::MapGraph stored, repaired;
  Pose2 local, right;
  for (int i = 0; i < 100; ++i) {
    auto& node = stored.nodes[{0, i}];
    node.time = (1000 + i) * 1000000000LL;
    node.local_pose = local;
    repaired.nodes[{0, i}].global_pose = Pose2(3., 4., 1.) * right;
    const double turn = i % 25 == 24 ? kPi / 2. : 0.;
    right = right * Pose2(0.3, 0., turn);
    local = local * Pose2(0.3, 0., i == 49 ? turn + 1.6 : turn);
  }
  const auto faults = FindLocalFaults(stored, repaired, LocalFaultOptions());
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NEAR(faults[0].radians, 1.6, 1e-9);
  EXPECT_NEAR(faults[0].seconds, 50., 3.);
  EXPECT_THAT(ToText(faults[0]),
              testing::HasSubstr("turned 92 degrees too far to the left"));
  EXPECT_TRUE(
      FindLocalFaults(stored, evaluation::MapGraph(), LocalFaultOptions())
          .empty());
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
