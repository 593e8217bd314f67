// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cairo.h"
#include "cartographer_ext/common/atomic_file.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr int kMaxPixels = 8192;
constexpr int kMinPixels = 64;
constexpr double kMargin = 24.;  // pixels
constexpr double kLegendTextSize = 16.;
constexpr double kUnknownGrey = 0.88;
constexpr int kBytesPerPixel = 4;

// 1, 2 or 5 times a power of ten, at most `limit`.
double RoundLength(double limit) {
  const double power = std::pow(10., std::floor(std::log10(limit)));
  for (const double factor : {5., 2.}) {
    if (factor * power <= limit) return factor * power;
  }
  return power;
}

cairo_status_t WriteToStream(void* closure, const unsigned char* data,
                             unsigned int length) {
  std::ostream* const out = static_cast<std::ostream*>(closure);
  out->write(reinterpret_cast<const char*>(data), length);
  return out->good() ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

bool IsFinite(const Eigen::Vector2d& point) { return point.allFinite(); }

// Makes the cells of a map pixels of CAIRO_FORMAT_RGB24, in their place: of a
// large map, there is no room for both. Row 0 of a picture is the top.
unsigned char* ToPixels(OccupancyMap* const map) {
  static_assert(sizeof(float) == kBytesPerPixel, "a pixel replaces a cell");
  unsigned char* const bytes =
      reinterpret_cast<unsigned char*>(map->occupancy.data());
  for (size_t i = 0; i != map->occupancy.size(); ++i) {
    const double occupancy = map->occupancy[i];
    const double grey = std::isnan(occupancy)
                            ? kUnknownGrey
                            : 1. - std::min(1., std::max(0., occupancy));
    const uint32_t value = static_cast<uint32_t>(std::lround(255. * grey));
    const uint32_t pixel = value << 16 | value << 8 | value;
    std::memcpy(bytes + kBytesPerPixel * i, &pixel, kBytesPerPixel);
  }
  const size_t stride = kBytesPerPixel * static_cast<size_t>(map->width);
  for (int y = 0; y < map->height / 2; ++y) {
    unsigned char* const row = bytes + stride * y;
    std::swap_ranges(row, row + stride, bytes + stride * (map->height - 1 - y));
  }
  return bytes;
}

}  // namespace

void PictureBounds::Add(const Eigen::Vector2d& point) {
  if (!IsFinite(point)) return;
  min_x = std::min(min_x, point.x());
  min_y = std::min(min_y, point.y());
  max_x = std::max(max_x, point.x());
  max_y = std::max(max_y, point.y());
}

void PictureBounds::Add(const OccupancyMap& map) {
  const double width = map.width * map.resolution;
  const double height = map.height * map.resolution;
  for (const double x : {0., width}) {
    for (const double y : {0., height}) {
      Add(map.origin * Eigen::Vector2d(x, y));
    }
  }
}

