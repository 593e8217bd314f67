// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_COMMON_THINNED_H_
#define CARTOGRAPHER_EXT_COMMON_THINNED_H_

#include <cstddef>
#include <vector>

namespace cartographer_ext {

// At most `limit` of the values, evenly spaced and in their order; the first
// among them. All if there are no more.
template <typename T = int>
inline std::vector<T> Thinned(const std::vector<T>& values,
                              const size_t limit) {
  if (values.size() <= limit) return values;
  std::vector<T> result;
  result.reserve(limit);
  for (size_t k = 0; k != limit; ++k) {
    result.push_back(values[k * values.size() / limit]);
  }
  return result;
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_THINNED_H_
