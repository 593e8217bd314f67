// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/thinned.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ThinnedTest, KeepsEvenlySpacedValuesInOrder) {
  EXPECT_THAT(Thinned({7, 3, 9, 1, 5}, 2), ElementsAre(7, 9));
  EXPECT_THAT(Thinned({7, 3, 9, 1, 5}, 3), ElementsAre(7, 3, 1));
}

TEST(ThinnedTest, KeepsAllWithinTheLimit) {
  EXPECT_THAT(Thinned({7, 3, 9}, 3), ElementsAre(7, 3, 9));
  EXPECT_THAT(Thinned({}, 3), IsEmpty());
  EXPECT_THAT(Thinned({7, 3}, 0), IsEmpty());
}

}  // namespace
}  // namespace cartographer_ext
