// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/png_image.h"

#include <cstring>

#include "absl/strings/escaping.h"
#include "absl/strings/strip.h"
#include "cairo.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace report {
namespace {

struct Reader {
  std::string bytes;
  size_t position = 0;
};

cairo_status_t Read(void* closure, unsigned char* data, unsigned int length) {
  Reader* const reader = static_cast<Reader*>(closure);
  if (reader->position + length > reader->bytes.size()) {
    return CAIRO_STATUS_READ_ERROR;
  }
  std::memcpy(data, reader->bytes.data() + reader->position, length);
  reader->position += length;
  return CAIRO_STATUS_SUCCESS;
}

// Grey values from the top left on, by another decoder than ours.
std::vector<int> Decode(const std::string& png, int* width, int* height) {
  Reader reader{png};
  cairo_surface_t* const surface =
      cairo_image_surface_create_from_png_stream(Read, &reader);
  EXPECT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  *width = cairo_image_surface_get_width(surface);
  *height = cairo_image_surface_get_height(surface);
  std::vector<int> result;
  const unsigned char* const data = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; y < *height; ++y) {
    for (int x = 0; x < *width; ++x) result.push_back(data[y * stride + 4 * x]);
  }
  cairo_surface_destroy(surface);
  return result;
}

TEST(PngImageTest, OtherDecodersReadIt) {
  int width = 0, height = 0;
  const auto pixels =
      Decode(EncodePng(3, 2, {0, 15, 5, 10, 1, 14}), &width, &height);
  EXPECT_EQ(width, 3);
  EXPECT_EQ(height, 2);
  EXPECT_EQ(pixels, (std::vector<int>{0, 255, 85, 170, 17, 238}));
}

TEST(PngImageTest, MapsStandUpright) {
  io::OccupancyMap map = io::OccupancyMap::Make(2, 2, 0.05, Pose2());
  map.at(0, 0) = 1.f;  // lower left
  map.at(1, 1) = 0.f;
  absl::string_view uri;
  const std::string text = MapDataUri(map);
  uri = text;
  ASSERT_TRUE(absl::ConsumePrefix(&uri, "data:image/png;base64,"));
  std::string png;
  ASSERT_TRUE(absl::Base64Unescape(uri, &png));
  int width = 0, height = 0;
  EXPECT_EQ(Decode(png, &width, &height), (std::vector<int>{221, 255, 0, 221}));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
