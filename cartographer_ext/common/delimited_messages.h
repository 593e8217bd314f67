// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A sequence of length-delimited protobuf messages: a varint length, then the
// message. Any protobuf library can read them.
#ifndef CARTOGRAPHER_EXT_COMMON_DELIMITED_MESSAGES_H_
#define CARTOGRAPHER_EXT_COMMON_DELIMITED_MESSAGES_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "google/protobuf/io/coded_stream.h"

namespace cartographer_ext {

// Appends one message.
template <typename Message>
void AppendDelimited(const Message& message, std::string* const bytes) {
  const std::string serialized = message.SerializeAsString();
  uint64_t length = serialized.size();
  while (length >= 0x80) {
    bytes->push_back(static_cast<char>(0x80 | (length & 0x7f)));
    length >>= 7;
  }
  bytes->push_back(static_cast<char>(length));
  bytes->append(serialized);
}

// Parses all messages; DataLoss with the byte offset if they are truncated or
// cannot be decoded. `what` names a message in the error.
template <typename Message>
absl::StatusOr<std::vector<Message>> ParseDelimited(
    const absl::string_view bytes, const absl::string_view what) {
  std::vector<Message> messages;
  size_t offset = 0;
  while (offset < bytes.size()) {
    const absl::string_view rest = bytes.substr(offset);
    // A varint has at most ten bytes.
    google::protobuf::io::CodedInputStream stream(
        reinterpret_cast<const uint8_t*>(rest.data()),
        static_cast<int>(std::min<size_t>(rest.size(), 10)));
    uint64_t length = 0;
    const bool has_length = stream.ReadVarint64(&length);
    const size_t begin = static_cast<size_t>(stream.CurrentPosition());
    if (!has_length || length > rest.size() - begin ||
        length > static_cast<uint64_t>(std::numeric_limits<int>::max())) {
      return absl::DataLossError(
          absl::StrCat(what, " cut off at byte ", offset));
    }
    Message message;
    if (!message.ParseFromArray(rest.data() + begin,
                                static_cast<int>(length))) {
      return absl::DataLossError(
          absl::StrCat(what, " at byte ", offset, " does not decode"));
    }
    messages.push_back(message);
    offset += begin + static_cast<size_t>(length);
  }
  return messages;
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_DELIMITED_MESSAGES_H_
