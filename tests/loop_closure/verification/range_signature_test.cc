// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/range_signature.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

RangeSignatureOptions FourSectors() {
  RangeSignatureOptions options;
  options.num_sectors = 4;
  options.rays_per_sector = 3;
  return options;
}

Eigen::Vector2f Polar(double range, double degrees) {
  return Eigen::Vector2f(range * std::cos(DegToRad(degrees)),
                         range * std::sin(DegToRad(degrees)));
}

// A free room of 6 m x 4 m with its middle at (0, 0), walls one cell thick.
OccupancyView Room(double resolution) {
  const int nx = static_cast<int>(std::lround(6. / resolution)) + 2;
  const int ny = static_cast<int>(std::lround(4. / resolution)) + 2;
  OccupancyView view(Eigen::Vector2d(-3. - resolution, -2. - resolution),
                     resolution, nx, ny);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const bool wall = i == 0 || j == 0 || i == nx - 1 || j == ny - 1;
      view.Set(i, j, wall ? CellState::kOccupied : CellState::kFree);
    }
  }
  return view;
}

TEST(RangeSignatureTest, SectorsAreMediansOfTheNearestPointOfEachRay) {
  // Sector 0 has rays [0, 30), [30, 60), [60, 90) degrees.
  const RangeSignature signature = SignatureFromPoints(
      FourSectors(), {Polar(2., 10.), Polar(1., 20.), Polar(5., 40.),
                      Polar(7., 70.), Polar(0.05, 100.), Polar(3., -1.)});
  ASSERT_EQ(signature.size(), 4u);
  EXPECT_FLOAT_EQ(signature[0], 5.f);     // of 1, 5, 7
  EXPECT_TRUE(std::isnan(signature[1]));  // the only point is the robot
  EXPECT_TRUE(std::isnan(signature[2]));
  EXPECT_FLOAT_EQ(signature[3], 3.f);
  EXPECT_EQ(NumKnownSectors(signature), 2);
}

TEST(RangeSignatureTest, ClipsAndIgnoresWhatIsNotFinite) {
  const RangeSignature signature = SignatureFromPoints(
      FourSectors(), {Polar(50., 100.), Eigen::Vector2f(kNaN, 1.f),
                      Eigen::Vector2f(0.f, 0.f)});
  EXPECT_FLOAT_EQ(signature[1], 10.f);
  EXPECT_EQ(NumKnownSectors(signature), 1);
  EXPECT_EQ(NumKnownSectors(SignatureFromPoints(FourSectors(), {})), 0);
}

TEST(RangeSignatureTest, AngleJustBelowZeroStaysInTheLastSector) {
  const RangeSignature signature =
      SignatureFromPoints(FourSectors(), {Eigen::Vector2f(1.f, -1e-30f)});
  EXPECT_EQ(NumKnownSectors(signature), 1);
}

TEST(RangeSignatureTest, RaysEndAtTheFirstOccupiedCell) {
  const OccupancyView room = Room(0.1);
  const RayOptions options;
  const Eigen::Vector2d middle(0.01, 0.01);
  EXPECT_NEAR(CastRay(room, middle, 0., options), 2.99, 1e-9);
  EXPECT_NEAR(CastRay(room, middle, kPi, options), 3.01, 1e-9);
  EXPECT_NEAR(CastRay(room, middle, kPi / 2., options), 1.99, 1e-9);
  EXPECT_NEAR(CastRay(room, middle, -kPi / 2., options), 2.01, 1e-9);
  EXPECT_NEAR(CastRay(room, middle, kPi / 4., options), 1.99 * std::sqrt(2.),
              1e-9);
  RayOptions short_range;
  short_range.max_range = 1.5;
  EXPECT_EQ(CastRay(room, middle, 0., short_range), 1.5);
}

