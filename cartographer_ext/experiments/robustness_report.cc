// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/robustness_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/io/picture.h"
#include "cartographer_ext/metrics/statistics.h"

namespace cartographer_ext {
namespace experiments {
namespace {

template <typename Member>
double MedianOf(const std::vector<const SweepRun*>& runs, Member member) {
  std::vector<double> values;
  for (const SweepRun* const run : runs) values.push_back(run->*member);
  return evaluation::ComputeStatistics(std::move(values)).median;
}

const SweepCell* Find(const std::vector<SweepCell>& cells,
                      const PrintedRow& row, const std::string& kernel) {
  for (const SweepCell& cell : cells) {
    if (cell.dataset == row.dataset && cell.type == row.type &&
        cell.count == row.count && cell.kernel == kernel) {
      return &cell;
    }
  }
  return nullptr;
}

std::string Number(const double value, const char* const format_unit) {
  return value < 0. ? "-" : absl::StrFormat("%.3g%s", value, format_unit);
}

}  // namespace

std::vector<SweepCell> Summarize(const std::vector<SweepRun>& runs) {
  std::vector<SweepCell> cells;
  std::map<std::string, size_t> index;
  std::vector<std::vector<const SweepRun*>> members;
  for (const SweepRun& run : runs) {
    // The number of outliers differs between the graphs of a family.
    const std::string key = absl::StrCat(
        run.is_family ? "family " : "", run.dataset, "|", run.kernel, "|",
        run.type, "|",
        run.is_family ? run.requested_count : absl::StrCat(run.count));
    if (index.emplace(key, cells.size()).second) {
      SweepCell cell;
      cell.dataset = run.dataset;
      cell.kernel = run.kernel;
      cell.type = run.type;
      cell.count = run.count;
      cells.push_back(cell);
      members.emplace_back();
    }
    members[index[key]].push_back(&run);
  }
  for (size_t i = 0; i != cells.size(); ++i) {
    SweepCell& cell = cells[i];
    const std::vector<const SweepRun*>& of_cell = members[i];
    cell.runs = of_cell.size();
    cell.cpu_seconds = MedianOf(of_cell, &SweepRun::cpu_seconds);
    cell.ate = MedianOf(of_cell, &SweepRun::ate);
    cell.ate_truth = MedianOf(of_cell, &SweepRun::ate_truth);
    cell.rpe = MedianOf(of_cell, &SweepRun::rpe);
    cell.precision = MedianOf(of_cell, &SweepRun::precision);
    cell.recall = MedianOf(of_cell, &SweepRun::recall);
    cell.truncated = MedianOf(of_cell, &SweepRun::truncated);
    cell.step_mean = MedianOf(of_cell, &SweepRun::step_mean);
    cell.step_p99 = MedianOf(of_cell, &SweepRun::step_p99);
    int successes = 0;
    for (const SweepRun* const run : of_cell) {
      cell.ate_largest = std::max(cell.ate_largest, run->ate);
      cell.step_max = std::max(cell.step_max, run->step_max);
      successes += run->success;
      cell.same_by_data += run->success && !run->success_by_ate;
      cell.unfinished += !run->converged;
      cell.undecidable += run->undecidable;
    }
    cell.success_rate = static_cast<double>(successes) / cell.runs;
  }
  return cells;
}

std::vector<SweepLimit> FindLimits(const std::vector<SweepRun>& runs) {
  std::vector<SweepLimit> limits;
  for (const SweepRun& run : runs) {
    auto limit = std::find_if(
        limits.begin(), limits.end(), [&](const SweepLimit& other) {
          return other.dataset == run.dataset && other.type == run.type;
        });
    if (limit == limits.end()) {
      limits.push_back({run.dataset, run.type});
      limit = limits.end() - 1;
    }
    limit->largest_share = std::max(limit->largest_share, run.outlier_share);
    if (run.undecidable && run.outlier_share < limit->undecidable_from) {
      limit->undecidable_from = run.outlier_share;
      limit->count = run.count;
    }
  }
  return limits;
}

std::vector<LimitScore> ScoreByLimits(const std::vector<SweepRun>& runs) {
  std::map<std::pair<std::string, std::string>, double> limits;
  for (const SweepLimit& limit : FindLimits(runs)) {
    limits[{limit.dataset, limit.type}] = limit.undecidable_from;
  }
  std::vector<LimitScore> scores;
  for (const SweepRun& run : runs) {
    auto score = std::find_if(
        scores.begin(), scores.end(),
        [&](const LimitScore& other) { return other.kernel == run.kernel; });
    if (score == scores.end()) {
      scores.emplace_back();
      score = scores.end() - 1;
      score->kernel = run.kernel;
      score->below_precision = 0.;
    }
    ++score->runs;
    score->successes += run.success;
    score->undecidable += run.undecidable;
    score->missed += !run.success && !run.undecidable;
    if (run.outlier_share >= kBelowLimit * limits[{run.dataset, run.type}]) {
      continue;
    }
    ++score->below;
    score->below_successes += run.success;
    score->below_precision += run.precision;
  }
  for (LimitScore& score : scores) {
    score.below_precision =
        score.below == 0 ? 1. : score.below_precision / score.below;
  }
  return scores;
}

std::string LimitTable(const std::vector<SweepRun>& runs) {
  std::string table;
  for (const SweepLimit& limit : FindLimits(runs)) {
    if (limit.undecidable_from > 1.) continue;
    absl::StrAppendFormat(
        &table, "limit: %s %s undecidable from %.1f%% outliers on\n",
        limit.dataset, limit.type, 100. * limit.undecidable_from);
  }
  for (const LimitScore& score : ScoreByLimits(runs)) {
    absl::StrAppendFormat(
        &table,
        "%s: %d of %d succeed, %d undecidable, %d missed; below %.0f%% of the "
        "limit %d of %d (%.1f%%), mean precision %.4f\n",
        score.kernel, score.successes, score.runs, score.undecidable,
        score.missed, 100. * kBelowLimit, score.below_successes, score.below,
        100. * score.below_successes / std::max(1, score.below),
        score.below_precision);
  }
  return table;
}

std::string SweepTable(const std::vector<SweepCell>& cells) {
  std::string table = absl::StrFormat(
      "%-18s %-10s %-4s %6s %4s %9s %9s %9s %9s %7s %7s %8s\n", "data set",
      "kernel", "type", "count", "runs", "cpu s", "ATE m", "worst m", "RPE m2",
      "recall", "precis.", "success");
  for (const SweepCell& cell : cells) {
    absl::StrAppendFormat(
        &table,
        "%-18s %-10s %-4s %6d %4d %9.3f %9.4f %9.4f %9.2g %7.4f %7.4f "
        "%7.0f%%",
        cell.dataset, cell.kernel, cell.type, cell.count, cell.runs,
        cell.cpu_seconds, cell.ate, cell.ate_largest, cell.rpe, cell.recall,
        cell.precision, 100. * cell.success_rate);
    if (cell.ate_truth >= 0.) {
      absl::StrAppendFormat(&table, "  truth %.3f m", cell.ate_truth);
    }
    if (cell.same_by_data > 0) {
      absl::StrAppendFormat(&table, "  same by data %d", cell.same_by_data);
    }
    if (cell.undecidable > 0) {
      absl::StrAppendFormat(&table, "  undecidable %d", cell.undecidable);
    }
    if (cell.step_mean > 0.) {
      absl::StrAppendFormat(&table, "  step %.3f ms, p99 %.2f, max %.0f",
                            cell.step_mean, cell.step_p99, cell.step_max);
    }
    table += "\n";
  }
  return table;
}

std::string PrintedComparison(const std::vector<SweepCell>& cells,
                              const std::vector<PrintedRow>& printed,
                              const std::string& method) {
  const bool is_step = method == "r_isam";
  const char* const unit = is_step ? " ms" : " s";
  std::string table =
      absl::StrFormat("%-18s %-4s %6s | %9s %11s %7s | %9s %11s %7s\n",
                      "data set", "type", "count", "SC ours", method + " ours",
                      "ratio", "SC paper", "paper", "ratio");
  for (const PrintedRow& row : printed) {
    const SweepCell* const baseline = Find(cells, row, "sc");
    const SweepCell* const ours = Find(cells, row, method);
    if (ours == nullptr) continue;
    const double value = is_step ? ours->step_mean : ours->cpu_seconds;
    const double sc = baseline == nullptr ? -1. : baseline->cpu_seconds;
    const double total = ours->cpu_seconds;
    const char* const bound =
        baseline != nullptr && 2 * baseline->unfinished >= baseline->runs ? ">"
                                                                          : "";
    absl::StrAppendFormat(
        &table, "%-18s %-4s %6d | %9s %11s %7s | %9s %11s %7s\n", row.dataset,
        row.type, row.count, bound + Number(sc, " s"), Number(value, unit),
        bound + Number(sc < 0. ? -1. : sc / total, "x"),
        Number(row.baseline, " s"), Number(row.method, unit),
        is_step || row.baseline < 0. ? "-"
                                     : Number(row.baseline / row.method, "x"));
  }
  return table;
}

nlohmann::ordered_json SweepJson(const std::vector<SweepRun>& runs) {
  nlohmann::ordered_json json;
  json["runs"] = nlohmann::ordered_json::array();
  for (const SweepRun& run : runs) json["runs"].push_back(ToJson(run));
  json["cells"] = nlohmann::ordered_json::array();
  for (const SweepCell& cell : Summarize(runs)) {
    nlohmann::ordered_json out;
    out["dataset"] = cell.dataset;
    out["kernel"] = cell.kernel;
    out["type"] = cell.type;
    out["count"] = cell.count;
    out["runs"] = cell.runs;
    out["cpu_seconds"] = cell.cpu_seconds;
    out["ate"] = cell.ate;
    out["ate_largest"] = cell.ate_largest;
    if (cell.ate_truth >= 0.) out["ate_truth"] = cell.ate_truth;
    out["rpe"] = cell.rpe;
    out["precision"] = cell.precision;
    out["recall"] = cell.recall;
    out["truncated"] = cell.truncated;
    out["success_rate"] = cell.success_rate;
    out["unfinished"] = cell.unfinished;
    out["same_by_data"] = cell.same_by_data;
    out["undecidable"] = cell.undecidable;
    json["cells"].push_back(out);
  }
  json["limits"] = nlohmann::ordered_json::array();
  for (const SweepLimit& limit : FindLimits(runs)) {
    nlohmann::ordered_json out;
    out["dataset"] = limit.dataset;
    out["type"] = limit.type;
    out["largest_share"] = limit.largest_share;
    out["undecidable_from"] = nullptr;
    if (limit.undecidable_from <= 1.) {
      out["undecidable_from"] = limit.undecidable_from;
    }
    json["limits"].push_back(out);
  }
  json["by_limits"] = nlohmann::ordered_json::array();
  for (const LimitScore& score : ScoreByLimits(runs)) {
    nlohmann::ordered_json out;
    out["kernel"] = score.kernel;
    out["runs"] = score.runs;
    out["successes"] = score.successes;
    out["undecidable"] = score.undecidable;
    out["missed"] = score.missed;
    out["below_limit"] = score.below;
    out["below_limit_successes"] = score.below_successes;
    out["below_limit_precision"] = score.below_precision;
    json["by_limits"].push_back(out);
  }
  return json;
}

namespace {

// The range of all panels, which are unit squares, four to a row.
constexpr double kPitch = 1.3;
constexpr double kLow = -4., kHigh = 2.;  // log10 of metres

struct SweepAxes {
  std::vector<std::string> panels;
  std::vector<std::string> kernels;
  int least = 1 << 30;  // outliers
  int most = 1;
};

SweepAxes MakeSweepAxes(const std::vector<SweepCell>& cells) {
  SweepAxes axes;
  const auto add = [](const std::string& name,
                      std::vector<std::string>* const names) {
    if (std::find(names->begin(), names->end(), name) == names->end()) {
      names->push_back(name);
    }
  };
  for (const SweepCell& cell : cells) {
    add(cell.dataset + " " + cell.type, &axes.panels);
    add(cell.kernel, &axes.kernels);
    axes.least = std::min(axes.least, std::max(cell.count, 1));
    axes.most = std::max(axes.most, cell.count);
  }
  return axes;
}

// Where a panel has `count` outliers and the error `ate`, both logarithmic.
class PanelScale {
 public:
  PanelScale(const SweepAxes& axes, const size_t panel)
      : corner_(kPitch * (panel % 4), -kPitch * (panel / 4)),
        least_(axes.least),
        span_(std::log(std::max(1.001, 1. * axes.most / axes.least))) {}

