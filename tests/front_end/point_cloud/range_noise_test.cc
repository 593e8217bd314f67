// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/range_noise.h"

#include <cmath>
#include <functional>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using Range = std::function<double(double)>;  // measured, by bearing

constexpr double kNoise = 0.05;  // metres

// A wall across the x axis.
double Wall(const double bearing) { return 8. / std::cos(bearing); }

// Triples of beams one degree apart, up to 30 degrees from the x axis.
void AddScan(const Range& range, RangeNoise* const noise) {
  Beam before, beam;
  for (int i = -30; i <= 30; ++i) {
    const double bearing = DegToRad(i);
    const Beam after{bearing, range(bearing)};
    if (i >= -28) noise->Add(before, beam, after);
    before = beam;
    beam = after;
  }
}

RangeNoise After(const int num_scans, const Range& range) {
  RangeNoise noise;
  for (int n = 0; n < num_scans; ++n) AddScan(range, &noise);
  return noise;
}

TEST(RangeNoiseTest, IsThatOfTheLaser) {
  Random random(1);
  const RangeNoise noise = After(100, [&](const double bearing) {
    return Wall(bearing) + kNoise * random.Normal();
  });
  EXPECT_NEAR(noise.At(8.5), kNoise, 0.1 * kNoise);
  // Nothing was seen there.
  EXPECT_EQ(noise.At(2.), 0.);
}

TEST(RangeNoiseTest, IsKnownAfterManyBeams) {
  Random random(1);
  RangeNoise noise;
  const Range range = [&](const double bearing) {
    return Wall(bearing) + kNoise * random.Normal();
  };
  for (int n = 0; n < 10; ++n) AddScan(range, &noise);
  EXPECT_EQ(noise.At(8.5), 0.);
  EXPECT_FALSE(noise.IsKnown(8.5));
  for (int n = 0; n < 1000; ++n) AddScan(range, &noise);
  EXPECT_GT(noise.At(8.5), 0.);
  EXPECT_TRUE(noise.IsKnown(8.5));
  EXPECT_FALSE(noise.IsKnown(2.));
}

TEST(RangeNoiseTest, IsThatOfItsRange) {
  Random random(1);
  RangeNoise noise;
  for (const double distance : {2., 6.}) {
    for (int n = 0; n < 100; ++n) {
      AddScan(
          [&](const double bearing) {
            return distance / std::cos(bearing) * (1. + 0.01 * random.Normal());
          },
          &noise);
    }
  }
  EXPECT_NEAR(noise.At(2.1), 0.021, 0.003);
  EXPECT_NEAR(noise.At(6.2), 0.062, 0.009);
}

// The wall turned by 50 degrees: steep, so that beams hit it farther and farther
// apart.
TEST(RangeNoiseTest, DoesNotDependOnTheSlopeOfTheWall) {
  Random random(1);
  const RangeNoise noise = After(200, [&](const double bearing) {
    return 4. / std::cos(bearing - DegToRad(50.)) + kNoise * random.Normal();
  });
  EXPECT_NEAR(noise.At(6.1), kNoise, 0.1 * kNoise);
}

TEST(RangeNoiseTest, NoNoiseIsNone) { EXPECT_EQ(After(100, Wall).At(8.5), 0.); }

TEST(RangeNoiseTest, IsNotThatOfRoughPlaces) {
  Random random(1);
  // Half of the beams see bushes half a metre deep.
  const RangeNoise noise = After(100, [&](const double bearing) {
    return Wall(bearing) + kNoise * random.Normal() +
           (bearing > 0. ? 0.5 * random.Normal() : 0.);
  });
  EXPECT_EQ(noise.At(8.5), 0.);
}

TEST(RangeNoiseTest, IsNotStepsOfTheRanges) {
  Random random(1);
  const RangeNoise noise = After(100, [&](const double bearing) {
    return 0.1 * std::round(10. * (Wall(bearing) + 0.005 * random.Normal()));
  });
  EXPECT_EQ(noise.At(8.5), 0.);
}

TEST(RangeNoiseTest, IgnoresWhatIsNotFinite) {
  RangeNoise noise;
  for (int n = 0; n < 100000; ++n) {
    noise.Add({0., 8.}, {0.01, std::nan("")}, {0.02, 8.});
    noise.Add({0., 8.}, {0., 8.}, {0., 8.});
  }
  EXPECT_FALSE(noise.IsKnown(8.));
  EXPECT_EQ(noise.At(8.), 0.);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
