// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Integer names, rounding and gzip.
#ifndef CARTOGRAPHER_COMMON_PORT_H_
#define CARTOGRAPHER_COMMON_PORT_H_

#include <cinttypes>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

namespace cartographer {

using int8 = int8_t;
using int16 = int16_t;
using int32 = int32_t;
using int64 = int64_t;
using uint8 = uint8_t;
using uint16 = uint16_t;
using uint32 = uint32_t;
using uint64 = uint64_t;

namespace common {

// Nearest integer; halves go away from zero.
inline int RoundToInt(float x) { return static_cast<int>(std::lround(x)); }
inline int RoundToInt(double x) { return static_cast<int>(std::lround(x)); }
inline int64 RoundToInt64(float x) { return std::llround(x); }
inline int64 RoundToInt64(double x) { return std::llround(x); }

// Appends one gzip member (fastest level, no name, no time) to `compressed`.
void FastGzipString(const std::string& uncompressed, std::string* compressed);

// The same of a text in pieces: `pieces` passes them to the function that it is
// given.
void FastGzipPieces(
    const std::function<void(const std::function<void(const std::string&)>&)>&
        pieces,
    std::string* compressed);

// Appends the content of a gzip file to `decompressed`. Broken data is fatal.
void FastGunzipString(const std::string& compressed, std::string* decompressed);

}  // namespace common

}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_PORT_H_
