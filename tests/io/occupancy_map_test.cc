// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/occupancy_map.h"

#include <cmath>
#include <cstdio>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;

// A file stem whose two files go with it.
class TemporaryMap {
 public:
  TemporaryMap() : mark_("") {}
  ~TemporaryMap() {
    std::remove(pgm().c_str());
    std::remove(yaml().c_str());
  }
  const std::string& stem() const { return mark_.path(); }
  std::string pgm() const { return stem() + ".pgm"; }
  std::string yaml() const { return stem() + ".yaml"; }
  std::string base() const { return stem().substr(stem().rfind('/') + 1); }

 private:
  test::TemporaryFile mark_;
};

OccupancyMap MakeMap() {
  OccupancyMap map = OccupancyMap::Make(3, 2, 0.05, Pose2(-1.5, 2.25, 0.));
  map.at(0, 0) = 1.f;    // lower left: occupied
  map.at(2, 1) = 0.f;    // upper right: free
  map.at(1, 0) = 0.25f;  // neither
  return map;
}

TEST(OccupancyMapTest, WritesTheConventions) {
  TemporaryMap file;
  ASSERT_TRUE(WriteOccupancyMap(MakeMap(), file.stem()).ok());
  // Top row first; 0 occupied, 255 free, 128 unknown.
  EXPECT_EQ(test::ReadBytes(file.pgm()),
            std::string("P5\n# 0.05000 m a pixel\n3 2\n255\n") +
                "\x80\x80\xff" + std::string("\0\xbf\x80", 3));
  EXPECT_EQ(test::ReadBytes(file.yaml()), "image: " + file.base() +
                                              ".pgm\n"
                                              "mode: trinary\n"
                                              "resolution: 0.05\n"
                                              "origin: [-1.5, 2.25, 0]\n"
                                              "negate: 0\n"
                                              "occupied_thresh: 0.65\n"
                                              "free_thresh: 0.196\n");
}

TEST(OccupancyMapTest, RoundTrip) {
  TemporaryMap file;
  ASSERT_TRUE(WriteOccupancyMap(MakeMap(), file.stem()).ok());
  const auto map = ReadOccupancyMap(file.yaml());
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->width, 3);
  EXPECT_EQ(map->height, 2);
  EXPECT_EQ(map->resolution, 0.05);
  EXPECT_EQ(map->origin.x, -1.5);
  EXPECT_EQ(map->origin.y, 2.25);
  EXPECT_EQ(map->at(0, 0), 1.f);
  EXPECT_EQ(map->at(2, 1), 0.f);
  EXPECT_TRUE(std::isnan(map->at(1, 0)));  // Trinary: between the thresholds.
  EXPECT_TRUE(std::isnan(map->at(1, 1)));
}

TEST(OccupancyMapTest, ReadsOtherModes) {
  TemporaryMap file;
  test::WriteBytes(file.pgm(), "P2\n# text\n4 1\n# more\n100\n0 50 100 90\n");
  const std::string head = "image: '" + file.pgm() + "'\nresolution: 0.1 # m\n";
  test::WriteBytes(file.yaml(), head +
                                    "mode: scale\nnegate: 1\norigin: [1, 2, "
                                    "0.5]\noccupied_thresh: 0.95\n"
                                    "free_thresh: 0.1\n");
  auto map = ReadOccupancyMap(file.yaml());
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->origin.theta, 0.5);
  EXPECT_EQ(map->at(0, 0), 0.f);
  EXPECT_NEAR(map->at(1, 0), 0.4 / 0.85, 1e-6);
  EXPECT_EQ(map->at(2, 0), 1.f);
  test::WriteBytes(file.yaml(), head + "mode: raw\n");
  map = ReadOccupancyMap(file.yaml());
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_NEAR(map->at(3, 0), 0.9, 1e-6);
}

TEST(OccupancyMapTest, Errors) {
  TemporaryMap file;
  const auto message = [&](const std::string& yaml, const std::string& pgm) {
    test::WriteBytes(file.yaml(), yaml);
    test::WriteBytes(file.pgm(), pgm);
    const auto map = ReadOccupancyMap(file.yaml());
    EXPECT_FALSE(map.ok());
    return std::string(map.status().message());
  };
  const std::string yaml = "image: " + file.base() + ".pgm\nresolution: 0.05\n";
  const std::string pgm = "P5 1 1 255 x";
  EXPECT_THAT(message("resolution: 1\n", pgm), HasSubstr("image is missing"));
  EXPECT_THAT(message("image: a\n", pgm), HasSubstr("resolution must be"));
  EXPECT_THAT(message(yaml + "origin: [1, 2]\n", pgm), HasSubstr(":3: origin"));
  EXPECT_THAT(message(yaml + "nonsense\n", pgm), HasSubstr(":3: expected key"));
  EXPECT_THAT(message(yaml + "mode: x\n", pgm), HasSubstr("mode must be"));
  EXPECT_THAT(message(yaml, "P6 1 1 255 x"), HasSubstr("not a grey PGM"));
  EXPECT_THAT(message(yaml, "P5 3 3 255 x"), HasSubstr("truncated"));
  EXPECT_THAT(message(yaml, "P5 999999 999999 255 x"), HasSubstr("size"));
  EXPECT_THAT(message(yaml, "P5 1 1 65535 xx"), HasSubstr("8 bit"));
  std::remove(file.pgm().c_str());
  const auto absent = ReadOccupancyMap(file.yaml());
  EXPECT_THAT(std::string(absent.status().message()),
              HasSubstr(file.yaml() + ": the image: "));
  EXPECT_FALSE(WriteOccupancyMap(OccupancyMap(), file.stem()).ok());
  EXPECT_FALSE(WriteOccupancyMap(MakeMap(), "/nonexistent/map").ok());
  EXPECT_FALSE(ReadOccupancyMap("/nonexistent/map.yaml").ok());
}

TEST(OccupancyMapTest, SurvivesMutations) {
  TemporaryMap file;
  ASSERT_TRUE(WriteOccupancyMap(MakeMap(), file.stem()).ok());
  const std::string yaml = test::ReadBytes(file.yaml());
  const std::string pgm = test::ReadBytes(file.pgm());
  test::ForEachMutation(yaml, [&](const std::string& damaged) {
    test::WriteBytes(file.yaml(), damaged);
    ReadOccupancyMap(file.yaml()).status().IgnoreError();
  });
  test::WriteBytes(file.yaml(), yaml);
  test::ForEachMutation(pgm, [&](const std::string& damaged) {
    test::WriteBytes(file.pgm(), damaged);
    ReadOccupancyMap(file.yaml()).status().IgnoreError();
  });
}

TEST(OccupancyMapTest, AnyNameIsReadAgain) {
  const std::string folder = testing::TempDir();
  const OccupancyMap map = OccupancyMap::Make(3, 2, 0.05, Pose2());
  for (const char* const name : {"plain_1", "a #1", "b: c", "it's", "\"q\"",
                                 "back\\slash", "-dash", "two\nlines"}) {
    const std::string stem = folder + "/" + name;
    ASSERT_TRUE(WriteOccupancyMap(map, stem).ok()) << name;
    EXPECT_TRUE(ReadOccupancyMap(stem + ".yaml").ok()) << name;
    test::WriteBytes(stem + ".yaml",
                     "\xef\xbb\xbf" + test::ReadBytes(stem + ".yaml"));
    EXPECT_TRUE(ReadOccupancyMap(stem + ".yaml").ok()) << name;
    std::remove((stem + ".yaml").c_str());
    std::remove((stem + ".pgm").c_str());
  }
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
