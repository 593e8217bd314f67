// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Some editors put the three bytes of a byte order mark in front of UTF-8 text.
// They are invisible and belong to no word of a file.
#ifndef CARTOGRAPHER_EXT_COMMON_BYTE_ORDER_MARK_H_
#define CARTOGRAPHER_EXT_COMMON_BYTE_ORDER_MARK_H_

#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"

namespace cartographer_ext {

inline absl::string_view WithoutByteOrderMark(const absl::string_view text) {
  return absl::StripPrefix(text, "\xef\xbb\xbf");
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_BYTE_ORDER_MARK_H_
