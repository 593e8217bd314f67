// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/map_figure.h"

#include <limits>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace report {
namespace {

using testing::HasSubstr;
using testing::Not;

// Twenty metres wide and ten high: 50 units a metre, y down.
io::PictureBounds Bounds() {
  io::PictureBounds bounds;
  bounds.Add(Eigen::Vector2d(-10., -5.));
  bounds.Add(Eigen::Vector2d(10., 5.));
  return bounds;
}

const double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(MapFigureTest, AnEmptyFigureHasAScale) {
  const std::string html = MapFigure("a <b>", Bounds()).ToHtml();
  EXPECT_THAT(html, HasSubstr("viewBox=\"0 0 1000 500\""));
  EXPECT_THAT(html, HasSubstr("aria-label=\"a &lt;b&gt;\""));
  // A quarter of the width at most: 5 m, 250 units.
  EXPECT_THAT(html, HasSubstr(">5 m<"));
  EXPECT_THAT(html, HasSubstr("h250 v-6"));
  EXPECT_THAT(html, Not(HasSubstr("legend")));
}

TEST(MapFigureTest, MetresBecomeUnits) {
  MapFigure figure("f", Bounds());
  figure.Path({{-10., 5.}, {0., 0.}, {kNan, 0.}, {10., -5.}, {9., -5.}}, "s1");
  figure.Dots({{0., 0.}, {kNan, kNan}, {1., 1.}}, "s2");
  figure.Line({0., 0.}, {2., 0.}, "s3", "from & to");
  const std::string html = figure.ToHtml();
  EXPECT_THAT(html, HasSubstr("class=\"path s1\" "
                              "d=\"M0 0L500 250M1000 500L950 500\""));
  EXPECT_THAT(html, HasSubstr("class=\"dots s2\" d=\"M500 250h0M550 200h0\""));
  EXPECT_THAT(html, HasSubstr("class=\"loop s3\" x1=\"500\" y1=\"250\" "
                              "x2=\"600\" y2=\"250\""));
  EXPECT_THAT(html, HasSubstr("<title>from &amp; to</title>"));
}

TEST(MapFigureTest, WhatHasNoPlaceIsLeftOut) {
  MapFigure figure("f", Bounds());
  figure.Path({{kNan, 0.}}, "s1");
  figure.Path({}, "s1");
  figure.Dots({{0., kNan}}, "s2");
  figure.Line({0., kNan}, {0., 0.}, "s3", "");
  const std::string html = figure.ToHtml();
  EXPECT_THAT(html, Not(HasSubstr("s1")));
  EXPECT_THAT(html, Not(HasSubstr("s2")));
  EXPECT_THAT(html, Not(HasSubstr("s3")));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
}

// Every point is on the segments, each knows its time, and gaps stay gaps.
TEST(MapFigureTest, ATimedPathCanBeCut) {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> seconds;
  for (int i = 0; i < 300; ++i) {
    points.emplace_back(0.01 * i, 0.);
    seconds.push_back(10. + i);
  }
  points[150] = {kNan, kNan};
  seconds[150] = kNan;
  MapFigure figure("f", Bounds());
  figure.TimedPath(points, seconds, "by-time");
  const std::string html = figure.ToHtml();
  const auto count = [&html](const std::string& part) {
    int found = 0;
    for (size_t at = html.find(part); at != std::string::npos;
         at = html.find(part, at + 1)) {
      ++found;
    }
    return found;
  };
  EXPECT_EQ(count("class=\"path timed by-time\""), 100);
  EXPECT_THAT(html, HasSubstr("data-t=\"10\" style=\"--when:hsl(205 "));
  EXPECT_THAT(html, HasSubstr("data-t=\"307\""));
  // Three steps in each segment, two of them lost with the point.
  EXPECT_EQ(count("L"), 299 - 2);
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  MapFigure empty("f", Bounds());
  empty.TimedPath({}, {}, "by-time");
  EXPECT_THAT(empty.ToHtml(), Not(HasSubstr("timed")));
}

TEST(MapFigureTest, RingsAreNeverTooSmall) {
  MapFigure figure("f", Bounds());
  figure.Ring({0., 0.}, 2., "1", "two metres");
  figure.Ring({0., 0.}, 0.01, "2", "a centimetre");
  const std::string html = figure.ToHtml();
  EXPECT_THAT(html, HasSubstr("r=\"100\""));
  EXPECT_THAT(html, HasSubstr("r=\"10\""));
  EXPECT_THAT(html, HasSubstr("<title>two metres</title>"));
}

TEST(MapFigureTest, TheLegendStandsBelow) {
  MapFigure figure("f", Bounds());
  figure.Legend("path & co", "s7");
  const std::string html = figure.ToHtml();
  EXPECT_LT(html.find("</svg>"), html.find("class=\"legend\""));
  EXPECT_THAT(html, HasSubstr("swatch s7"));
  EXPECT_THAT(html, HasSubstr("path &amp; co"));
}

TEST(MapFigureTest, PicturesStandInTheStoreOnce) {
  // Four by two cells of half a metre, lower left corner at (1, 2).
  io::OccupancyMap map = io::OccupancyMap::Make(4, 2, 0.5, Pose2(1., 2., 0.));
  map.at(0, 0) = 1.f;
  ImageStore store;
  store.Add("map0", map);
  const std::string html = store.ToHtml();
  EXPECT_THAT(html, HasSubstr("id=\"map0\" x=\"1\" y=\"-3\" width=\"2\" "
                              "height=\"1\""));
  EXPECT_THAT(html, HasSubstr("href=\"data:image/png;base64,"));
  MapFigure figure("f", Bounds());
  figure.Image("map0");
  EXPECT_THAT(figure.ToHtml(),
              HasSubstr("href=\"#map0\" class=\"map\" "
                        "transform=\"translate(500 250) scale(50)\""));
}

TEST(MapFigureTest, APointHasAnArea) {
  io::PictureBounds bounds;
  bounds.Add(Eigen::Vector2d(3., 3.));
  const std::string html = MapFigure("f", bounds).ToHtml();
  EXPECT_THAT(html, HasSubstr("viewBox=\"0 0 1 1\""));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
