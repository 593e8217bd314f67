// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A map with overlays, as inline SVG. All coordinates are metres in the frame
// of the map, x to the right, y up.
#ifndef CARTOGRAPHER_EXT_REPORT_MAP_FIGURE_H_
#define CARTOGRAPHER_EXT_REPORT_MAP_FIGURE_H_

#include <string>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/picture.h"
#include "cartographer_ext/report/markup.h"

namespace cartographer_ext {
namespace report {

// Pictures used by several figures are embedded once.
class ImageStore {
 public:
  // Adds a picture with a new id.
  void Add(const std::string& id, const io::OccupancyMap& map);
  // Must precede the figures in the page.
  std::string ToHtml() const;

 private:
  Markup definitions_;
};

class MapFigure {
 public:
  // `bounds`: the part that is shown; must not be empty.
  MapFigure(const std::string& title, const io::PictureBounds& bounds);

  // Draws a picture of the store.
  void Image(const std::string& id);
  // Breaks the line at points that are not finite.
  void Path(const std::vector<Eigen::Vector2d>& points,
            const std::string& style);
  // The same in segments, so that the script can cut it at a time: `seconds` of
  // each point. The style "by-time" colours it from the start to the end.
  void TimedPath(const std::vector<Eigen::Vector2d>& points,
                 const std::vector<double>& seconds, const std::string& style);
  // `more`: additional attributes, for the script.
  void Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
            const std::string& style, const std::string& hover,
            const Attributes& more = {});
  void Dots(const std::vector<Eigen::Vector2d>& points,
            const std::string& style);
  // A ring with a label beside it; `radius` in metres.
  void Ring(const Eigen::Vector2d& center, double radius,
            const std::string& label, const std::string& hover,
            const Attributes& more = {});
  void Legend(const std::string& label, const std::string& style);

  // With a scale bar; the legend is below.
  std::string ToHtml() const;

 private:
  Eigen::Vector2d ToUnits(const Eigen::Vector2d& point) const;

  const std::string title_;
  const io::PictureBounds bounds_;
  double units_;  // a metre
  Markup body_;
  Markup legend_;
};

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_MAP_FIGURE_H_