class Picture::Canvas {
 public:
  Canvas(PictureBounds bounds, int size) {
    if (!(bounds.max_x >= bounds.min_x) || !(bounds.max_y >= bounds.min_y)) {
      bounds.min_x = bounds.min_y = -0.5;
      bounds.max_x = bounds.max_y = 0.5;
    }
    // The picture must have a sensible size whatever the coordinates.
    const double extent = std::max(
        {bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y, 1e-3});
    const int longer = std::min(kMaxPixels, std::max(kMinPixels, size));
    scale_ = (longer - 2. * kMargin) / extent;
    width_ = Pixels(bounds.max_x - bounds.min_x);
    height_ = Pixels(bounds.max_y - bounds.min_y);
    center_ = 0.5 * Eigen::Vector2d(bounds.min_x + bounds.max_x,
                                    bounds.min_y + bounds.max_y);
    surface_ = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width_, height_);
    context_ = cairo_create(surface_);
    cairo_set_source_rgb(context_, 1., 1., 1.);
    cairo_paint(context_);
    cairo_set_line_cap(context_, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(context_, CAIRO_LINE_JOIN_ROUND);
  }
  ~Canvas() {
    cairo_destroy(context_);
    cairo_surface_destroy(surface_);
  }
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }

  // Far outside, cairo's fixed-point numbers would overflow.
  Eigen::Vector2d ToPixel(const Eigen::Vector2d& point) const {
    constexpr double kLimit = 100000.;
    const double x = 0.5 * width_ + scale_ * (point.x() - center_.x());
    const double y = 0.5 * height_ - scale_ * (point.y() - center_.y());
    return Eigen::Vector2d(std::min(kLimit, std::max(-kLimit, x)),
                           std::min(kLimit, std::max(-kLimit, y)));
  }

  void SetColor(const Color& color) {
    cairo_set_source_rgba(context_, color.red, color.green, color.blue,
                          color.alpha);
  }

  void Stroke(const LineStyle& style) {
    SetColor(style.color);
    cairo_set_line_width(context_, style.width);
    const double dashes[] = {4. * style.width, 3. * style.width};
    cairo_set_dash(context_, dashes, style.dashed ? 2 : 0, 0.);
    cairo_stroke(context_);
  }

  // Adds the points to the path, restarting behind points that are skipped.
  void Path(const std::vector<Eigen::Vector2d>& points) {
    bool connected = false;
    for (const Eigen::Vector2d& point : points) {
      if (!IsFinite(point)) {
        connected = false;
        continue;
      }
      const Eigen::Vector2d pixel = ToPixel(point);
      if (connected) {
        cairo_line_to(context_, pixel.x(), pixel.y());
      } else {
        cairo_move_to(context_, pixel.x(), pixel.y());
      }
      connected = true;
    }
  }

  void Text(double x, double y, const std::string& text, double size,
            const Color& color, bool bold) {
    cairo_select_font_face(
        context_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
        bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context_, size);
    SetColor(color);
    cairo_move_to(context_, x, y);
    cairo_show_text(context_, text.c_str());
    cairo_new_path(context_);
  }

  double TextWidth(const std::string& text, double size) {
    cairo_select_font_face(context_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context_, size);
    cairo_text_extents_t extents;
    cairo_text_extents(context_, text.c_str(), &extents);
    return extents.x_advance;
  }

  // A nearly opaque panel, so that text stays readable on any map.
  void Panel(double x, double y, double width, double height) {
    cairo_set_source_rgba(context_, 1., 1., 1., 0.85);
    cairo_rectangle(context_, x, y, width, height);
    cairo_fill(context_);
  }

  void DrawMap(OccupancyMap map);
  void DrawTitle();
  void DrawLegend();
  void DrawScaleBar();

  cairo_surface_t* surface() { return surface_; }
  cairo_t* context() { return context_; }

  std::string title;
  std::vector<std::pair<std::string, Color>> legend;

 private:
  int Pixels(double extent) const {
    const double pixels = std::ceil(scale_ * extent + 2. * kMargin);
    return static_cast<int>(
        std::min<double>(kMaxPixels, std::max<double>(kMinPixels, pixels)));
  }

  double scale_;  // pixels per metre
  int width_;
  int height_;
  Eigen::Vector2d center_;
  cairo_surface_t* surface_;
  cairo_t* context_;
};

