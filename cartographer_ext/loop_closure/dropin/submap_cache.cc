// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/submap_cache.h"

#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::scan_matching::proto::
    FastCorrelativeScanMatcherOptions2D;

size_t MemoryBytes(const SubmapMatcher& matcher) {
  return matcher.MemoryBytes();
}
size_t MemoryBytes(const PlaceMatcher& places) { return places.MemoryBytes(); }
size_t MemoryBytes(const OccupancyView& view) { return view.memory_bytes(); }

}  // namespace

SubmapCache::SubmapCache(
    const FastCorrelativeScanMatcherOptions2D& matcher_options,
    const TemporalVerificationOptions& temporal_options, const size_t max_bytes)
    : matcher_options_(matcher_options),
      temporal_options_(temporal_options),
      kept_(max_bytes) {}

template <typename Value>
std::shared_ptr<const Value> SubmapCache::Get(
    const Key& key, CachedOfSubmap<Value>* const cached,
    const std::function<std::shared_ptr<const Value>()>& build) {
  absl::MutexLock build_lock(&cached->mutex);
  {
    absl::MutexLock lock(&mutex_);
    const std::shared_ptr<const void> kept = kept_.Find(key);
    if (kept != nullptr) return std::static_pointer_cast<const Value>(kept);
  }
  std::shared_ptr<const Value> value = cached->in_use.lock();
  if (value == nullptr) {
    value = build();
    cached->in_use = value;
  }
  absl::MutexLock lock(&mutex_);
  kept_.Insert(key, value, MemoryBytes(*value));
  ConstraintMetrics::Global()->cache_bytes->Set(
      static_cast<double>(kept_.bytes()));
  return value;
}

std::shared_ptr<const SubmapMatcher> SubmapCache::Matcher(
    CachedSubmap* const submap) {
  return Get<SubmapMatcher>(Key(submap->number, Kind::kMatcher),
                            &submap->matcher, [this, submap]() {
                              return std::make_shared<const SubmapMatcher>(
                                  *submap->submap->grid(), matcher_options_);
                            });
}

std::shared_ptr<const PlaceMatcher> SubmapCache::Places(
    CachedSubmap* const submap) {
  return Get<PlaceMatcher>(Key(submap->number, Kind::kPlaces), &submap->places,
                           [this, submap]() {
                             return std::make_shared<const PlaceMatcher>(
                                 *submap->submap->grid(), matcher_options_);
                           });
}

std::shared_ptr<const OccupancyView> SubmapCache::View(
    CachedSubmap* const submap) {
  return Get<OccupancyView>(
      Key(submap->number, Kind::kView), &submap->view, [this, submap]() {
        return std::make_shared<OccupancyView>(
            MakeReferenceView(temporal_options_, *submap->submap->grid()));
      });
}

void SubmapCache::Erase(const CachedSubmap& submap) {
  absl::MutexLock lock(&mutex_);
  kept_.Erase(Key(submap.number, Kind::kMatcher));
  kept_.Erase(Key(submap.number, Kind::kPlaces));
  kept_.Erase(Key(submap.number, Kind::kView));
  ConstraintMetrics::Global()->cache_bytes->Set(
      static_cast<double>(kept_.bytes()));
}

size_t SubmapCache::bytes() const {
  absl::MutexLock lock(&mutex_);
  return kept_.bytes();
}

}  // namespace loop_closure
}  // namespace cartographer_ext
