// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Least recently used cache with a limit in bytes. A dropped value remains
// valid for its current users and is recreated when it is needed again.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_LRU_CACHE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_LRU_CACHE_H_

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <utility>

namespace cartographer_ext {
namespace loop_closure {

// The cache. Not thread-safe.
template <typename Key, typename Value>
class LruCache {
 public:
  explicit LruCache(const size_t max_bytes) : max_bytes_(max_bytes) {}

  // Null if the key is not cached. Counts as a use.
  std::shared_ptr<const Value> Find(const Key& key) {
    const auto it = places_.find(key);
    if (it == places_.end()) return nullptr;
    kept_.splice(kept_.begin(), kept_, it->second);
    return it->second->value;
  }

  // Adds the value as the most recently used one and drops the least recently
  // used ones until the limit is met. A value larger than the limit is not
  // kept.
  void Insert(const Key& key, std::shared_ptr<const Value> value,
              const size_t bytes) {
    Erase(key);
    if (bytes > max_bytes_) return;
    kept_.push_front(Kept{key, std::move(value), bytes});
    places_[key] = kept_.begin();
    bytes_ += bytes;
    while (bytes_ > max_bytes_) {
      const Key last = kept_.back().key;
      Erase(last);
    }
  }

  void Erase(const Key& key) {
    const auto it = places_.find(key);
    if (it == places_.end()) return;
    bytes_ -= it->second->bytes;
    kept_.erase(it->second);
    places_.erase(it);
  }

  size_t size() const { return kept_.size(); }
  size_t bytes() const { return bytes_; }

 private:
  struct Kept {
    Key key;
    std::shared_ptr<const Value> value;
    size_t bytes;
  };

  const size_t max_bytes_;
  size_t bytes_ = 0;
  std::list<Kept> kept_;  // the last one used first
  std::map<Key, typename std::list<Kept>::iterator> places_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_LRU_CACHE_H_
