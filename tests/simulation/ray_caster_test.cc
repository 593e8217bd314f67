// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/ray_caster.h"

#include <chrono>
#include <cmath>
#include <ctime>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

using Eigen::Vector2d;

Vector2d Direction(const double angle) {
  return Vector2d(std::cos(angle), std::sin(angle));
}

TEST(RayToSegmentTest, HandComputed) {
  const Segment wall = {Vector2d(3., -1.), Vector2d(3., 2.4), 1.};
  EXPECT_DOUBLE_EQ(RayToSegment(Vector2d(1., 0.), Vector2d(1., 0.), wall), 2.);
  // 3-4-5 triangle: from (0, -2) to (3, 2).
  EXPECT_NEAR(RayToSegment(Vector2d(0., -2.), Vector2d(0.6, 0.8), wall), 5.,
              1e-12);
  // Behind, beside, parallel.
  EXPECT_EQ(RayToSegment(Vector2d(1., 0.), Vector2d(-1., 0.), wall), kNoHit);
  EXPECT_EQ(RayToSegment(Vector2d(1., 2.5), Vector2d(1., 0.), wall), kNoHit);
  EXPECT_EQ(RayToSegment(Vector2d(1., 0.), Vector2d(0., 1.), wall), kNoHit);
}

TEST(RayToSegmentTest, SeenEndOn) {
  const Segment wall = {Vector2d(4., 0.), Vector2d(2., 0.), 1.};
  EXPECT_DOUBLE_EQ(RayToSegment(Vector2d(0., 0.), Vector2d(1., 0.), wall), 2.);
  EXPECT_DOUBLE_EQ(RayToSegment(Vector2d(3., 0.), Vector2d(1., 0.), wall), 0.);
  EXPECT_EQ(RayToSegment(Vector2d(5., 0.), Vector2d(1., 0.), wall), kNoHit);
}

TEST(RayToDiscTest, HandComputed) {
  const Disc disc = {Vector2d(5., 0.), 1., 1.};
  EXPECT_DOUBLE_EQ(RayToDisc(Vector2d(0., 0.), Vector2d(1., 0.), disc), 4.);
  // At half a radius beside the centre the chord is sqrt(3) / 2 shorter.
  EXPECT_NEAR(RayToDisc(Vector2d(0., 0.5), Vector2d(1., 0.), disc),
              5. - std::sqrt(0.75), 1e-12);
  EXPECT_EQ(RayToDisc(Vector2d(0., 1.1), Vector2d(1., 0.), disc), kNoHit);
  EXPECT_EQ(RayToDisc(Vector2d(0., 0.), Vector2d(-1., 0.), disc), kNoHit);
  // From inside.
  EXPECT_DOUBLE_EQ(RayToDisc(Vector2d(5.5, 0.), Vector2d(1., 0.), disc), 0.5);
}

TEST(PointToSegmentTest, HandComputed) {
  const Segment wall = {Vector2d(0., 0.), Vector2d(4., 0.), 1.};
  EXPECT_DOUBLE_EQ(PointToSegment(Vector2d(2., 3.), wall), 3.);
  EXPECT_DOUBLE_EQ(PointToSegment(Vector2d(7., 4.), wall), 5.);
  const Segment point = {Vector2d(1., 1.), Vector2d(1., 1.), 1.};
  EXPECT_DOUBLE_EQ(PointToSegment(Vector2d(1., 3.), point), 2.);
}

TEST(RayCasterTest, RectangularRoom) {
  // 10 m by 4 m with a pillar.
  const std::vector<Segment> walls = {
      {Vector2d(0., 0.), Vector2d(10., 0.), 1.},
      {Vector2d(10., 0.), Vector2d(10., 4.), 0.5},
      {Vector2d(10., 4.), Vector2d(0., 4.), 1.},
      {Vector2d(0., 4.), Vector2d(0., 0.), 1.}};
  const RayCaster room(walls, {{Vector2d(2., 2.), 0.5, 0.25}});
  const Vector2d eye(5., 2.);
  const RayHit east = room.Cast(eye, Direction(0.), 25.);
  EXPECT_NEAR(east.range, 5., 1e-12);
  EXPECT_EQ(east.reflectivity, 0.5);
  const RayHit west = room.Cast(eye, Direction(kPi), 25.);
  EXPECT_NEAR(west.range, 2.5, 1e-12);
  EXPECT_EQ(west.reflectivity, 0.25);
  EXPECT_NEAR(room.Cast(eye, Direction(kPi / 2.), 25.).range, 2., 1e-12);
  EXPECT_NEAR(room.Cast(eye, Direction(kPi / 4.), 25.).range,
              2. * std::sqrt(2.), 1e-12);
  // Out of range.
  EXPECT_EQ(room.Cast(eye, Direction(0.), 4.999).range, kNoHit);
  // From outside, through the grid's border.
  EXPECT_NEAR(room.Cast(Vector2d(-20., 2.), Direction(0.), 100.).range, 20.,
              1e-9);
  EXPECT_EQ(room.Cast(Vector2d(-20., 2.), Direction(kPi / 2.), 100.).range,
            kNoHit);
}

