// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/mcap_format.h"

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr uint64_t kMaxChunkSize = uint64_t{1} << 30;
constexpr size_t kStep = size_t{1} << 18;

absl::Status Damaged(const std::string& what) {
  return absl::DataLossError(
      absl::StrCat("a chunk cannot be decompressed: ", what));
}

// Appends what `decompress` puts out to a string of at most `size` bytes.
//   decompress(out, room, &written) -> empty, or what went wrong; *done
template <typename Decompress>
absl::StatusOr<std::string> Collect(const uint64_t size,
                                    const Decompress& decompress) {
  std::string result;
  std::string step(kStep, '\0');
  bool done = false;
  while (!done) {
    size_t written = 0;
    const std::string error =
        decompress(&step[0], step.size(), &written, &done);
    if (!error.empty()) return Damaged(error);
    if (written > size - result.size())
      return Damaged("it has more data than declared");
    result.append(step, 0, written);
  }
  if (result.size() != size) return Damaged("it has less data than declared");
  return result;
}

absl::StatusOr<std::string> DecompressLz4(absl::string_view data,
                                          const uint64_t size) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)))
    return Damaged("no memory");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)>
      context(raw, &LZ4F_freeDecompressionContext);
  return Collect(size,
                 [&](char* out, const size_t room, size_t* written,
                     bool* done) -> std::string {
                   size_t consumed = data.size();
                   *written = room;
                   const size_t hint =
                       LZ4F_decompress(context.get(), out, written, data.data(),
                                       &consumed, nullptr);
                   if (LZ4F_isError(hint)) return LZ4F_getErrorName(hint);
                   data.remove_prefix(consumed);
                   *done = hint == 0;
                   if (!*done && *written == 0 && consumed == 0)
                     return "it is truncated";
                   return "";
                 });
}

absl::StatusOr<std::string> DecompressZstd(absl::string_view data,
                                           const uint64_t size) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(
      ZSTD_createDCtx(), &ZSTD_freeDCtx);
  if (context == nullptr) return Damaged("no memory");
  ZSTD_inBuffer in{data.data(), data.size(), 0};
  return Collect(size,
                 [&](char* out, const size_t room, size_t* written,
                     bool* done) -> std::string {
                   ZSTD_outBuffer to{out, room, 0};
                   const size_t before = in.pos;
                   const size_t hint =
                       ZSTD_decompressStream(context.get(), &to, &in);
                   if (ZSTD_isError(hint)) return ZSTD_getErrorName(hint);
                   *written = to.pos;
                   *done = hint == 0;
                   if (!*done && to.pos == 0 && in.pos == before)
                     return "it is truncated";
                   return "";
                 });
}

}  // namespace

absl::StatusOr<std::string> McapDecompress(absl::string_view compression,
                                           absl::string_view data,
                                           const uint64_t size) {
  if (size > kMaxChunkSize)
    return Damaged(absl::StrCat("it declares ", size, " bytes"));
  if (compression.empty()) {
    if (size != data.size())
      return Damaged("its size differs from the declared one");
    return std::string(data);
  }
  // Some writers write an empty chunk without a compressed frame.
  if (size == 0 && data.empty()) return std::string();
  if (compression == "lz4") return DecompressLz4(data, size);
  if (compression == "zstd") return DecompressZstd(data, size);
  return absl::UnimplementedError(
      absl::StrCat("a chunk has compression \"", compression,
                   "\"; none, lz4 and zstd are read"));
}

absl::StatusOr<std::string> McapCompress(const std::string& compression,
                                         absl::string_view data) {
  if (compression.empty()) return std::string(data);
  std::string result;
  size_t size;
  if (compression == "lz4") {
    result.resize(LZ4F_compressFrameBound(data.size(), nullptr));
    size = LZ4F_compressFrame(&result[0], result.size(), data.data(),
                              data.size(), nullptr);
    if (LZ4F_isError(size)) return absl::InternalError(LZ4F_getErrorName(size));
  } else if (compression == "zstd") {
    result.resize(ZSTD_compressBound(data.size()));
    size = ZSTD_compress(&result[0], result.size(), data.data(), data.size(),
                         ZSTD_CLEVEL_DEFAULT);
    if (ZSTD_isError(size)) return absl::InternalError(ZSTD_getErrorName(size));
  } else {
    return absl::InvalidArgumentError(absl::StrCat(
        "no compression \"", compression, "\"; there are none, lz4, zstd"));
  }
  result.resize(size);
  return result;
}

uint32_t McapChecksum(absl::string_view data) {
  uLong sum = crc32(0L, Z_NULL, 0);
  while (!data.empty()) {
    const size_t step = std::min<size_t>(data.size(), size_t{1} << 30);
    sum = crc32(sum, reinterpret_cast<const Bytef*>(data.data()),
                static_cast<uInt>(step));
    data.remove_prefix(step);
  }
  return static_cast<uint32_t>(sum);
}

}  // namespace io
}  // namespace cartographer_ext
