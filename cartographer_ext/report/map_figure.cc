// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/map_figure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/report/png_image.h"

namespace cartographer_ext {
namespace report {
namespace {

// The longer side of a figure, in the units of its SVG.
constexpr double kUnits = 1000.;

constexpr size_t kTimedSegments = 120;
// Hues of a path coloured by time, degrees: blue to magenta. Orange and red are
// for what contradicts the map.
constexpr double kFirstHue = 205.;
constexpr double kLastHue = 325.;

// 1, 2 or 5 times a power of ten, at most `limit`.
double RoundLength(const double limit) {
  const double power = std::pow(10., std::floor(std::log10(limit)));
  for (const double factor : {5., 2.}) {
    if (factor * power <= limit) return factor * power;
  }
  return power;
}

}  // namespace

void ImageStore::Add(const std::string& id, const io::OccupancyMap& map) {
  // In metres, with y down as pictures have it; figures turn it.
  const double width = map.width * map.resolution;
  const double height = map.height * map.resolution;
  definitions_.Empty("image", {{"id", id},
                               {"x", Number(map.origin.x, 4)},
                               {"y", Number(-map.origin.y - height, 4)},
                               {"width", Number(width, 4)},
                               {"height", Number(height, 4)},
                               {"preserveAspectRatio", "none"},
                               {"href", MapDataUri(map)}});
}

std::string ImageStore::ToHtml() const {
  Markup markup;
  markup.Open("svg", {{"class", "store"}, {"aria-hidden", "true"}});
  markup.Open("defs");
  markup.Raw(definitions_.str());
  markup.Close();
  markup.Close();
  return markup.str();
}

MapFigure::MapFigure(const std::string& title, const io::PictureBounds& bounds)
    : title_(title), bounds_(bounds) {
  const double side =
      std::max({bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y, 1.});
  units_ = kUnits / side;
}

Eigen::Vector2d MapFigure::ToUnits(const Eigen::Vector2d& point) const {
  return {(point.x() - bounds_.min_x) * units_,
          (bounds_.max_y - point.y()) * units_};
}

void MapFigure::Image(const std::string& id) {
  const Eigen::Vector2d origin = ToUnits(Eigen::Vector2d::Zero());
  body_.Empty(
      "use",
      {{"href", absl::StrCat("#", id)},
       {"class", "map"},
       {"transform",
        absl::StrFormat("translate(%s %s) scale(%s)", Number(origin.x(), 3),
                        Number(origin.y(), 3), Number(units_, 6))}});
}

void MapFigure::Path(const std::vector<Eigen::Vector2d>& points,
                     const std::string& style) {
  std::string path;
  bool pen_up = true;
  for (const Eigen::Vector2d& point : points) {
    if (!point.allFinite()) {
      pen_up = true;
      continue;
    }
    const Eigen::Vector2d at = ToUnits(point);
    absl::StrAppend(&path, pen_up ? "M" : "L", Number(at.x(), 1), " ",
                    Number(at.y(), 1));
    pen_up = false;
  }
  if (path.empty()) return;
  body_.Empty("path", {{"class", absl::StrCat("path ", style)}, {"d", path}});
}

void MapFigure::TimedPath(const std::vector<Eigen::Vector2d>& points,
                          const std::vector<double>& seconds,
                          const std::string& style) {
  const size_t step = 1 + points.size() / kTimedSegments;
  for (size_t first = 0; first + 1 < points.size(); first += step) {
    const size_t last = std::min(first + step, points.size() - 1);
    std::string path;
    double begin = std::numeric_limits<double>::quiet_NaN();
    for (size_t i = first; i <= last; ++i) {
      if (!points[i].allFinite()) continue;
      const Eigen::Vector2d at = ToUnits(points[i]);
      const bool pen_up =
          path.empty() || (i > first && !points[i - 1].allFinite());
      absl::StrAppend(&path, pen_up ? "M" : "L", Number(at.x(), 1), " ",
                      Number(at.y(), 1));
      if (std::isnan(begin)) begin = seconds[i];
    }
    if (path.empty()) continue;
    const double share =
        static_cast<double>(first) / static_cast<double>(points.size());
    body_.Empty(
        "path",
        {{"class", absl::StrCat("path timed ", style)},
         {"data-t", Number(begin, 1)},
         {"style",
          absl::StrCat("--when:hsl(",
                       Number(kFirstHue + share * (kLastHue - kFirstHue), 0),
                       " 75% 45%)")},
         {"d", path}});
  }
}

void MapFigure::Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                     const std::string& style, const std::string& hover,
                     const Attributes& more) {
  if (!from.allFinite() || !to.allFinite()) return;
  const Eigen::Vector2d a = ToUnits(from), b = ToUnits(to);
  Attributes attributes = {{"class", absl::StrCat("loop ", style)},
                           {"x1", Number(a.x(), 1)},
                           {"y1", Number(a.y(), 1)},
                           {"x2", Number(b.x(), 1)},
                           {"y2", Number(b.y(), 1)}};
  attributes.insert(attributes.end(), more.begin(), more.end());
  body_.Open("line", attributes);
  body_.Element("title", {}, hover);
  body_.Close();
}

void MapFigure::Dots(const std::vector<Eigen::Vector2d>& points,
                     const std::string& style) {
  // Strokes of no length with round ends: one element for all.
  std::string path;
  for (const Eigen::Vector2d& point : points) {
    if (!point.allFinite()) continue;
    const Eigen::Vector2d at = ToUnits(point);
    absl::StrAppend(&path, "M", Number(at.x(), 1), " ", Number(at.y(), 1),
                    "h0");
  }
  if (path.empty()) return;
  body_.Empty("path", {{"class", absl::StrCat("dots ", style)}, {"d", path}});
}

void MapFigure::Ring(const Eigen::Vector2d& center, const double radius,
                     const std::string& label, const std::string& hover,
                     const Attributes& more) {
  const Eigen::Vector2d at = ToUnits(center);
  const double r = std::max(10., radius * units_);
  Attributes attributes = {{"class", "ring"},
                           {"cx", Number(at.x(), 1)},
                           {"cy", Number(at.y(), 1)},
                           {"r", Number(r, 1)}};
  attributes.insert(attributes.end(), more.begin(), more.end());
  body_.Open("circle", attributes);
  body_.Element("title", {}, hover);
  body_.Close();
  body_.Element("text",
                {{"class", "ring-label"},
                 {"x", Number(at.x() + 0.75 * r + 3., 1)},
                 {"y", Number(at.y() - 0.75 * r - 3., 1)}},
                label);
}

void MapFigure::Legend(const std::string& label, const std::string& style) {
  legend_.Open("span", {{"class", "entry"}, {"data-style", style}});
  legend_.Element("span", {{"class", absl::StrCat("swatch ", style)}}, "");
  legend_.Text(label);
  legend_.Close();
}

std::string MapFigure::ToHtml() const {
  const double width = std::max(1., (bounds_.max_x - bounds_.min_x) * units_);
  const double height = std::max(1., (bounds_.max_y - bounds_.min_y) * units_);
  Markup markup;
  markup.Open("svg", {{"class", "map-figure"},
                      {"viewBox", absl::StrCat("0 0 ", Number(width, 1), " ",
                                               Number(height, 1))},
                      {"role", "img"},
                      {"aria-label", title_},
                      // For the script: units a metre, and the corner.
                      {"data-units", Number(units_, 6)},
                      {"data-x", Number(bounds_.min_x, 4)},
                      {"data-y", Number(bounds_.max_y, 4)}});
  markup.Empty("rect", {{"class", "unknown"},
                        {"width", Number(width, 1)},
                        {"height", Number(height, 1)}});
  if (!body_.empty()) markup.Raw(body_.str());
  const double metres = RoundLength(0.25 * width / units_);
  const double y = height - 14.;
  markup.Empty("path",
               {{"class", "scale"},
                {"d", absl::StrFormat("M14 %s v6 h%s v-6", Number(y - 6., 1),
                                      Number(metres * units_, 1))}});
  markup.Element(
      "text", {{"class", "scale-label"}, {"x", "18"}, {"y", Number(y - 5., 1)}},
      absl::StrCat(Number(metres), " m"));
  markup.Close();
  if (!legend_.empty()) {
    markup.Open("div", {{"class", "legend"}});
    markup.Raw(legend_.str());
    markup.Close();
  }
  return markup.str();
}

}  // namespace report
}  // namespace cartographer_ext
