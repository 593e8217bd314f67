// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/expansion_budget.h"

#include <algorithm>
#include <atomic>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr int64_t kFree = 64 << 20;  // bytes
constexpr int64_t kMost = int64_t{1} << 62;

std::atomic<int64_t> max_expansion{50};

}  // namespace

void SetMaxExpansion(const int64_t factor) { max_expansion = factor; }

ExpansionBudget::ExpansionBudget(const int64_t compressed_size)
    : factor_(max_expansion.load()) {
  const int64_t size = std::max<int64_t>(1, compressed_size);
  left_ = size > (kMost - kFree) / factor_ ? kMost : kFree + factor_ * size;
}

bool ExpansionBudget::Take(const uint64_t bytes) {
  if (bytes > left_) {
    left_ = 0;
    return false;
  }
  left_ -= bytes;
  return true;
}

absl::Status ExpansionBudget::Error(const std::string& filename) const {
  return absl::ResourceExhaustedError(
      absl::StrCat(filename, ": expands to more than ", factor_,
                   " times its size; -max_expansion allows more"));
}

}  // namespace io
}  // namespace cartographer_ext
