// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/labelled_loops.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/loop_closure/decision_log.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using proto::LoopDecision;

bool StrictFirst(const ScoredLabel& a, const ScoredLabel& b) {
  return a.score > b.score;
}

const char* LabelText(const LoopVerdict label) {
  switch (label) {
    case LoopVerdict::kCorrect:
      return "true";
    case LoopVerdict::kWrong:
      return "false";
    case LoopVerdict::kUnknown:
      break;
  }
  return "unknown";
}

// One diagram of an SVG with a frame and axes from 0 to 1.
class Diagram {
 public:
  Diagram(const double left, const double top, const char* const title,
          const char* const x_label, const char* const y_label)
      : left_(left), top_(top) {
    absl::StrAppendFormat(
        &svg_,
        "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"none\" "
        "stroke=\"black\"/>\n",
        left, top, kSize, kSize);
    Text(left + 0.5 * kSize, top - 10., "middle", title);
    Text(left + 0.5 * kSize, top + kSize + 34., "middle", x_label);
    Text(left, top - 10., "start", y_label);
    for (int i = 0; i <= 4; ++i) {
      const double at = 0.25 * i;
      Text(left + at * kSize, top + kSize + 16., "middle",
           absl::StrFormat("%g", at));
      Text(left - 6., top + (1. - at) * kSize + 4., "end",
           absl::StrFormat("%g", at));
    }
  }

  void Line(const std::vector<std::pair<double, double>>& points,
            const char* const color) {
    absl::StrAppend(&svg_,
                    "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"",
                    color, "\" points=\"");
    for (const auto& point : points) {
      absl::StrAppendFormat(&svg_, "%.2f,%.2f ", left_ + point.first * kSize,
                            top_ + (1. - point.second) * kSize);
    }
    absl::StrAppend(&svg_, "\"/>\n");
  }

  void Dot(const double x, const double y, const char* const color) {
    absl::StrAppendFormat(
        &svg_, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"5\" fill=\"%s\"/>\n",
        left_ + x * kSize, top_ + (1. - y) * kSize, color);
  }

  void Legend(const int row, const std::string& text, const char* const color) {
    const double y = top_ + kSize - 14. - 18. * row;
    absl::StrAppendFormat(
        &svg_,
        "<rect x=\"%g\" y=\"%g\" width=\"14\" height=\"4\" fill=\"%s\"/>\n",
        left_ + 120., y - 6., color);
    Text(left_ + 140., y, "start", text);
  }

  const std::string& svg() const { return svg_; }

  static constexpr double kSize = 360.;

 private:
  void Text(const double x, const double y, const char* const anchor,
            const std::string& text) {
    absl::StrAppendFormat(&svg_,
                          "<text x=\"%g\" y=\"%g\" text-anchor=\"%s\">%s"
                          "</text>\n",
                          x, y, anchor, text);
  }

  const double left_;
  const double top_;
  std::string svg_;
};

constexpr double Diagram::kSize;

}  // namespace

MapGraph CandidateGraph(const MapGraph& graph,
                        const std::vector<LoopDecision>& decisions,
                        std::vector<LoopDecision>* const candidates) {
  MapGraph result = graph;
  result.constraints.erase(
      std::remove_if(
          result.constraints.begin(), result.constraints.end(),
          [](const GraphConstraint& constraint) { return constraint.is_loop; }),
      result.constraints.end());
  candidates->clear();
  for (const LoopDecision& decision : decisions) {
    if (!decision.search().has_refined()) continue;
    GraphConstraint constraint;
    constraint.submap_id = {decision.submap_trajectory_id(),
                            decision.submap_index()};
    constraint.node_id = {decision.node_trajectory_id(), decision.node_index()};
    if (graph.submaps.count(constraint.submap_id) == 0 ||
        graph.nodes.count(constraint.node_id) == 0) {
      continue;
    }
    const LoopDecision::Pose& pose = decision.search().refined();
    constraint.relative_pose = Pose2(pose.x(), pose.y(), pose.theta());
    constraint.is_loop = true;
    result.constraints.push_back(constraint);
    candidates->push_back(decision);
  }
  return result;
}

