// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/sensitivity_plot.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cairo-svg.h"
#include "cairo.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/configuration/lua_value.h"
#include "cartographer_ext/io/picture.h"
#include "cartographer_ext/tuning/comparable_trials.h"
#include "cartographer_ext/tuning/sensitivity.h"

namespace cartographer_ext {
namespace tuning {
namespace {

constexpr int kColumns = 3;
constexpr double kCellWidth = 360., kCellHeight = 250.;
constexpr double kHeader = 40.;
constexpr double kLeft = 62., kRight = 14., kTop = 40., kBottom = 34.;

struct Data : ComparableTrials {
  // Whether the objectives of the whole recordings are on the same scale.
  bool has_whole() const { return fidelity == 1.; }
  double low = 0., high = 1.;  // of the objective's axis
  bool is_log = false;
};

Data Collect(const TuneResult& result) {
  Data data;
  static_cast<ComparableTrials&>(data) = SelectComparable(result.trials);
  std::vector<double> all = data.objectives;
  if (data.has_whole()) {
    all.push_back(result.baseline.objective);
    all.push_back(result.best.objective);
  }
  data.low = *std::min_element(all.begin(), all.end());
  data.high = *std::max_element(all.begin(), all.end());
  data.is_log = data.low > 0. && data.high > 4. * data.low;
  const double margin = data.is_log ? 0. : 0.05 * (data.high - data.low);
  data.low = data.is_log ? data.low / 1.1 : data.low - margin;
  data.high = data.is_log ? data.high * 1.1 : data.high + margin;
  if (!(data.high > data.low)) data.high = data.low + 1.;
  return data;
}

double HeightOf(const Data& data, const double objective) {
  const double share =
      data.is_log
          ? std::log(objective / data.low) / std::log(data.high / data.low)
          : (objective - data.low) / (data.high - data.low);
  return std::min(std::max(share, 0.), 1.);
}

// One of the small plots, with its upper left corner at the origin.
class Cell {
 public:
  Cell(cairo_t* const cairo, const Parameter& parameter, const size_t index,
       const Data& data)
      : cairo_(cairo), parameter_(parameter), index_(index), data_(data) {}

  void Draw(const TuneResult& result, const Sensitivity& sensitivity) {
    SetColor(io::palette::kBlack);
    // The last components of the name are the most specific.
    std::string title = parameter_.key;
    if (title.size() > 50) title = "..." + title.substr(title.size() - 47);
    Text(kLeft - 50., 16., title, 11.);
    SetColor(io::palette::kGrey);
    Text(kLeft - 50., 31.,
         absl::StrFormat("effect %.2f, trend %+.2f", sensitivity.effect,
                         sensitivity.trend),
         10.);
    cairo_set_line_width(cairo_, 1.);
    cairo_rectangle(cairo_, kLeft, kTop, Width(), Height());
    cairo_stroke(cairo_);
    DrawLabels();
    DrawMedians();
    SetColor(io::palette::kBlue, 0.55);
    for (size_t i = 0; i < data_.points.size(); ++i) {
      Dot(X(data_.points[i][index_]), Y(data_.objectives[i]), 2.5);
      cairo_fill(cairo_);
    }
    SetColor(io::palette::kGrey);
    const double dashes[] = {4., 3.};
    cairo_set_dash(cairo_, dashes, 2, 0.);
    VerticalLine(X(result.baseline.point[index_]));
    cairo_set_dash(cairo_, dashes, 0, 0.);
    SetColor(io::palette::kVermilion);
    cairo_set_line_width(cairo_, 2.);
    const double x = X(result.best.point[index_]);
    if (data_.has_whole()) {
      Dot(x, Y(result.best.objective), 5.);
      cairo_stroke(cairo_);
    } else {
      VerticalLine(x);
    }
  }

 private:
  static double Width() { return kCellWidth - kLeft - kRight; }
  static double Height() { return kCellHeight - kTop - kBottom; }
  double X(const Value& value) const {
    return kLeft + parameter_.ToUnit(value) * Width();
  }
  double Y(const double objective) const {
    return kTop + (1. - HeightOf(data_, objective)) * Height();
  }
  void SetColor(const io::Color& color, const double alpha = 1.) {
    cairo_set_source_rgba(cairo_, color.red, color.green, color.blue, alpha);
  }
  void Dot(const double x, const double y, const double radius) {
    cairo_new_sub_path(cairo_);
    cairo_arc(cairo_, x, y, radius, 0., 2. * kPi);
  }
  void VerticalLine(const double x) {
    cairo_move_to(cairo_, x, kTop);
    cairo_line_to(cairo_, x, kTop + Height());
    cairo_stroke(cairo_);
  }
  void Text(const double x, const double y, const std::string& text,
            const double size) {
    cairo_set_font_size(cairo_, size);
    cairo_move_to(cairo_, x, y);
    cairo_show_text(cairo_, text.c_str());
  }

