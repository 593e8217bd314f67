// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/port.h"

#include <zlib.h>

#include <cstring>
#include <vector>

#include "glog/logging.h"

namespace cartographer {
namespace common {

namespace {

constexpr size_t kChunkSize = 1 << 16;
constexpr int kGzipWindowBits = 15 + 16;  // 16: gzip header and trailer

}  // namespace

void FastGzipString(const std::string& uncompressed, std::string* compressed) {
  FastGzipPieces(
      [&uncompressed](const std::function<void(const std::string&)>& write) {
        write(uncompressed);
      },
      compressed);
}

void FastGzipPieces(
    const std::function<void(const std::function<void(const std::string&)>&)>&
        pieces,
    std::string* const compressed) {
  z_stream stream;
  std::memset(&stream, 0, sizeof(stream));
  CHECK_EQ(deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kGzipWindowBits, 8,
                        Z_DEFAULT_STRATEGY),
           Z_OK);
  static thread_local std::vector<char> buffer(kChunkSize);
  const auto deflate_all = [&](const std::string& piece, const int flush) {
    // Sizes of zlib are 32 bits wide.
    CHECK_LT(piece.size(), size_t{1} << 31) << "message too large";
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
    stream.avail_in = static_cast<uInt>(piece.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
      stream.avail_out = static_cast<uInt>(buffer.size());
      CHECK_NE(deflate(&stream, flush), Z_STREAM_ERROR);
      compressed->append(buffer.data(), buffer.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  };
  pieces([&](const std::string& piece) { deflate_all(piece, Z_NO_FLUSH); });
  deflate_all("", Z_FINISH);
  deflateEnd(&stream);
}

void FastGunzipString(const std::string& compressed,
                      std::string* decompressed) {
  z_stream stream;
  std::memset(&stream, 0, sizeof(stream));
  CHECK_EQ(inflateInit2(&stream, kGzipWindowBits), Z_OK);
  stream.next_in =
      reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
  stream.avail_in = compressed.size();
  int result = Z_OK;
  while (result == Z_OK) {
    const size_t old_size = decompressed->size();
    decompressed->resize(old_size + kChunkSize);
    stream.next_out = reinterpret_cast<Bytef*>(&(*decompressed)[old_size]);
    stream.avail_out = kChunkSize;
    result = inflate(&stream, Z_NO_FLUSH);
    decompressed->resize(old_size + kChunkSize - stream.avail_out);
    // Another member may follow.
    if (result == Z_STREAM_END && stream.avail_in > 0) {
      result = inflateReset(&stream);
    }
  }
  inflateEnd(&stream);
  CHECK_EQ(result, Z_STREAM_END) << "broken gzip data";
}

}  // namespace common
}  // namespace cartographer
