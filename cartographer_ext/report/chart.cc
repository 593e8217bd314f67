// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/chart.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "Eigen/Eigenvalues"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace report {
namespace {

constexpr double kLeft = 58., kRight = 14., kTop = 26., kBottom = 42.;

Axis Widened(Axis axis) {
  if (!std::isfinite(axis.low)) axis.low = 0.;
  if (!std::isfinite(axis.high)) axis.high = 1.;
  if (!(axis.high > axis.low)) axis.high = axis.low + 1.;
  return axis;
}

int DecimalsFor(const double step) {
  return std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0,
                    6);
}

}  // namespace

std::vector<double> RoundTicks(const double low, const double high,
                               const int count) {
  std::vector<double> ticks;
  if (!(high > low) || count < 1) return {low};
  const double rough = (high - low) / count;
  const double power = std::pow(10., std::floor(std::log10(rough)));
  double step = 10. * power;
  for (const double factor : {1., 2., 5.}) {
    if (factor * power >= rough) {
      step = factor * power;
      break;
    }
  }
  // Adding 0 turns -0 into 0.
  for (double i = std::ceil(low / step - 1e-9) + 0.;
       i * step <= high + 1e-9 * step; ++i) {
    ticks.push_back(i * step);
  }
  return ticks;
}

Chart::Chart(const std::string& title, Axis x, Axis y, const int width,
             const int height)
    : title_(title),
      x_(Widened(std::move(x))),
      y_(Widened(std::move(y))),
      width_(width),
      height_(height) {}

Eigen::Vector2d Chart::ToPixels(const Eigen::Vector2d& point) const {
  const auto share = [](const double value, const Axis& axis) {
    return std::clamp((value - axis.low) / (axis.high - axis.low), 0., 1.);
  };
  return {
      kLeft + share(point.x(), x_) * (width_ - kLeft - kRight),
      height_ - kBottom - share(point.y(), y_) * (height_ - kTop - kBottom)};
}

void Chart::Line(const std::vector<Eigen::Vector2d>& points,
                 const std::string& style) {
  std::string path;
  for (const Eigen::Vector2d& point : points) {
    if (!point.allFinite()) continue;
    const Eigen::Vector2d at = ToPixels(point);
    absl::StrAppend(&path, path.empty() ? "M" : "L", Number(at.x(), 1), " ",
                    Number(at.y(), 1));
  }
  if (path.empty()) return;
  body_.Empty("path", {{"class", absl::StrCat("line ", style)}, {"d", path}});
}

void Chart::Point(const Eigen::Vector2d& point, const std::string& style,
                  const std::string& hover, const double radius) {
  if (!point.allFinite()) return;
  const Eigen::Vector2d at = ToPixels(point);
  body_.Open("circle", {{"class", absl::StrCat("dot ", style)},
                        {"cx", Number(at.x(), 1)},
                        {"cy", Number(at.y(), 1)},
                        {"r", Number(radius, 1)}});
  if (!hover.empty()) body_.Element("title", {}, hover);
  body_.Close();
}

void Chart::Rectangle(const double left, const double right,
                      const double height, const double min_width,
                      const std::string& style, const std::string& hover) {
  const Eigen::Vector2d low = ToPixels({left, y_.low});
  const Eigen::Vector2d high = ToPixels({right, height});
  body_.Open("rect",
             {{"class", style},
              {"x", Number(low.x(), 1)},
              {"y", Number(high.y(), 1)},
              {"width", Number(std::max(min_width, high.x() - low.x()), 1)},
              {"height", Number(low.y() - high.y(), 1)}});
  if (!hover.empty()) body_.Element("title", {}, hover);
  body_.Close();
}

void Chart::Bar(const double left, const double right, const double height,
                const std::string& style, const std::string& hover) {
  if (!(height > y_.low)) return;
  Rectangle(left, right, height, 0.5, absl::StrCat("bar ", style), hover);
}

void Chart::Band(const double left, const double right,
                 const std::string& style, const std::string& hover) {
  Rectangle(left, right, y_.high, 1.5, absl::StrCat("band ", style), hover);
}

void Chart::VerticalMark(const double x, const std::string& label) {
  if (!(x >= x_.low && x <= x_.high)) return;
  const Eigen::Vector2d low = ToPixels({x, y_.low});
  const Eigen::Vector2d high = ToPixels({x, y_.high});
  marks_.Empty("line", {{"class", "mark"},
                        {"x1", Number(low.x(), 1)},
                        {"y1", Number(low.y(), 1)},
                        {"x2", Number(high.x(), 1)},
                        {"y2", Number(high.y(), 1)}});
  marks_.Element("text",
                 {{"class", "mark-label"},
                  {"x", Number(low.x() + 4., 1)},
                  {"y", Number(high.y() + 11., 1)}},
                 label);
}

