// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Counts malformed lines and remembers the first of them.
#ifndef CARTOGRAPHER_EXT_IO_CARMEN_MALFORMED_LINES_H_
#define CARTOGRAPHER_EXT_IO_CARMEN_MALFORMED_LINES_H_

#include <cstdint>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace io {

struct MalformedLines {
  int64_t count = 0;
  std::string first;  // its place and error

  void Add(const absl::string_view location, const absl::string_view error) {
    if (count++ == 0) first = absl::StrCat(location, ": ", error);
  }
  void Add(const MalformedLines& other) {
    if (count == 0) first = other.first;
    count += other.count;
  }
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_CARMEN_MALFORMED_LINES_H_
