// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Limits the expansion of compressed data: a megabyte that expands to a
// gigabyte of zeros is not a recording.
#ifndef CARTOGRAPHER_EXT_IO_EXPANSION_BUDGET_H_
#define CARTOGRAPHER_EXT_IO_EXPANSION_BUDGET_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"

namespace cartographer_ext {
namespace io {

// Mean expansion factor allowed for a compressed file, after the first 64 MB;
// logs expand 3 to 30 times, decompression bombs a thousand times. For all
// files opened from now on; above 0.
void SetMaxExpansion(int64_t factor);

// Of one file, or of one reading of it.
class ExpansionBudget {
 public:
  explicit ExpansionBudget(int64_t compressed_size);

  // False once the budget is exceeded.
  bool Take(uint64_t bytes);

  // ResourceExhausted, names the file and the flag that allows more.
  absl::Status Error(const std::string& filename) const;

 private:
  const int64_t factor_;
  uint64_t left_;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_EXPANSION_BUDGET_H_