void Chart::HorizontalMark(const double y, const std::string& label) {
  if (!(y >= y_.low && y <= y_.high)) return;
  const Eigen::Vector2d low = ToPixels({x_.low, y});
  const Eigen::Vector2d high = ToPixels({x_.high, y});
  marks_.Empty("line", {{"class", "mark"},
                        {"x1", Number(low.x(), 1)},
                        {"y1", Number(low.y(), 1)},
                        {"x2", Number(high.x(), 1)},
                        {"y2", Number(high.y(), 1)}});
  marks_.Element("text",
                 {{"class", "mark-label end"},
                  {"x", Number(high.x() - 4., 1)},
                  {"y", Number(low.y() - 4., 1)}},
                 label);
}

void Chart::Ellipse(const Eigen::Vector2d& center,
                    const Eigen::Matrix2d& covariance, const double sigmas,
                    const std::string& style) {
  if (!center.allFinite() || !covariance.allFinite()) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  std::vector<Eigen::Vector2d> points;
  constexpr int kCorners = 48;
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = 2. * kPi * i / kCorners;
    const Eigen::Vector2d unit(std::cos(angle), std::sin(angle));
    points.push_back(
        center +
        sigmas *
            (solver.eigenvectors() *
             solver.eigenvalues().cwiseMax(0.).cwiseSqrt().cwiseProduct(unit)));
  }
  Line(points, style);
}

void Chart::Legend(const std::string& label, const std::string& style) {
  legend_.emplace_back(label, style);
}

std::string Chart::ToSvg() const {
  Markup svg;
  svg.Open("svg", {{"class", "chart"},
                   {"viewBox", absl::StrCat("0 0 ", width_, " ", height_)},
                   {"role", "img"},
                   {"aria-label", title_}});
  for (const double tick : RoundTicks(y_.low, y_.high, 5)) {
    const Eigen::Vector2d at = ToPixels({x_.low, tick});
    svg.Empty("line", {{"class", "grid"},
                       {"x1", Number(kLeft, 1)},
                       {"y1", Number(at.y(), 1)},
                       {"x2", Number(width_ - kRight, 1)},
                       {"y2", Number(at.y(), 1)}});
    svg.Element(
        "text",
        {{"class", "tick end"},
         {"x", Number(kLeft - 6., 1)},
         {"y", Number(at.y() + 4., 1)}},
        absl::StrFormat("%.*f", DecimalsFor((y_.high - y_.low) / 5.), tick));
  }
  for (const double tick : RoundTicks(x_.low, x_.high, 8)) {
    const Eigen::Vector2d at = ToPixels({tick, y_.low});
    svg.Empty("line", {{"class", "axis"},
                       {"x1", Number(at.x(), 1)},
                       {"y1", Number(at.y(), 1)},
                       {"x2", Number(at.x(), 1)},
                       {"y2", Number(at.y() + 4., 1)}});
    svg.Element(
        "text",
        {{"class", "tick middle"},
         {"x", Number(at.x(), 1)},
         {"y", Number(at.y() + 17., 1)}},
        absl::StrFormat("%.*f", DecimalsFor((x_.high - x_.low) / 8.), tick));
  }
  const Eigen::Vector2d corner = ToPixels({x_.low, y_.low});
  svg.Empty("line", {{"class", "axis"},
                     {"x1", Number(corner.x(), 1)},
                     {"y1", Number(corner.y(), 1)},
                     {"x2", Number(width_ - kRight, 1)},
                     {"y2", Number(corner.y(), 1)}});
  svg.Element("text",
              {{"class", "label middle"},
               {"x", Number(0.5 * (kLeft + width_ - kRight), 1)},
               {"y", Number(height_ - 8., 1)}},
              x_.label);
  svg.Element("text", {{"class", "label"}, {"x", "2"}, {"y", "13"}}, y_.label);
  if (!body_.empty()) svg.Raw(body_.str());
  if (!marks_.empty()) svg.Raw(marks_.str());
  // Beside the label of the y axis, from the right.
  double right = width_ - kRight;
  for (auto it = legend_.rbegin(); it != legend_.rend(); ++it) {
    const double text_width = 6.4 * static_cast<double>(it->first.size());
    right -= text_width;
    svg.Element("text",
                {{"class", "label"}, {"x", Number(right, 1)}, {"y", "13"}},
                it->first);
    right -= 14.;
    svg.Empty("rect", {{"class", absl::StrCat("key ", it->second)},
                       {"x", Number(right, 1)},
                       {"y", "4"},
                       {"width", "10"},
                       {"height", "10"}});
    right -= 14.;
  }
  svg.Close();
  return svg.str();
}

std::vector<int> Histogram(const std::vector<double>& values, const double low,
                           const double high, const int bins) {
  std::vector<int> counts(std::max(1, bins), 0);
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    const double share = (value - low) / (high - low);
    const int bin = std::clamp(static_cast<int>(std::floor(
                                   share * static_cast<double>(counts.size()))),
                               0, static_cast<int>(counts.size()) - 1);
    ++counts[bin];
  }
  return counts;
}

}  // namespace report
}  // namespace cartographer_ext
