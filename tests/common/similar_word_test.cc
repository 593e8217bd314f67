// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/similar_word.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

TEST(SimilarWordTest, FindsTheNearest) {
  const std::vector<std::string> names = {"min_range", "max_range", "min_z"};
  EXPECT_EQ(SimilarWord("max_rnage", names), "max_range");
  EXPECT_EQ(SimilarWord("minrange", names), "min_range");
  EXPECT_EQ(SimilarWord("min_zz", names), "min_z");
  // The first of two at the same distance.
  EXPECT_EQ(SimilarWord("mn_range", names), "min_range");
}

TEST(SimilarWordTest, DidYouMean) {
  EXPECT_EQ(DidYouMean("min_z"), ", did you mean 'min_z'?");
  EXPECT_EQ(DidYouMean(""), "");
}

TEST(SimilarWordTest, SaysNothingRatherThanNonsense) {
  EXPECT_EQ(SimilarWord("voxel", {"min_range", "max_range"}), "");
  EXPECT_EQ(SimilarWord("x", {}), "");
}

}  // namespace
}  // namespace cartographer_ext
