// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What compressed data may expand to: a file of a megabyte that holds a
// gigabyte of zeros is no recording.
#ifndef CARTOGRAPHER_EXT_IO_EXPANSION_BUDGET_H_
#define CARTOGRAPHER_EXT_IO_EXPANSION_BUDGET_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"

namespace cartographer_ext {
namespace io {

// Bytes that a byte of a compressed file may expand to, in the mean and after
// the first 64 MB; logs expand 3 to 30 times, bombs a thousand. For all files
// that are opened from now on; above 0.
void SetMaxExpansion(int64_t factor);

// Of one file, or of one reading of it.
class ExpansionBudget {
 public:
  explicit ExpansionBudget(int64_t compressed_size);

  // False once more has been taken than there is.
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
