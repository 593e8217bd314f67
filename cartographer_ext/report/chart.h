// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Charts as inline SVG: lines, points, bars, thresholds, over axes with round
// ticks. Colours are classes of the page's style (see style.h), so that they
// change with light and dark.
#ifndef CARTOGRAPHER_EXT_REPORT_CHART_H_
#define CARTOGRAPHER_EXT_REPORT_CHART_H_

#include <string>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/report/markup.h"

namespace cartographer_ext {
namespace report {

// Round values within [low, high], about `count` of them.
std::vector<double> RoundTicks(double low, double high, int count);

struct Axis {
  std::string label;  // with unit
  double low = 0.;
  double high = 1.;
};

class Chart {
 public:
  // `title` is the accessible name of the chart. Axes without extent are
  // widened.
  Chart(const std::string& title, Axis x, Axis y, int width = 640,
        int height = 260);

  // `style`: a class such as "s1". Points outside the axes are clamped to the
  // edge.
  void Line(const std::vector<Eigen::Vector2d>& points,
            const std::string& style);
  // `hover` is shown for the point; may be empty.
  void Point(const Eigen::Vector2d& point, const std::string& style,
             const std::string& hover, double radius = 2.5);
  // A bar from the x axis up, from `left` to `right`.
  void Bar(double left, double right, double height, const std::string& style,
           const std::string& hover);
  // Coloured background between two values of x.
  void Band(double left, double right, const std::string& style,
            const std::string& hover);
  // A dashed line across, with a label.
  void VerticalMark(double x, const std::string& label);
  void HorizontalMark(double y, const std::string& label);
  // The ellipse of a covariance at the given number of standard deviations.
  void Ellipse(const Eigen::Vector2d& center, const Eigen::Matrix2d& covariance,
               double sigmas, const std::string& style);
  void Legend(const std::string& label, const std::string& style);

  std::string ToSvg() const;

 private:
  Eigen::Vector2d ToPixels(const Eigen::Vector2d& point) const;
  // From the axis up to `height`; at least `min_width` pixels wide.
  void Rectangle(double left, double right, double height, double min_width,
                 const std::string& style, const std::string& hover);

  const std::string title_;
  const Axis x_, y_;
  const int width_, height_;
  Markup body_;
  Markup marks_;
  std::vector<std::pair<std::string, std::string>> legend_;
};

// Counts of values in bins of equal width; values outside are counted in the
// outermost bins.
std::vector<int> Histogram(const std::vector<double>& values, double low,
                           double high, int bins);

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_CHART_H_
