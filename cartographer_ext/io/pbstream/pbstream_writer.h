// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes Cartographer states that ReadPbstream and Cartographer itself read.
#ifndef CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_WRITER_H_
#define CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_WRITER_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"

namespace cartographer_ext {
namespace io {

// The bytes of the file: the same for the same content.
std::string SerializePbstream(const Pbstream& pbstream);

// Writes the whole file or nothing.
absl::Status WritePbstream(const Pbstream& pbstream,
                           const std::string& filename);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_WRITER_H_
