// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Reading of whole files that may be no files: a device does not end, and a file
// may be larger than anything that makes sense.
#ifndef CARTOGRAPHER_EXT_COMMON_BOUNDED_READ_H_
#define CARTOGRAPHER_EXT_COMMON_BOUNDED_READ_H_

#include <cstddef>
#include <istream>
#include <string>

namespace cartographer_ext {

// Appends the stream to `content` until it ends or `content` has more than
// `limit` bytes, which tells the caller that there is too much; it then has at
// most 64 KiB more. Can be called again with a larger limit to read on. False
// if reading failed.
bool ReadUpTo(size_t limit, std::istream* stream, std::string* content);

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_BOUNDED_READ_H_
