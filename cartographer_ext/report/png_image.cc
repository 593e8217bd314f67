// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/png_image.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace report {
namespace {

constexpr uint8_t kUnknownShade = 13;
constexpr uint8_t kWhite = 15;

void AppendBigEndian(const uint32_t value, std::string* const bytes) {
  for (const int shift : {24, 16, 8, 0}) {
    bytes->push_back(static_cast<char>((value >> shift) & 0xff));
  }
}

// Length, type, data and checksum, as every part of a PNG has them.
void AppendChunk(const std::string& type, const std::string& data,
                 std::string* const png) {
  AppendBigEndian(static_cast<uint32_t>(data.size()), png);
  const std::string body = absl::StrCat(type, data);
  *png += body;
  AppendBigEndian(static_cast<uint32_t>(
                      crc32(0, reinterpret_cast<const Bytef*>(body.data()),
                            static_cast<uInt>(body.size()))),
                  png);
}

}  // namespace

std::string EncodePng(const int width, const int height,
                      const std::vector<uint8_t>& shades) {
  CHECK_GT(width, 0);
  CHECK_GT(height, 0);
  CHECK_EQ(shades.size(), static_cast<size_t>(width) * height);
  // Each line begins with the number of its filter, here none.
  std::string lines;
  lines.reserve(static_cast<size_t>(height) * (width / 2 + 2));
  for (int y = 0; y < height; ++y) {
    lines.push_back(0);
    const uint8_t* const row = &shades[static_cast<size_t>(y) * width];
    for (int x = 0; x < width; x += 2) {
      const int low = x + 1 < width ? row[x + 1] : 0;
      lines.push_back(static_cast<char>((row[x] << 4) | low));
    }
  }
  uLongf size = compressBound(static_cast<uLong>(lines.size()));
  std::string packed(size, '\0');
  CHECK_EQ(compress2(reinterpret_cast<Bytef*>(&packed[0]), &size,
                     reinterpret_cast<const Bytef*>(lines.data()),
                     static_cast<uLong>(lines.size()), Z_DEFAULT_COMPRESSION),
           Z_OK);
  packed.resize(size);

  std::string png("\x89PNG\r\n\x1a\n", 8);
  std::string head;
  AppendBigEndian(static_cast<uint32_t>(width), &head);
  AppendBigEndian(static_cast<uint32_t>(height), &head);
  // 4 bits, grey, and the only compression, filter and order there are.
  head += std::string("\x04\x00\x00\x00\x00", 5);
  AppendChunk("IHDR", head, &png);
  AppendChunk("IDAT", packed, &png);
  AppendChunk("IEND", "", &png);
  return png;
}

std::string MapDataUri(const io::OccupancyMap& map) {
  std::vector<uint8_t> shades;
  shades.reserve(map.occupancy.size());
  for (int y = map.height - 1; y >= 0; --y) {
    for (int x = 0; x < map.width; ++x) {
      const float occupancy = map.at(x, y);
      shades.push_back(
          std::isnan(occupancy)
              ? kUnknownShade
              : static_cast<uint8_t>(std::lround(
                    kWhite * (1.f - std::clamp(occupancy, 0.f, 1.f)))));
    }
  }
  return absl::StrCat(
      "data:image/png;base64,",
      absl::Base64Escape(EncodePng(map.width, map.height, shades)));
}

}  // namespace report
}  // namespace cartographer_ext