  const Eigen::Vector2d& corner() const { return corner_; }
  Eigen::Vector2d At(const int count, const double ate) const {
    const double y = (std::log10(std::max(ate, 1e-4)) - kLow) / (kHigh - kLow);
    return corner_ +
           Eigen::Vector2d(std::log(std::max(count, 1) * 1. / least_) / span_,
                           std::min(1., y));
  }

 private:
  const Eigen::Vector2d corner_;
  const int least_;
  const double span_;
};

void DrawPanelFrame(const SweepAxes& axes, const std::string& panel,
                    const PanelScale& scale, io::Picture* const picture) {
  const Eigen::Vector2d& corner = scale.corner();
  picture->DrawPolygon(
      {corner, corner + Eigen::Vector2d(1., 0.),
       corner + Eigen::Vector2d(1., 1.), corner + Eigen::Vector2d(0., 1.)},
      {io::palette::kGrey, 1.}, {1., 1., 1., 0.});
  for (int decade = -4; decade <= 2; decade += 2) {
    const Eigen::Vector2d left = scale.At(axes.least, std::pow(10., decade));
    picture->DrawLine(left, left + Eigen::Vector2d(1., 0.),
                      {io::palette::kGrey, 0.5, true});
    picture->DrawText(left - Eigen::Vector2d(0.16, 0.01),
                      absl::StrFormat("1e%d m", decade), 14.,
                      io::palette::kBlack);
  }
  picture->DrawText(corner + Eigen::Vector2d(0., 1.03),
                    absl::StrCat("ATE, ", panel, ", ", axes.least, " to ",
                                 axes.most, " outliers"),
                    16., io::palette::kBlack);
}

// The errors of one kernel in one panel.
void DrawCurve(const std::vector<SweepCell>& cells, const std::string& panel,
               const std::string& kernel, const PanelScale& scale,
               const io::Color& color, io::Picture* const picture) {
  std::vector<std::pair<int, double>> values;
  for (const SweepCell& cell : cells) {
    if (cell.dataset + " " + cell.type == panel && cell.kernel == kernel) {
      values.push_back({cell.count, cell.ate});
    }
  }
  std::sort(values.begin(), values.end());
  std::vector<Eigen::Vector2d> points;
  for (const auto& value : values) {
    points.push_back(scale.At(value.first, value.second));
    picture->DrawDot(points.back(), 4., color);
  }
  picture->DrawPolyline(points, {color, 2.});
}

}  // namespace

absl::Status WriteSweepPlot(const std::vector<SweepCell>& cells,
                            const std::vector<SweepLimit>& limits,
                            const std::string& filename) {
  const io::Color kColors[] = {
      io::palette::kVermilion, io::palette::kBlue,   io::palette::kGreen,
      io::palette::kOrange,    io::palette::kPurple, io::palette::kSkyBlue,
      io::palette::kYellow,    io::palette::kGrey,   io::palette::kBlack};
  const SweepAxes axes = MakeSweepAxes(cells);
  const int rows = (static_cast<int>(axes.panels.size()) + 3) / 4;
  io::PictureBounds bounds;
  bounds.Add(Eigen::Vector2d(-0.2, -kPitch * rows + 0.2));
  bounds.Add(Eigen::Vector2d(4. * kPitch, 1.2));
  io::Picture picture(bounds, 2000);
  for (size_t p = 0; p != axes.panels.size(); ++p) {
    const std::string& panel = axes.panels[p];
    const PanelScale scale(axes, p);
    DrawPanelFrame(axes, panel, scale, &picture);
    for (const SweepLimit& limit : limits) {
      if (limit.dataset + " " + limit.type != panel || limit.count == 0) {
        continue;
      }
      picture.DrawLine(scale.At(limit.count, 1e-4), scale.At(limit.count, 1e2),
                       {io::palette::kBlack, 1.5, true});
      picture.DrawText(scale.At(limit.count, 60.), "undecidable", 12.,
                       io::palette::kBlack);
    }
    for (size_t k = 0; k != axes.kernels.size(); ++k) {
      DrawCurve(cells, panel, axes.kernels[k], scale, kColors[k % 9], &picture);
    }
  }
  for (size_t k = 0; k != axes.kernels.size(); ++k) {
    picture.AddLegend(axes.kernels[k], kColors[k % 9]);
  }
  return picture.Write(filename);
}

}  // namespace experiments
}  // namespace cartographer_ext
