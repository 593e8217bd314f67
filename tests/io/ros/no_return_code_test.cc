// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/no_return_code.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "absl/types/variant.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/io/ros/rosbag2_writer.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kScans = 100;
constexpr int kBeams = 360;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The range of beam `beam` of scan `scan`.
using Ranges = std::function<float(int scan, int beam)>;

LaserScan MakeScan(const int scan, const Ranges& ranges) {
  LaserScan result;
  result.angle_min = -kPi;
  result.angle_increment = 2. * kPi / kBeams;
  result.range_min = 0.1;
  result.range_max = 100.;
  for (int beam = 0; beam < kBeams; ++beam) {
    result.ranges.push_back(ranges(scan, beam));
  }
  return result;
}

NoReturnCodes Judged(const Ranges& ranges, const int num_scans = kScans) {
  NoReturnCodes codes;
  for (int scan = 0; scan < num_scans; ++scan) {
    codes.Add("/scan", "laser", MakeScan(scan, ranges));
  }
  codes.Judge();
  return codes;
}

double RangeMaxOf(const Ranges& ranges, const int num_scans = kScans) {
  return Judged(ranges, num_scans).RangeMax("/scan", "laser");
}

float ToCentimetres(const double range) {
  return 0.01f * static_cast<float>(std::lround(100. * range));
}

// To the walls of a room of 8 x 6 m, 1 m and 0.5 m beside its middle or, while
// the robot drives, elsewhere.
double RoomRange(const int scan, const int beam, const bool drives) {
  const double x = 1. + (drives ? 2. * std::sin(0.1 * scan) : 0.);
  const double y = 0.5 + (drives ? 1.5 * std::cos(0.07 * scan) : 0.);
  const double angle = 2. * kPi * beam / kBeams + (drives ? 0.05 * scan : 0.);
  const double across = std::cos(angle), along = std::sin(angle);
  return std::min((across > 0. ? 4. - x : 4. + x) / std::abs(across),
                  (along > 0. ? 3. - y : 3. + y) / std::abs(along));
}

TEST(NoReturnCodeTest, AValueThatManyBeamsRepeatIsACode) {
  for (const float code : {5.599f, 65.533f}) {
    Random random(1);
    const auto codes = Judged([&](const int scan, const int beam) {
      const bool is_lost = (beam + 7 * scan) % 10 == 0;
      return is_lost ? code : static_cast<float>(random.Uniform(0.5, 5.5));
    });
    EXPECT_EQ(codes.RangeMax("/scan", "laser"), std::nextafter(code, 0.f));
    EXPECT_EQ(codes.RangeMax("/scan", "other"), kInfinity);
    EXPECT_THAT(codes.Warnings(),
                ElementsAre(AllOf(HasSubstr("10 % of the beams on /scan read "
                                            "exactly "),
                                  HasSubstr(" m in 100 of 100 scans"))));
  }
}

TEST(NoReturnCodeTest, OneOfEveryFourScansIsEnough) {
  EXPECT_EQ(RangeMaxOf([](const int scan, const int beam) {
              return scan % 4 == 0 && beam < 100
                         ? 10.f
                         : static_cast<float>(RoomRange(scan, beam, true));
            }),
            std::nextafter(10.f, 0.f));
}

TEST(NoReturnCodeTest, WallsAreNone) {
  for (const bool drives : {false, true}) {
    for (const double noise : {0., 0.002, 0.02}) {
      Random random(2);
      // In centimetres, as a SICK laser counts.
      EXPECT_EQ(RangeMaxOf([&](const int scan, const int beam) {
                  return ToCentimetres(RoomRange(scan, beam, drives) +
                                       noise * random.Normal());
                }),
                kInfinity)
          << noise;
    }
  }
}

TEST(NoReturnCodeTest, RoundRoomsAreNone) {
  EXPECT_EQ(RangeMaxOf([](int, int) { return 3.f; }), kInfinity);
  // The robot away from the middle of a round room.
  EXPECT_EQ(RangeMaxOf([](const int scan, const int beam) {
              const double angle = 2. * kPi * beam / kBeams;
              const double offset = 0.01 * scan;
              return ToCentimetres(
                  std::sqrt(9. - std::pow(offset * std::sin(angle), 2)) -
                  offset * std::cos(angle));
            }),
            kInfinity);
}

TEST(NoReturnCodeTest, SomethingFartherAwayIsAReading) {
  EXPECT_EQ(RangeMaxOf([](const int scan, const int beam) {
              if (beam < 100) return 5.f;
              if (beam == 200 && scan % 20 == 0) return 7.f;
              return 1.f + 0.01f * static_cast<float>(beam);
            }),
            kInfinity);
}

TEST(NoReturnCodeTest, AFewScansSayNothing) {
  const Ranges ranges = [](int, const int beam) {
    return beam < 100 ? 5.f : 1.f + 0.01f * static_cast<float>(beam);
  };
  EXPECT_EQ(RangeMaxOf(ranges, 19), kInfinity);
  EXPECT_LT(RangeMaxOf(ranges, 20), 5.);
}

TEST(NoReturnCodeTest, RecordingsLoseTheCode) {
  for (const bool has_code : {false, true}) {
    test::TemporaryFile file(".mcap");
    RosbagWriterOptions options;
    options.compression = "none";
    auto writer =
        OpenRosbag2Writer(file.path(), Rosbag2Storage::kMcap, options);
    ASSERT_TRUE(writer.ok()) << writer.status();
    for (int i = 1; i <= 40; ++i) {
      LaserScan scan = MakeScan(i, [&](const int scan, const int beam) {
        return has_code && beam % 5 == 0
                   ? 65.533f
                   : static_cast<float>(RoomRange(scan, beam, true));
      });
      scan.time = i * 100000000LL;
      ASSERT_TRUE((*writer)->AddScan(scan).ok());
    }
    ASSERT_TRUE((*writer)->Finish().ok());
    auto source = OpenSensorSource(file.path(), {});
    ASSERT_TRUE(source.ok()) << source.status();
    const auto said = ::testing::Contains(
        HasSubstr("on /scan read exactly 65.533 m in 40 of 40 scans"));
    SensorEvent event;
    ASSERT_TRUE((*source)->Next(&event).value());
    const LaserScan scan = absl::get<LaserScan>(event);
    if (has_code) {
      EXPECT_THAT((*source)->info().warnings, said);
      EXPECT_EQ(scan.range_max, std::nextafter(65.533f, 0.f));
    } else {
      EXPECT_THAT((*source)->info().warnings, ::testing::Not(said));
      EXPECT_GT(scan.range_max, 99.);
    }
  }
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
