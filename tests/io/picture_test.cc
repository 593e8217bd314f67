// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/picture.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cairo.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

// The picture as written to a file.
class Png {
 public:
  explicit Png(const std::string& filename)
      : surface_(cairo_image_surface_create_from_png(filename.c_str())) {}
  ~Png() { cairo_surface_destroy(surface_); }
  bool ok() const {
    return cairo_surface_status(surface_) == CAIRO_STATUS_SUCCESS;
  }
  int width() const { return cairo_image_surface_get_width(surface_); }
  int height() const { return cairo_image_surface_get_height(surface_); }
  // 0xRRGGBB
  uint32_t at(int x, int y) const {
    const unsigned char* const data = cairo_image_surface_get_data(surface_);
    const int stride = cairo_image_surface_get_stride(surface_);
    return reinterpret_cast<const uint32_t*>(data + y * stride)[x] & 0xffffff;
  }

 private:
  cairo_surface_t* const surface_;
};

// Versions of cairo round differently.
void ExpectColor(const Color& expected, uint32_t actual) {
  EXPECT_NEAR(255. * expected.red, actual >> 16, 1.5);
  EXPECT_NEAR(255. * expected.green, (actual >> 8) & 0xff, 1.5);
  EXPECT_NEAR(255. * expected.blue, actual & 0xff, 1.5);
}

TEST(PictureTest, PutsTheMapWhereItBelongs) {
  // Ten by five metres; the lower left quarter metre is occupied.
  OccupancyMap map = OccupancyMap::Make(20, 10, 0.5, Pose2(2., 1., 0.));
  for (float& cell : map.occupancy) cell = 0.f;
  map.at(0, 0) = 1.f;
  map.at(19, 9) = OccupancyMap::Unknown();
  PictureBounds bounds;
  bounds.Add(map);
  EXPECT_EQ(bounds.min_x, 2.);
  EXPECT_EQ(bounds.max_x, 12.);
  EXPECT_EQ(bounds.max_y, 6.);
  Picture picture(bounds, 1048);  // 100 pixels a metre and the margins
  EXPECT_EQ(picture.width(), 1048);
  EXPECT_EQ(picture.height(), 548);
  picture.DrawMap(map);
  // Across at y = 3.5 m.
  LineStyle style;
  style.color = palette::kVermilion;
  style.width = 5.;
  picture.DrawPolyline({Eigen::Vector2d(2., 3.5), Eigen::Vector2d(12., 3.5)},
                       style);
  picture.DrawDot(Eigen::Vector2d(10., 2.), 6., palette::kBlue);
  test::TemporaryFile file(".png");
  ASSERT_TRUE(picture.Write(file.path()).ok());
  const Png png(file.path());
  ASSERT_TRUE(png.ok());
  EXPECT_EQ(png.width(), 1048);
  EXPECT_EQ(png.at(24 + 40, 548 - 24 - 40), 0x000000u);  // occupied
  EXPECT_EQ(png.at(24 + 60, 548 - 24 - 60), 0xffffffu);  // free
  EXPECT_EQ(png.at(24 + 980, 24 + 20), 0xe0e0e0u);       // unknown
  ExpectColor(palette::kVermilion, png.at(500, 24 + 250));
  ExpectColor(palette::kBlue, png.at(24 + 800, 548 - 24 - 100));
}

TEST(PictureTest, TurnedMap) {
  // One occupied cell of a metre at the origin, turned by a quarter to the
  // left: it covers x from -1 to 0.
  OccupancyMap map = OccupancyMap::Make(1, 1, 1., Pose2(0., 0., kPi / 2.));
  map.at(0, 0) = 1.f;
  PictureBounds bounds;
  bounds.Add(Eigen::Vector2d(-2., -1.));
  bounds.Add(Eigen::Vector2d(2., 2.));
  Picture picture(bounds, 448);
  picture.DrawMap(map);
  test::TemporaryFile file(".png");
  ASSERT_TRUE(picture.Write(file.path()).ok());
  const Png png(file.path());
  EXPECT_EQ(png.at(24 + 150, 24 + 150), 0x000000u);
  EXPECT_EQ(png.at(24 + 250, 24 + 150), 0xffffffu);
}

// Bytes, by the system; -1 if it does not tell.
int64_t PeakMemory() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    int64_t kilobytes;
    if (word == "VmHWM:" && file >> kilobytes) return 1024 * kilobytes;
  }
  return -1;
}

// False if the system does not do so.
bool ResetPeakMemory() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5";
  file.close();
  return file.good();
}

TEST(PictureTest, AMapThatIsMovedIsNotCopied) {
  OccupancyMap map = OccupancyMap::Make(6000, 3000, 0.05, Pose2());
  const int64_t size = sizeof(float) * map.occupancy.size();
  PictureBounds bounds;
  bounds.Add(map);
  Picture picture(bounds, 600);
  if (!ResetPeakMemory()) GTEST_SKIP() << "no peak of memory";
  const int64_t before = PeakMemory();
  ASSERT_GT(before, size);
  picture.DrawMap(std::move(map));
  EXPECT_LT(PeakMemory() - before, size / 2);
}

TEST(PictureTest, SurvivesStrangeInput) {
  const double kNan = std::numeric_limits<double>::quiet_NaN();
  PictureBounds bounds;
  bounds.Add(Eigen::Vector2d(kNan, 0.));
  EXPECT_FALSE(bounds.min_x <= bounds.max_x);
  Picture empty(bounds, 10);
  EXPECT_EQ(empty.width(), 64);  // The least size.
  bounds.Add(Eigen::Vector2d(-1e6, 0.));
  bounds.Add(Eigen::Vector2d(1e6, 1e-9));
  Picture picture(bounds, 1000000);
  EXPECT_EQ(picture.width(), 8192);
  EXPECT_EQ(picture.height(), 64);
  picture.DrawMap(OccupancyMap());
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 5000; ++i) {
    points.emplace_back(i % 7 == 0 ? kNan : 1e300 * i, -1e300);
  }
  picture.DrawPolyline(points, {});
  picture.DrawPolygon(points, {}, palette::kSkyBlue);
  picture.DrawPolyline({}, {});
  picture.DrawCircle(Eigen::Vector2d(kNan, 0.), 1., {});
  picture.DrawCircle(Eigen::Vector2d(0., 0.), kNan, {});
  picture.DrawDot(Eigen::Vector2d(0., kNan), 1., palette::kGreen);
  picture.DrawText(Eigen::Vector2d(0., 0.), "\xff\xfe broken text", 12.,
                   palette::kBlack);
  picture.SetTitle("title");
  picture.AddLegend("legend", palette::kYellow);
  test::TemporaryFile file(".png");
  EXPECT_TRUE(picture.Write(file.path()).ok());
  EXPECT_TRUE(Png(file.path()).ok());
}

TEST(PictureTest, WriteErrors) {
  Picture picture((PictureBounds()));
  EXPECT_FALSE(picture.Write("/nonexistent/a.png").ok());
  if (test::Exists("/dev/full")) {
    EXPECT_FALSE(picture.Write("/dev/full").ok());
  }
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
