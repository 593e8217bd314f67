// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Drawings of maps, trajectories and constraints as PNG, by cairo. Coordinates
// are metres in the map frame, x to the right, y up; widths and text are in
// pixels. Later elements cover earlier ones; legend and scale bar are on top.
//
//   PictureBounds bounds;
//   bounds.Add(map);
//   Picture picture(bounds);
//   picture.DrawMap(std::move(map));
//   picture.DrawPolyline(points, {palette::kBlue, 2.});
//   picture.AddLegend("trajectory", palette::kBlue);
//   status = picture.Write("map.png");
#ifndef CARTOGRAPHER_EXT_IO_PICTURE_H_
#define CARTOGRAPHER_EXT_IO_PICTURE_H_

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "Eigen/Core"
#include "absl/status/status.h"
#include "cartographer_ext/io/occupancy_map.h"

namespace cartographer_ext {
namespace io {

struct Color {
  double red, green, blue;  // 0 to 1
  double alpha = 1.;
};

// The palette of Okabe and Ito, distinguishable by colour-blind readers.
namespace palette {
constexpr Color kBlack{0., 0., 0.};
constexpr Color kGrey{0.6, 0.6, 0.6};
constexpr Color kOrange{0.90, 0.62, 0.};
constexpr Color kSkyBlue{0.34, 0.71, 0.91};
constexpr Color kGreen{0., 0.62, 0.45};
constexpr Color kYellow{0.94, 0.89, 0.26};
constexpr Color kBlue{0., 0.45, 0.70};
constexpr Color kVermilion{0.84, 0.37, 0.};
constexpr Color kPurple{0.80, 0.47, 0.65};
}  // namespace palette

struct LineStyle {
  Color color = palette::kBlack;
  double width = 1.5;  // pixels
  bool dashed = false;
};

// The part of the plane a picture shows.
struct PictureBounds {
  double min_x = std::numeric_limits<double>::infinity();
  double min_y = std::numeric_limits<double>::infinity();
  double max_x = -std::numeric_limits<double>::infinity();
  double max_y = -std::numeric_limits<double>::infinity();

  // Points that are not finite are ignored.
  void Add(const Eigen::Vector2d& point);
  void Add(const OccupancyMap& map);
};

class Picture {
 public:
  // The longer side gets `size` pixels, at most 8192; a margin is added. Empty
  // bounds show the square metre around the origin.
  explicit Picture(const PictureBounds& bounds, int size = 1600);
  ~Picture();
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  int width() const;
  int height() const;

  // Occupied black, free white, unknown light grey. No copy is made of a map
  // that is moved: its cells become the pixels.
  void DrawMap(OccupancyMap map);
  // Breaks the line at points that are not finite.
  void DrawPolyline(const std::vector<Eigen::Vector2d>& points,
                    const LineStyle& style);
  void DrawLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                const LineStyle& style);
  void DrawPolygon(const std::vector<Eigen::Vector2d>& points,
                   const LineStyle& outline, const Color& fill);
  // `radius` in metres.
  void DrawCircle(const Eigen::Vector2d& center, double radius,
                  const LineStyle& style);
  // `radius` in pixels, filled.
  void DrawDot(const Eigen::Vector2d& center, double radius,
               const Color& color);
  // Left end of the base line at `place`; `size` in pixels.
  void DrawText(const Eigen::Vector2d& place, const std::string& text,
                double size, const Color& color);

  void SetTitle(const std::string& title);
  void AddLegend(const std::string& label, const Color& color);

  // Draws title, legend and scale bar, and writes the file atomically.
  absl::Status Write(const std::string& filename);

 private:
  class Canvas;
  std::unique_ptr<Canvas> canvas_;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_PICTURE_H_
