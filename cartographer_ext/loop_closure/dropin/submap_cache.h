// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Data derived from the grids of submaps for search and verification:
// correlative matchers and occupancy views. A matcher takes several times the
// memory of its grid and is built in milliseconds, so only the most recently
// used ones are kept, up to a limit, and the others are rebuilt from their
// grids when they are needed. Grids of finished submaps do not change, so the
// results are the same for any limit.
//
// Thread-safe. If two threads request the same object, one waits for the other.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_CACHE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_CACHE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/proto/scan_matching/fast_correlative_scan_matcher_options_2d.pb.h"
#include "cartographer_ext/loop_closure/candidate_search/lru_cache.h"
#include "cartographer_ext/loop_closure/dropin/submap_matcher.h"
#include "cartographer_ext/loop_closure/verification/occupancy_view.h"
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"

namespace cartographer_ext {
namespace loop_closure {

// The object of one submap, if in use.
template <typename Value>
struct CachedOfSubmap {
  absl::Mutex mutex;  // held while it is built
  std::weak_ptr<const Value> in_use ABSL_GUARDED_BY(mutex);
};

// A submap with its cached objects.
struct CachedSubmap {
  CachedSubmap(const int64_t number_in,
               const cartographer::mapping::Submap2D* const submap_in)
      : number(number_in), submap(submap_in) {}

  const int64_t number;  // unique over the lifetime of the cache
  const cartographer::mapping::Submap2D* const submap;  // finished
  CachedOfSubmap<SubmapMatcher> matcher;
  CachedOfSubmap<PlaceMatcher> places;
  CachedOfSubmap<OccupancyView> view;
};

// The cache, see above. Thread-safe.
class SubmapCache {
 public:
  // `max_bytes` bounds what is kept, not what is in use at a time.
  SubmapCache(const cartographer::mapping::scan_matching::proto::
                  FastCorrelativeScanMatcherOptions2D& matcher_options,
              const TemporalVerificationOptions& temporal_options,
              size_t max_bytes);

  // Never null.
  std::shared_ptr<const SubmapMatcher> Matcher(CachedSubmap* submap);
  std::shared_ptr<const PlaceMatcher> Places(CachedSubmap* submap);
  std::shared_ptr<const OccupancyView> View(CachedSubmap* submap);
  // Removes a submap that is no longer needed.
  void Erase(const CachedSubmap& submap);

  size_t bytes() const;  // kept

 private:
  enum class Kind { kMatcher, kPlaces, kView };
  using Key = std::pair<int64_t, Kind>;

  template <typename Value>
  std::shared_ptr<const Value> Get(
      const Key& key, CachedOfSubmap<Value>* cached,
      const std::function<std::shared_ptr<const Value>()>& build);

  const cartographer::mapping::scan_matching::proto::
      FastCorrelativeScanMatcherOptions2D matcher_options_;
  const TemporalVerificationOptions temporal_options_;
  mutable absl::Mutex mutex_;
  LruCache<Key, void> kept_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_CACHE_H_
