// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/submap_cache.h"

#include <memory>
#include <thread>
#include <vector>

#include "cartographer/mapping/2d/probability_grid.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

namespace host = cartographer::mapping;

class SubmapCacheTest : public testing::Test {
 protected:
  SubmapCacheTest()
      : submap_(Eigen::Vector2f(1.f, 0.f),
                host::test::RoomGrid(&tables_, 0.05, 5), &tables_) {
    submap_.Finish();
  }

  static std::unique_ptr<SubmapCache> Cache(const size_t max_bytes) {
    return std::make_unique<SubmapCache>(
        host::test::LoadSlamOptions("")
            .map_builder.pose_graph_options()
            .constraint_builder_options()
            .fast_correlative_scan_matcher_options(),
        TemporalVerificationOptions(), max_bytes);
  }

  host::ValueConversionTables tables_;
  host::Submap2D submap_;
};

TEST_F(SubmapCacheTest, KeepsUpToItsLimit) {
  CachedSubmap a(0, &submap_);
  CachedSubmap b(1, &submap_);
  const size_t bytes = Cache(0)->Matcher(&a)->MemoryBytes();
  const auto cache = Cache(bytes);
  const SubmapMatcher* const first = cache->Matcher(&a).get();
  EXPECT_EQ(cache->Matcher(&a).get(), first);
  EXPECT_EQ(cache->bytes(), bytes);
  cache->Matcher(&b);
  EXPECT_EQ(cache->bytes(), bytes);
  EXPECT_TRUE(a.matcher.in_use.expired());
  EXPECT_FALSE(b.matcher.in_use.expired());
  cache->View(&a);
  EXPECT_LT(cache->bytes(), bytes);
  EXPECT_TRUE(b.matcher.in_use.expired());
  cache->Erase(a);
  EXPECT_EQ(cache->bytes(), 0u);
  EXPECT_TRUE(a.view.in_use.expired());
}

TEST_F(SubmapCacheTest, PlacesAreKeptBesideMatchers) {
  CachedSubmap submap(0, &submap_);
  const auto cache = Cache(1 << 30);
  const PlaceMatcher* const places = cache->Places(&submap).get();
  const size_t bytes = cache->bytes();
  EXPECT_EQ(bytes, places->MemoryBytes());
  EXPECT_EQ(cache->Places(&submap).get(), places);
  EXPECT_EQ(cache->bytes(), bytes);
  cache->Matcher(&submap);
  EXPECT_GT(cache->bytes(), bytes);
  EXPECT_EQ(cache->Places(&submap).get(), places);
  cache->Erase(submap);
  EXPECT_EQ(cache->bytes(), 0u);
  EXPECT_TRUE(submap.places.in_use.expired());
}

// What is in use is not built a second time, kept or not.
TEST_F(SubmapCacheTest, BuildsWhatIsInUseOnce) {
  CachedSubmap submap(0, &submap_);
  const auto cache = Cache(0);
  const auto matcher = cache->Matcher(&submap);
  const auto view = cache->View(&submap);
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k) {
    threads.emplace_back([&]() {
      EXPECT_EQ(cache->Matcher(&submap), matcher);
      EXPECT_EQ(cache->View(&submap), view);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(cache->bytes(), 0u);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
