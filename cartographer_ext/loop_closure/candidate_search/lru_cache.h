// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the values that were used last, up to a limit in bytes. What is dropped
// lives on with whoever still holds it, and is made again when it is needed.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_LRU_CACHE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_LRU_CACHE_H_

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <utility>

namespace cartographer_ext {
namespace loop_closure {

// Not thread-safe.
template <typename Key, typename Value>
class LruCache {
 public:
  explicit LruCache(const size_t max_bytes) : max_bytes_(max_bytes) {}

  // Null for a key that is not kept. Counts as a use.
  std::shared_ptr<const Value> Find(const Key& key) {
    const auto it = places_.find(key);
    if (it == places_.end()) return nullptr;
    kept_.splice(kept_.begin(), kept_, it->second);
    return it->second->value;
  }

  // Keeps the value as the last one used, and drops others, those used longest
  // ago first, until the limit is met. A value above the limit is not kept.
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