TEST(RangeSignatureTest, UnknownSpaceHidesTheAnswer) {
  OccupancyView room = Room(0.1);
  const Eigen::Vector2d middle(0.01, 0.01);
  RayOptions options;
  const int row = 20;  // y in [-0.1, 0) is 20, [0, 0.1) is 21
  room.Set(41, row + 1, CellState::kUnknown);
  EXPECT_NEAR(CastRay(room, middle, 0., options), 2.99, 1e-9);
  room.Set(42, row + 1, CellState::kUnknown);
  EXPECT_TRUE(std::isnan(CastRay(room, middle, 0., options)));
  options.max_unknown = 0.25;
  EXPECT_NEAR(CastRay(room, middle, 0., options), 2.99, 1e-9);
  // Through a gap in the wall lies nothing known.
  room.Set(61, row + 1, CellState::kFree);
  EXPECT_TRUE(std::isnan(CastRay(room, middle, 0., options)));
}

TEST(RangeSignatureTest, StartsOutsideFreeSpaceSeeNothing) {
  const OccupancyView room = Room(0.1);
  const RayOptions options;
  EXPECT_TRUE(
      std::isnan(CastRay(room, Eigen::Vector2d(-3.05, 0.), 0., options)));
  EXPECT_TRUE(
      std::isnan(CastRay(room, Eigen::Vector2d(1e300, 0.), 0., options)));
  EXPECT_TRUE(std::isnan(CastRay(room, Eigen::Vector2d(NAN, 0.), 0., options)));
  EXPECT_TRUE(
      std::isnan(CastRay(OccupancyView(Eigen::Vector2d::Zero(), 0.1, 0, 0),
                         Eigen::Vector2d::Zero(), 0., options)));
  EXPECT_EQ(
      NumKnownSectors(PredictSignature(FourSectors(), room, Pose2(9., 9., 0.))),
      0);
}

TEST(RangeSignatureTest, PredictionTurnsWithTheRobot) {
  const OccupancyView room = Room(0.05);
  RangeSignatureOptions options;
  options.num_sectors = 36;
  const RangeSignature ahead =
      PredictSignature(options, room, Pose2(0.3, 0.1, 0.));
  const RangeSignature turned =
      PredictSignature(options, room, Pose2(0.3, 0.1, kPi / 2.));
  for (int m = 0; m < 36; ++m) {
    EXPECT_NEAR(turned[m], ahead[(m + 9) % 36], 1e-5) << m;
  }
  EXPECT_NEAR(SignatureCost(options, ahead, ahead), 0., 1e-12);
  EXPECT_GT(SignatureCost(options, ahead, turned), 0.3);
}

TEST(RangeSignatureTest, PointsAgreeWithThePrediction) {
  const OccupancyView room = Room(0.05);
  const RangeSignatureOptions options;
  const Pose2 pose(-0.4, 0.3, 0.7);
  std::vector<Eigen::Vector2f> points;
  for (int k = 0; k < 720; ++k) {
    const double degrees = 0.5 * k;
    const double range =
        CastRay(room, pose.translation(), pose.theta + DegToRad(degrees), {});
    points.push_back(Polar(range, degrees));
  }
  const RangeSignature seen = SignatureFromPoints(options, points);
  EXPECT_LT(SignatureCost(options, seen, PredictSignature(options, room, pose)),
            0.05);
}

TEST(RangeSignatureTest, CostIsTheMeanClippedDifference) {
  RangeSignatureOptions options = FourSectors();
  options.clip = 2.;
  // |1 - 2| / 2, |5 - 1| clipped to 1, unknown on one side twice.
  EXPECT_NEAR(
      SignatureCost(options, {1.f, 5.f, kNaN, 3.f}, {2.f, 1.f, 4.f, kNaN}),
      0.75, 1e-9);
  // One of three known sectors is less than half.
  EXPECT_TRUE(std::isnan(
      SignatureCost(options, {1.f, 5.f, kNaN, 3.f}, {2.f, kNaN, 4.f, kNaN})));
  EXPECT_TRUE(std::isnan(
      SignatureCost(options, {kNaN, kNaN, kNaN, kNaN}, {2.f, 1.f, 4.f, 1.f})));
}

TEST(RangeSignatureTest, FillsOnlyUnknownSectors) {
  RangeSignature signature = {1.f, kNaN, kNaN};
  FillUnknownSectors({9.f, 2.f, kNaN}, &signature);
  EXPECT_EQ(signature[0], 1.f);
  EXPECT_EQ(signature[1], 2.f);
  EXPECT_TRUE(std::isnan(signature[2]));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
