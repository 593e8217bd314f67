// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/bounded_read.h"

#include <vector>

namespace cartographer_ext {

bool ReadUpTo(const size_t limit, std::istream* const stream,
              std::string* const content) {
  std::vector<char> block(1 << 16);
  while (content->size() <= limit && *stream) {
    stream->read(block.data(), static_cast<std::streamsize>(block.size()));
    content->append(block.data(), static_cast<size_t>(stream->gcount()));
  }
  return !stream->bad();
}

}  // namespace cartographer_ext
