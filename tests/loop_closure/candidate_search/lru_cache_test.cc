// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/lru_cache.h"

#include <string>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using Cache = LruCache<int, std::string>;

std::shared_ptr<const std::string> Text(const std::string& text) {
  return std::make_shared<const std::string>(text);
}

TEST(LruCacheTest, DropsWhatWasUsedLongestAgo) {
  Cache cache(100);
  cache.Insert(1, Text("one"), 40);
  cache.Insert(2, Text("two"), 40);
  ASSERT_NE(cache.Find(1), nullptr);
  cache.Insert(3, Text("three"), 40);
  EXPECT_EQ(cache.Find(2), nullptr);
  ASSERT_NE(cache.Find(1), nullptr);
  EXPECT_EQ(*cache.Find(1), "one");
  EXPECT_EQ(*cache.Find(3), "three");
  EXPECT_EQ(cache.bytes(), 80u);
  // As many as it takes.
  cache.Insert(4, Text("four"), 90);
  EXPECT_EQ(cache.size(), 1u);
  EXPECT_EQ(cache.bytes(), 90u);
}

TEST(LruCacheTest, WhatIsAboveTheLimitDropsNothing) {
  Cache cache(100);
  cache.Insert(1, Text("one"), 100);
  cache.Insert(2, Text("two"), 101);
  EXPECT_EQ(cache.Find(2), nullptr);
  EXPECT_NE(cache.Find(1), nullptr);
  Cache none(0);
  none.Insert(1, Text("one"), 1);
  EXPECT_EQ(none.Find(1), nullptr);
}

TEST(LruCacheTest, ReplacesAndErases) {
  Cache cache(100);
  cache.Insert(1, Text("one"), 60);
  cache.Insert(1, Text("uno"), 70);
  EXPECT_EQ(cache.bytes(), 70u);
  EXPECT_EQ(*cache.Find(1), "uno");
  const std::shared_ptr<const std::string> held = cache.Find(1);
  cache.Erase(1);
  cache.Erase(1);
  EXPECT_EQ(cache.bytes(), 0u);
  EXPECT_EQ(cache.size(), 0u);
  EXPECT_EQ(*held, "uno");
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