std::vector<LabelledLoop> LabelLoops(
    const std::vector<LoopDecision>& candidates,
    const LoopStatistics& statistics) {
  std::vector<LabelledLoop> loops;
  for (size_t i = 0; i < candidates.size() && i < statistics.loops.size();
       ++i) {
    LabelledLoop loop;
    loop.decision = candidates[i];
    loop.label = statistics.loops[i].verdict;
    loop.translation_error = statistics.loops[i].translation_error;
    loop.rotation_error = statistics.loops[i].rotation_error;
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<RatePoint> RateCurve(std::vector<ScoredLabel> labels) {
  std::stable_sort(labels.begin(), labels.end(), StrictFirst);
  const double num_true = static_cast<double>(
      std::count_if(labels.begin(), labels.end(),
                    [](const ScoredLabel& label) { return label.is_true; }));
  const double num_false = static_cast<double>(labels.size()) - num_true;
  std::vector<RatePoint> curve;
  double accepted_true = 0.;
  double accepted_false = 0.;
  for (size_t i = 0; i < labels.size(); ++i) {
    (labels[i].is_true ? accepted_true : accepted_false) += 1.;
    if (i + 1 < labels.size() && labels[i + 1].score == labels[i].score) {
      continue;
    }
    RatePoint point;
    point.threshold = labels[i].score;
    point.true_positive_rate = num_true > 0. ? accepted_true / num_true : 0.;
    point.false_positive_rate =
        num_false > 0. ? accepted_false / num_false : 0.;
    point.precision = accepted_true / (accepted_true + accepted_false);
    curve.push_back(point);
  }
  return curve;
}

absl::optional<double> AreaUnderCurve(std::vector<ScoredLabel> labels) {
  double area = 0.;
  RatePoint last;
  const std::vector<RatePoint> curve = RateCurve(std::move(labels));
  if (curve.empty() || curve.back().true_positive_rate == 0. ||
      curve.back().false_positive_rate == 0.) {
    return absl::nullopt;
  }
  for (const RatePoint& point : curve) {
    area += 0.5 * (point.true_positive_rate + last.true_positive_rate) *
            (point.false_positive_rate - last.false_positive_rate);
    last = point;
  }
  return area;
}

std::vector<ScoredLabel> Scores(const std::vector<LabelledLoop>& loops,
                                const ScoreKind kind) {
  std::vector<ScoredLabel> labels;
  for (const LabelledLoop& loop : loops) {
    if (loop.label == LoopVerdict::kUnknown) continue;
    const LoopDecision& decision = loop.decision;
    ScoredLabel label;
    label.is_true = loop.label == LoopVerdict::kCorrect;
    switch (kind) {
      case ScoreKind::kGrid:
        label.score = decision.search().grid_score();
        break;
      case ScoreKind::kTemporal:
        if (!decision.has_temporal() ||
            decision.temporal().outcome() != LoopDecision::Temporal::SCORED) {
          continue;
        }
        label.score = decision.temporal().score();
        break;
      case ScoreKind::kFused:
        if (!decision.has_fusion()) continue;
        label.score = decision.fusion().final_score();
        break;
      case ScoreKind::kProbability:
        if (!(decision.fusion().probability() > 0.)) continue;
        label.score = decision.fusion().probability();
        break;
    }
    labels.push_back(label);
  }
  return labels;
}

std::array<ReliabilityBin, 10> ReliabilityDiagram(
    const std::vector<ScoredLabel>& labels) {
  std::array<ReliabilityBin, 10> bins;
  for (const ScoredLabel& label : labels) {
    const double place = label.score * static_cast<double>(bins.size());
    ReliabilityBin& bin = bins[static_cast<size_t>(
        std::min(std::max(place, 0.), static_cast<double>(bins.size()) - 1.))];
    ++bin.count;
    bin.mean_score += label.score;
    bin.true_share += label.is_true ? 1. : 0.;
  }
  for (ReliabilityBin& bin : bins) {
    const double count = std::max<double>(1., bin.count);
    bin.mean_score /= count;
    bin.true_share /= count;
  }
  return bins;
}

absl::optional<double> ExpectedCalibrationError(
    const std::array<ReliabilityBin, 10>& bins) {
  double total = 0.;
  double error = 0.;
  for (const ReliabilityBin& bin : bins) {
    const double count = static_cast<double>(bin.count);
    total += count;
    error += count * std::abs(bin.mean_score - bin.true_share);
  }
  if (total == 0.) return absl::nullopt;
  return error / total;
}

absl::optional<double> ChainRates::precision() const {
  const int64_t accepted = true_accepted + false_accepted;
  if (accepted == 0) return absl::nullopt;
  return static_cast<double>(true_accepted) / static_cast<double>(accepted);
}

absl::optional<double> ChainRates::recall() const {
  if (true_candidates == 0) return absl::nullopt;
  return static_cast<double>(true_accepted) /
         static_cast<double>(true_candidates);
}

ChainRates RatesOfChain(const std::vector<LabelledLoop>& loops) {
  ChainRates rates;
  for (const LabelledLoop& loop : loops) {
    if (loop.label == LoopVerdict::kUnknown) continue;
    const bool is_true = loop.label == LoopVerdict::kCorrect;
    ++(is_true ? rates.true_candidates : rates.false_candidates);
    if (loop.decision.verdict() != LoopDecision::ACCEPTED) continue;
    ++(is_true ? rates.true_accepted : rates.false_accepted);
  }
  return rates;
}

std::string LabelledCsv(const std::vector<LabelledLoop>& loops) {
  std::vector<LoopDecision> decisions;
  for (const LabelledLoop& loop : loops) decisions.push_back(loop.decision);
  const std::vector<std::string> lines =
      absl::StrSplit(loop_closure::DecisionCsv(decisions), '\n');
  std::string csv =
      absl::StrCat("label,translation_error,rotation_error,", lines[0], "\n");
  for (size_t i = 0; i < loops.size(); ++i) {
    absl::StrAppendFormat(&csv, "%s,%.6g,%.6g,%s\n", LabelText(loops[i].label),
                          loops[i].translation_error, loops[i].rotation_error,
                          lines[i + 1]);
  }
  return csv;
}

std::string CurvesSvg(const std::vector<LabelledLoop>& loops,
                      const std::string& title) {
  constexpr double kMargin = 60.;
  const double width = 3. * Diagram::kSize + 4. * kMargin;
  const double height = Diagram::kSize + 2. * kMargin + 20.;
  Diagram roc(kMargin, kMargin + 20., "ROC", "share of false loops accepted",
              "");
  Diagram recall(Diagram::kSize + 2. * kMargin, kMargin + 20.,
                 "precision and recall", "recall", "");
  Diagram reliability(2. * Diagram::kSize + 3. * kMargin, kMargin + 20.,
                      "share of true loops", "probability", "");
  struct Kind {
    ScoreKind kind;
    const char* name;
    const char* color;
  };
  const Kind kinds[] = {{ScoreKind::kGrid, "grid score", "#0072b2"},
                        {ScoreKind::kTemporal, "temporal score", "#d55e00"},
                        {ScoreKind::kFused, "fused score", "#009e73"},
                        {ScoreKind::kProbability, "probability", "#cc79a7"}};
  int row = 0;
  for (const Kind& kind : kinds) {
    const std::vector<ScoredLabel> labels = Scores(loops, kind.kind);
    std::vector<std::pair<double, double>> roc_points = {{0., 0.}};
    std::vector<std::pair<double, double>> recall_points;
    for (const RatePoint& point : RateCurve(labels)) {
      roc_points.emplace_back(point.false_positive_rate,
                              point.true_positive_rate);
      recall_points.emplace_back(point.true_positive_rate, point.precision);
    }
    roc.Line(roc_points, kind.color);
    recall.Line(recall_points, kind.color);
    const absl::optional<double> area = AreaUnderCurve(labels);
    roc.Legend(row++,
               area.has_value()
                   ? absl::StrFormat("%s, area %.3f", kind.name, *area)
                   : std::string(kind.name),
               kind.color);
  }
  const ChainRates chain = RatesOfChain(loops);
  if (chain.precision().has_value() && chain.recall().has_value()) {
    const double false_rate =
        chain.false_candidates > 0
            ? static_cast<double>(chain.false_accepted) /
                  static_cast<double>(chain.false_candidates)
            : 0.;
    roc.Dot(false_rate, *chain.recall(), "black");
    recall.Dot(*chain.recall(), *chain.precision(), "black");
  }
  roc.Legend(row, "whole chain", "black");
  reliability.Line({{0., 0.}, {1., 1.}}, "#999999");
  for (const ReliabilityBin& bin :
       ReliabilityDiagram(Scores(loops, ScoreKind::kProbability))) {
    if (bin.count > 0) {
      reliability.Dot(bin.mean_score, bin.true_share, "#cc79a7");
    }
  }
  return absl::StrFormat(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n"
      "<text x=\"%g\" y=\"24\" font-size=\"16\">%s</text>\n%s%s%s</svg>\n",
      width, height, kMargin, title, roc.svg(), recall.svg(),
      reliability.svg());
}

}  // namespace evaluation
}  // namespace cartographer_ext
