// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/chart.h"

#include <cmath>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace report {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(ChartTest, TicksAreRound) {
  EXPECT_THAT(RoundTicks(0., 1., 5),
              ElementsAre(DoubleNear(0., 1e-12), DoubleNear(0.2, 1e-12),
                          DoubleNear(0.4, 1e-12), DoubleNear(0.6, 1e-12),
                          DoubleNear(0.8, 1e-12), DoubleNear(1., 1e-12)));
  EXPECT_THAT(RoundTicks(-3., 130., 3),
              ElementsAre(0., DoubleNear(50., 1e-9), DoubleNear(100., 1e-9)));
  EXPECT_THAT(RoundTicks(2., 2., 5), ElementsAre(2.));
}

TEST(ChartTest, HistogramCountsAtTheEnds) {
  EXPECT_THAT(Histogram({-5., 0., 0.49, 0.5, 2., std::nan("")}, 0., 1., 2),
              ElementsAre(3, 2));
  EXPECT_THAT(Histogram({}, 0., 1., 3), ElementsAre(0, 0, 0));
}

TEST(ChartTest, DrawsWithinTheAxes) {
  Chart chart("a < b", {"x", 0., 10.}, {"y", 0., 1.}, 400, 200);
  chart.Line({{0., 0.}, {10., 1.}, {5., std::nan("")}}, "s1");
  chart.Point({20., 0.5}, "s2", "far & away");
  chart.Bar(1., 2., 0.5, "s1", "bar");
  chart.Bar(2., 3., 0., "s1", "of no height");
  chart.VerticalMark(5., "mark");
  chart.VerticalMark(50., "not shown");
  chart.HorizontalMark(0.5, "half");
  chart.Band(3., 4., "s6", "");
  chart.Legend("line", "s1");
  const std::string svg = chart.ToSvg();
  EXPECT_THAT(svg, HasSubstr("aria-label=\"a &lt; b\""));
  // The corners of the plot: 58 from the left and 42 from below.
  EXPECT_THAT(svg, HasSubstr("d=\"M58 158L386 26\""));
  // Held at the right edge.
  EXPECT_THAT(svg, HasSubstr("cx=\"386\""));
  EXPECT_THAT(svg, HasSubstr("far &amp; away"));
  EXPECT_THAT(svg, Not(HasSubstr("of no height")));
  EXPECT_THAT(svg, Not(HasSubstr("not shown")));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(ChartTest, EllipseOfACovariance) {
  Chart chart("", {"", -10., 10.}, {"", -10., 10.}, 272, 268);
  Eigen::Matrix2d covariance;
  covariance << 4., 0., 0., 1.;
  chart.Ellipse({0., 0.}, covariance, 2., "s3");
  // 200 pixels for 20 units each way: half axes of 40 and 20 pixels.
  const std::string svg = chart.ToSvg();
  EXPECT_THAT(svg, testing::AnyOf(HasSubstr("198 126"), HasSubstr("118 126")));
}

TEST(ChartTest, AxesOfNoLengthAreWidened) {
  Chart chart("", {"", 3., 3.}, {"", 0., std::nan("")});
  chart.Line({{3., 0.}, {3., 1.}}, "s1");
  EXPECT_THAT(chart.ToSvg(), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