TEST(RayCasterTest, ClearanceAndVisibility) {
  const RayCaster plan({{Vector2d(0., 0.), Vector2d(10., 0.), 1.}},
                       {{Vector2d(5., 3.), 1., 1.}});
  EXPECT_NEAR(plan.Clearance(Vector2d(5., 0.8), 2.), 0.8, 1e-12);
  EXPECT_NEAR(plan.Clearance(Vector2d(7., 3.), 2.), 1., 1e-12);
  EXPECT_EQ(plan.Clearance(Vector2d(5., 30.), 2.), 2.);
  EXPECT_TRUE(plan.Visible(Vector2d(1., 1.), Vector2d(9., 1.)));
  EXPECT_FALSE(plan.Visible(Vector2d(1., 3.), Vector2d(9., 3.)));
  EXPECT_FALSE(plan.Visible(Vector2d(1., 1.), Vector2d(1., -1.)));
}

TEST(RayCasterTest, NothingAtAll) {
  const RayCaster empty({}, {});
  EXPECT_EQ(empty.Cast(Vector2d(0., 0.), Direction(0.), 10.).range, kNoHit);
  EXPECT_EQ(empty.Clearance(Vector2d(0., 0.), 3.), 3.);
  EXPECT_TRUE(empty.Visible(Vector2d(0., 0.), Vector2d(1., 0.)));
}

// The grid must not change what the plain minimum over all shapes says.
TEST(RayCasterTest, AgreesWithExhaustiveSearch) {
  Random random(7);
  std::vector<Segment> segments;
  std::vector<Disc> discs;
  for (int i = 0; i != 60; ++i) {
    const Vector2d a(random.Uniform(-20., 20.), random.Uniform(-20., 20.));
    Vector2d b = a + Vector2d(random.Uniform(-8., 8.), random.Uniform(-8., 8.));
    // Walls on cell borders are the hard case.
    if (i % 3 == 0) b = Vector2d(std::round(a.x()), b.y());
    segments.push_back({a, b, 1.});
  }
  segments.push_back({Vector2d(-20., -20.), Vector2d(20., -20.), 1.});
  segments.push_back({Vector2d(-20., -20.), Vector2d(-20., 20.), 1.});
  for (int i = 0; i != 15; ++i) {
    discs.push_back(
        {Vector2d(random.Uniform(-20., 20.), random.Uniform(-20., 20.)),
         random.Uniform(0.05, 4.), 1.});
  }
  const RayCaster caster(segments, discs);
  int hits = 0;
  for (int i = 0; i != 20000; ++i) {
    const Vector2d origin(random.Uniform(-25., 25.), random.Uniform(-25., 25.));
    Vector2d direction = Direction(random.Uniform(-kPi, kPi));
    if (i % 10 == 0) direction = Vector2d(0., 1.);
    if (i % 10 == 1) direction = Vector2d(-1., 0.);
    double expected = kNoHit;
    for (const Segment& segment : segments) {
      expected = std::min(expected, RayToSegment(origin, direction, segment));
    }
    for (const Disc& disc : discs) {
      expected = std::min(expected, RayToDisc(origin, direction, disc));
    }
    if (expected > 30.) expected = kNoHit;
    ASSERT_EQ(caster.Cast(origin, direction, 30.).range, expected) << i;
    hits += expected != kNoHit;
    double clearance = 5.;
    for (const Segment& segment : segments) {
      clearance = std::min(clearance, PointToSegment(origin, segment));
    }
    for (const Disc& disc : discs) {
      clearance = std::min(
          clearance, std::abs((origin - disc.center).norm() - disc.radius));
    }
    ASSERT_NEAR(caster.Clearance(origin, 5.), clearance, 1e-12) << i;
  }
  EXPECT_GT(hits, 10000);
}

TEST(RayCasterTest, LongThinAndHugePlansStayBounded) {
  const RayCaster thin({{Vector2d(-1e4, 0.), Vector2d(1e4, 0.), 1.}}, {});
  EXPECT_NEAR(thin.Cast(Vector2d(0., 5.), Direction(-kPi / 2.), 10.).range, 5.,
              1e-9);
  const RayCaster huge({{Vector2d(-1e4, -1e4), Vector2d(1e4, 1e4), 1.}},
                       {{Vector2d(5., 0.), 1., 1.}});
  EXPECT_NEAR(huge.Cast(Vector2d(9., 0.), Direction(kPi), 10.).range, 3., 1e-9);
}

// A pane answers near its normal only; what lies behind is seen at a slant.
TEST(RayCasterTest, PanesLetSlantingBeamsThrough) {
  const RayCaster plan(
      {{Vector2d(2., -9.), Vector2d(2., 9.), 0.5, DegToRad(20.)},
       {Vector2d(4., -9.), Vector2d(4., 9.), 1., kAnyAngle}},
      {});
  for (int degrees = -60; degrees <= 60; ++degrees) {
    const RayHit hit =
        plan.Cast(Vector2d(0., 0.), Direction(DegToRad(degrees)), 30.);
    const bool through = std::abs(degrees) > 20;
    EXPECT_NEAR(hit.range * std::cos(DegToRad(degrees)), through ? 4. : 2.,
                1e-9)
        << degrees;
    EXPECT_EQ(hit.reflectivity, through ? 1. : 0.5);
  }
  // A robot does not fit through, whatever it sees.
  EXPECT_NEAR(plan.Clearance(Vector2d(1.7, 0.), 1.), 0.3, 1e-12);
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