void Picture::Canvas::DrawMap(OccupancyMap map) {
  if (map.width < 1 || map.height < 1 || !(map.resolution > 0.) ||
      map.occupancy.size() != static_cast<size_t>(map.width) * map.height) {
    return;
  }
  // One pixel a cell; cairo scales it.
  cairo_surface_t* const cells = cairo_image_surface_create_for_data(
      ToPixels(&map), CAIRO_FORMAT_RGB24, map.width, map.height,
      kBytesPerPixel * map.width);
  if (cairo_surface_status(cells) != CAIRO_STATUS_SUCCESS) {
    cairo_surface_destroy(cells);
    return;
  }
  const Eigen::Vector2d corner = ToPixel(map.origin.translation());
  cairo_save(context_);
  cairo_translate(context_, corner.x(), corner.y());
  cairo_rotate(context_, -map.origin.theta);
  const double cell = scale_ * map.resolution;
  cairo_scale(context_, cell, cell);
  cairo_set_source_surface(context_, cells, 0., -map.height);
  // Cells smaller than a pixel are averaged; larger ones stay sharp.
  cairo_pattern_set_filter(
      cairo_get_source(context_),
      cell < 1. ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
  cairo_paint(context_);
  cairo_restore(context_);
  cairo_surface_destroy(cells);
}

void Picture::Canvas::DrawTitle() {
  if (title.empty()) return;
  constexpr double kSize = 20.;
  Panel(0., 0., width_, 1.6 * kSize);
  Text(0.5 * kMargin, 1.15 * kSize, title, kSize, palette::kBlack, true);
}

void Picture::Canvas::DrawLegend() {
  if (legend.empty()) return;
  constexpr double kRow = 1.5 * kLegendTextSize;
  constexpr double kSample = 28.;
  double text_width = 0.;
  for (const auto& entry : legend) {
    text_width = std::max(text_width, TextWidth(entry.first, kLegendTextSize));
  }
  const double width = kSample + text_width + 28.;
  const double height = kRow * legend.size() + 10.;
  const double left = std::max(0., width_ - width - 8.);
  const double top = title.empty() ? 8. : 40.;
  Panel(left, top, width, height);
  double y = top + 5. + 0.5 * kRow;
  for (const auto& entry : legend) {
    cairo_move_to(context_, left + 8., y);
    cairo_line_to(context_, left + 8. + kSample, y);
    LineStyle style;
    style.color = entry.second;
    style.color.alpha = 1.;
    style.width = 4.;
    Stroke(style);
    Text(left + kSample + 18., y + 0.35 * kLegendTextSize, entry.first,
         kLegendTextSize, palette::kBlack, false);
    y += kRow;
  }
}

void Picture::Canvas::DrawScaleBar() {
  const double length = RoundLength(0.25 * width_ / scale_);
  const double pixels = length * scale_;
  const std::string label = length >= 1.
                                ? absl::StrFormat("%.0f m", length)
                                : absl::StrFormat("%g cm", 100. * length);
  const double left = 0.5 * kMargin;
  const double bottom = height_ - 0.5 * kMargin;
  Panel(left - 6., bottom - 26., std::max(pixels, 60.) + 12., 34.);
  LineStyle style;
  style.width = 2.;
  cairo_move_to(context_, left, bottom - 5.);
  cairo_line_to(context_, left, bottom);
  cairo_line_to(context_, left + pixels, bottom);
  cairo_line_to(context_, left + pixels, bottom - 5.);
  Stroke(style);
  Text(left + 4., bottom - 8., label, 14., palette::kBlack, false);
}

Picture::Picture(const PictureBounds& bounds, int size)
    : canvas_(new Canvas(bounds, size)) {}

Picture::~Picture() = default;

int Picture::width() const { return canvas_->width(); }
int Picture::height() const { return canvas_->height(); }

void Picture::DrawMap(OccupancyMap map) { canvas_->DrawMap(std::move(map)); }

void Picture::DrawPolyline(const std::vector<Eigen::Vector2d>& points,
                           const LineStyle& style) {
  // Very long paths are stroked in parts; cairo's time grows with the square.
  constexpr size_t kPart = 1000;
  for (size_t begin = 0; begin + 1 < points.size(); begin += kPart) {
    const size_t end = std::min(points.size(), begin + kPart + 1);
    canvas_->Path({points.begin() + begin, points.begin() + end});
    canvas_->Stroke(style);
  }
}

void Picture::DrawLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                       const LineStyle& style) {
  canvas_->Path({from, to});
  canvas_->Stroke(style);
}

void Picture::DrawPolygon(const std::vector<Eigen::Vector2d>& points,
                          const LineStyle& outline, const Color& fill) {
  canvas_->Path(points);
  cairo_close_path(canvas_->context());
  canvas_->SetColor(fill);
  cairo_fill_preserve(canvas_->context());
  canvas_->Stroke(outline);
}

void Picture::DrawCircle(const Eigen::Vector2d& center, double radius,
                         const LineStyle& style) {
  constexpr int kNumCorners = 64;
  if (!IsFinite(center) || !(radius > 0.)) return;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= kNumCorners; ++i) {
    const double angle = 2. * kPi * i / kNumCorners;
    points.push_back(
        center + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  canvas_->Path(points);
  canvas_->Stroke(style);
}

void Picture::DrawDot(const Eigen::Vector2d& center, double radius,
                      const Color& color) {
  if (!IsFinite(center) || !(radius > 0.)) return;
  const Eigen::Vector2d pixel = canvas_->ToPixel(center);
  cairo_new_path(canvas_->context());
  cairo_arc(canvas_->context(), pixel.x(), pixel.y(), radius, 0., 2. * kPi);
  canvas_->SetColor(color);
  cairo_fill(canvas_->context());
}

void Picture::DrawText(const Eigen::Vector2d& place, const std::string& text,
                       double size, const Color& color) {
  if (!IsFinite(place)) return;
  const Eigen::Vector2d pixel = canvas_->ToPixel(place);
  canvas_->Text(pixel.x(), pixel.y(), text, size, color, false);
}

void Picture::SetTitle(const std::string& title) { canvas_->title = title; }

void Picture::AddLegend(const std::string& label, const Color& color) {
  canvas_->legend.emplace_back(label, color);
}

absl::Status Picture::Write(const std::string& filename) {
  canvas_->DrawTitle();
  canvas_->DrawLegend();
  canvas_->DrawScaleBar();
  AtomicFile file(filename);
  if (!file.status().ok()) return file.status();
  cairo_surface_flush(canvas_->surface());
  const cairo_status_t status = cairo_surface_write_to_png_stream(
      canvas_->surface(), WriteToStream, &file.stream());
  if (status != CAIRO_STATUS_SUCCESS) {
    return absl::UnavailableError(absl::StrCat("cannot write ", filename, ": ",
                                               cairo_status_to_string(status)));
  }
  return file.Commit();
}

}  // namespace io
}  // namespace cartographer_ext
