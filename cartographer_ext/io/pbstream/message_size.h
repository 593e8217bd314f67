// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Estimates the memory of a serialized protobuf message once it is parsed. Two
// bytes can become an object of a hundred, so the serialized size is not a
// bound.
#ifndef CARTOGRAPHER_EXT_IO_PBSTREAM_MESSAGE_SIZE_H_
#define CARTOGRAPHER_EXT_IO_PBSTREAM_MESSAGE_SIZE_H_

#include <cstdint>

#include "absl/strings/string_view.h"
#include "google/protobuf/descriptor.h"

namespace cartographer_ext {
namespace io {

// Bytes of memory of a message of this type, an estimate without the reserve of
// growing arrays. Reads the wire format without allocating; stops where it is
// damaged, as a parser does, and where the estimate exceeds `limit`.
int64_t EstimateParsedSize(const google::protobuf::Descriptor& type,
                           absl::string_view bytes, int64_t limit);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_PBSTREAM_MESSAGE_SIZE_H_
