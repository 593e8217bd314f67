// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/report/chart.h"
#include "cartographer_ext/report/sections.h"

namespace cartographer_ext {
namespace report {
namespace {

constexpr int kWidth = 1120;
constexpr int kHeight = 220;
constexpr size_t kMaxPoints = 1500;

// The largest value of each run of neighbours, so that peaks survive.
std::vector<Eigen::Vector2d> ThinOut(
    const std::vector<Eigen::Vector2d>& points) {
  const size_t step = 1 + points.size() / kMaxPoints;
  std::vector<Eigen::Vector2d> result;
  for (size_t i = 0; i < points.size(); i += step) {
    Eigen::Vector2d best = points[i];
    for (size_t k = i; k < std::min(points.size(), i + step); ++k) {
      if (points[k].y() > best.y()) best = points[k];
    }
    result.push_back(best);
  }
  return result;
}

double LastTime(const ReportData& data, const Prepared& prepared) {
  double last = 1.;
  for (const auto& node : data.runs[0].graph.nodes) {
    last = std::max(last, io::ToSeconds(node.second.time - prepared.start));
  }
  return last;
}

void AddFigure(const Chart& chart, const std::string& caption,
               Markup* const page) {
  page->Open("figure");
  page->Raw(chart.ToSvg());
  page->Element("figcaption", {}, caption);
  page->Close();
}

void AddContradiction(const ReportData& data, const Prepared& prepared,
                      const Axis& time, Markup* const page) {
  Chart chart("Contradiction along the path", time,
              {"share of rays contradicted the worst submap", 0., 1.}, kWidth,
              kHeight);
  for (const auto& piece : data.runs[0].evaluation.consistency->places) {
    chart.Band(io::ToSeconds(piece.begin - prepared.start),
               io::ToSeconds(piece.end - prepared.start), "s2",
               absl::StrCat("nodes ", evaluation::ToString(piece.first_node),
                            " to ", evaluation::ToString(piece.last_node)));
  }
  for (const ReportRun& run : data.runs) {
    if (!run.evaluation.consistency.has_value()) continue;
    std::vector<Eigen::Vector2d> points;
    for (const auto& node : run.evaluation.consistency->contradictions.nodes) {
      points.emplace_back(io::ToSeconds(node.time - prepared.start),
                          node.worst_fraction);
    }
    chart.Line(ThinOut(points), run.style);
    chart.Legend(run.name, run.style);
  }
  chart.HorizontalMark(0.6, "severe");
  AddFigure(chart,
            "Share of the rays of each scan that end in free space or pass "
            "through walls of the worst-fitting submap of another time. "
            "Shaded: the places that decide the verdict.",
            page);
}

void AddMotion(const ReportData& data, const Prepared& prepared,
               const Axis& time, Markup* const page) {
  const auto& motion = data.runs[0].evaluation.consistency->motion;
  if (motion.odometry_translation.count == 0) return;
  std::vector<Eigen::Vector2d> points;
  double highest = 5.;
  for (const auto& step : motion.steps) {
    if (!step.has_odometry) continue;
    const double degrees = RadToDeg(step.odometry_rotation);
    highest = std::max(highest, degrees);
    points.emplace_back(io::ToSeconds(step.time - prepared.start), degrees);
  }
  Chart chart("Local SLAM against odometry", time,
              {"degrees from node to node", 0., 1.05 * highest}, kWidth,
              kHeight);
  chart.Line(ThinOut(points), "s4");
  chart.HorizontalMark(30., "wrong turn");
  AddFigure(chart,
            "Difference of the rotation from node to node between local SLAM "
            "and the wheels. A spike is a wrongly matched scan, or slip.",
            page);
}

void AddDegeneracy(const ReportData& data, const Prepared& prepared,
                   const Axis& time, Markup* const page) {
  if (data.degeneracy.empty()) return;
  std::vector<Eigen::Vector2d> points;
  for (const DegeneracySample& sample : data.degeneracy) {
    points.emplace_back(io::ToSeconds(sample.time - prepared.start),
                        sample.ratio);
  }
  Chart chart("Degeneracy along the path", time,
              {"weakest to strongest direction", 0., 1.}, kWidth, kHeight);
  double begin = 0.;
  bool open = false;
  for (const DegeneracySample& sample : data.degeneracy) {
    const double seconds = io::ToSeconds(sample.time - prepared.start);
    if (sample.degenerate && !open) begin = seconds;
    if (!sample.degenerate && open) chart.Band(begin, seconds, "s6", "");
    open = sample.degenerate;
  }
  if (open) chart.Band(begin, time.high, "s6", "");
  // Small values matter here: the valleys are kept.
  std::vector<Eigen::Vector2d> turned = points;
  for (Eigen::Vector2d& point : turned) point.y() = -point.y();
  turned = ThinOut(turned);
  for (Eigen::Vector2d& point : turned) point.y() = -point.y();
  chart.Line(turned, "s1");
  AddFigure(chart,
            "Information of the scan about the robot's position in its weakest "
            "direction, relative to the strongest. Shaded: degenerate scans, "
            "such as in a corridor without doors.",
            page);
}

}  // namespace

void AddPath(const ReportData& data, const Prepared& prepared,
             Markup* const page) {
  if (!data.runs[0].evaluation.consistency.has_value()) return;
  AddHeading("path", "Along the path", page);
  const Axis time{"seconds after the start", 0., LastTime(data, prepared)};
  AddContradiction(data, prepared, time, page);
  AddMotion(data, prepared, time, page);
  AddDegeneracy(data, prepared, time, page);
}

}  // namespace report
}  // namespace cartographer_ext