  void DrawLabels() {
    SetColor(io::palette::kBlack);
    const double bottom = kTop + Height() + 14.;
    if (parameter_.kind == Parameter::Kind::kChoice) {
      for (const Value& choice : parameter_.choices) {
        Text(X(choice) - 12., bottom, evaluation::ToLua(choice).substr(0, 12),
             10.);
      }
    } else {
      Text(kLeft, bottom, absl::StrFormat("%.4g", parameter_.low), 10.);
      Text(kLeft + Width() - 34., bottom,
           absl::StrFormat("%.4g", parameter_.high), 10.);
      if (parameter_.log_scale) {
        Text(kLeft + 0.5 * Width() - 10., bottom, "log", 10.);
      }
    }
    Text(8., kTop + 8., absl::StrFormat("%.3g", data_.high), 10.);
    Text(8., kTop + Height(), absl::StrFormat("%.3g", data_.low), 10.);
    if (data_.is_log) Text(8., kTop + 0.5 * Height(), "log", 10.);
  }

  void DrawMedians() {
    const int groups = parameter_.kind == Parameter::Kind::kChoice
                           ? static_cast<int>(parameter_.choices.size())
                           : 4;
    SetColor(io::palette::kSkyBlue);
    cairo_set_line_width(cairo_, 3.);
    for (int group = 0; group < groups; ++group) {
      std::vector<double> members;
      for (size_t i = 0; i < data_.points.size(); ++i) {
        const double unit = parameter_.ToUnit(data_.points[i][index_]);
        if (std::min(static_cast<int>(unit * groups), groups - 1) == group) {
          members.push_back(data_.objectives[i]);
        }
      }
      if (members.empty()) continue;
      const double y = Y(UpperMedian(std::move(members)));
      cairo_move_to(cairo_, kLeft + Width() * group / groups, y);
      cairo_line_to(cairo_, kLeft + Width() * (group + 1) / groups, y);
      cairo_stroke(cairo_);
    }
    cairo_set_line_width(cairo_, 1.);
  }

  cairo_t* const cairo_;
  const Parameter& parameter_;
  const size_t index_;
  const Data& data_;
};

void DrawAll(cairo_t* const cairo, const TuneResult& result,
             const ResultContext& context) {
  const Data data = Collect(result);
  const auto sensitivities =
      ComputeSensitivity(context.parameters, data.points, data.objectives);
  std::vector<size_t> order(context.parameters.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return sensitivities[a].effect > sensitivities[b].effect;
  });
  cairo_set_source_rgb(cairo, 1., 1., 1.);
  cairo_paint(cairo);
  cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_source_rgb(cairo, 0., 0., 0.);
  cairo_set_font_size(cairo, 15.);
  cairo_move_to(cairo, 12., 26.);
  cairo_show_text(cairo,
                  absl::StrFormat("%s: %.4g before, %.4g best; dots: %s",
                                  context.objective, result.baseline.objective,
                                  result.best.objective, ToText(data))
                      .c_str());
  for (size_t i = 0; i < order.size(); ++i) {
    cairo_save(cairo);
    cairo_translate(cairo, kCellWidth * static_cast<double>(i % kColumns),
                    kHeader + kCellHeight * static_cast<double>(i / kColumns));
    Cell(cairo, context.parameters[order[i]], order[i], data)
        .Draw(result, sensitivities[order[i]]);
    cairo_restore(cairo);
  }
}

}  // namespace

absl::Status WriteSensitivityPlot(const TuneResult& result,
                                  const ResultContext& context,
                                  const std::string& filename) {
  const size_t rows = (context.parameters.size() + kColumns - 1) / kColumns;
  const double width = kColumns * kCellWidth;
  const double height = kHeader + static_cast<double>(rows) * kCellHeight;
  AtomicFile file(filename);
  if (!file.status().ok()) return file.status();
  const std::string path = file.temporary_path();
  const bool is_svg = absl::EndsWith(filename, ".svg");
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface(
      is_svg ? cairo_svg_surface_create(path.c_str(), width, height)
             : cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                          static_cast<int>(width),
                                          static_cast<int>(height)),
      &cairo_surface_destroy);
  {
    const std::unique_ptr<cairo_t, void (*)(cairo_t*)> cairo(
        cairo_create(surface.get()), &cairo_destroy);
    DrawAll(cairo.get(), result, context);
  }
  cairo_status_t status = cairo_surface_status(surface.get());
  if (status == CAIRO_STATUS_SUCCESS && !is_svg) {
    status = cairo_surface_write_to_png(surface.get(), path.c_str());
  }
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) {
    status = cairo_surface_status(surface.get());
  }
  if (status != CAIRO_STATUS_SUCCESS) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, ": ", cairo_status_to_string(status)));
  }
  return file.Commit();
}

}  // namespace tuning
}  // namespace cartographer_ext
