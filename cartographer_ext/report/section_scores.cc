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

constexpr int kBins = 40;
constexpr size_t kMaxPoints = 2500;

// Two sets of values, one on the other.
// Values of good and bad loops.
struct TwoSamples {
  std::vector<double> good;
  std::vector<double> bad;
  std::string good_name;
  std::string bad_name;
};

struct Mark {
  double value = 0.;
  std::string label;
};

std::string StackedHistogram(const std::string& title, const Axis& axis,
                             const TwoSamples& samples, const Mark& mark) {
  const double low = axis.low, high = axis.high;
  const std::vector<double>& good = samples.good;
  const std::vector<double>& bad = samples.bad;
  const auto good_counts = Histogram(good, low, high, kBins);
  const auto bad_counts = Histogram(bad, low, high, kBins);
  int highest = 1;
  for (int i = 0; i < kBins; ++i) {
    highest = std::max(highest, good_counts[i] + bad_counts[i]);
  }
  Chart chart(title, axis, {"loops", 0., 1.05 * highest}, 560, 240);
  const double width = (high - low) / kBins;
  for (int i = 0; i < kBins; ++i) {
    const double left = low + i * width;
    const std::string range =
        absl::StrFormat("%.3g to %.3g: ", left, left + width);
    chart.Bar(left, left + 0.92 * width, good_counts[i] + bad_counts[i], "s1",
              absl::StrCat(range, good_counts[i], " ", samples.good_name));
    chart.Bar(left, left + 0.92 * width, bad_counts[i], "s2",
              absl::StrCat(range, bad_counts[i], " ", samples.bad_name));
  }
  if (mark.value > low) chart.VerticalMark(mark.value, mark.label);
  chart.Legend(samples.good_name, "s1");
  if (!bad.empty()) chart.Legend(samples.bad_name, "s2");
  return chart.ToSvg();
}

void AddHistograms(const ReportData& data, const size_t index,
                   const std::vector<LoopEvidence>& evidence,
                   Markup* const page) {
  const ReportRun& run = data.runs[index];
  std::vector<double> good, bad, good_residuals, bad_residuals;
  for (const LoopEvidence& loop : evidence) {
    const bool is_bad = !loop.accepted || loop.suspicious();
    if (loop.score >= 0.) (is_bad ? bad : good).push_back(loop.score);
    if (loop.in_graph) {
      (is_bad ? bad_residuals : good_residuals)
          .push_back(std::log10(std::max(1e-3, loop.residual_translation)));
    }
  }
  if (good.empty() && bad.empty()) return;
  const bool rejected =
      std::any_of(evidence.begin(), evidence.end(),
                  [](const LoopEvidence& loop) { return !loop.accepted; });
  const std::string bad_name =
      rejected ? "rejected or suspicious" : "suspicious";
  page->Element("h3", {}, absl::StrCat("Map ", run.name));
  page->Open("div", {{"class", "pair"}});
  page->Open("figure");
  page->Raw(StackedHistogram(
      "Scores of loops", {"score of the loop on the grid", 0.3, 1.},
      {good, bad, "fine", bad_name},
      {data.stock_min_score,
       absl::StrFormat("min_score %.2f", data.stock_min_score)}));
  page->Element("figcaption", {},
                "How well the scan matches the submap's grid at the loop's "
                "pose. Where good and suspicious loops overlap, no threshold "
                "on this score separates them.");
  page->Close();
  page->Open("figure");
  page->Raw(
      StackedHistogram("Residuals of loops",
                       {"distance from the map, log10 of metres", -3., 1.5},
                       {good_residuals, bad_residuals, "fine", bad_name},
                       {std::log10(0.5), "0.5 m"}));
  page->Element("figcaption", {},
                "Distance of each loop from the optimised map. The "
                "optimisation disagrees with loops right of the mark.");
  page->Close();
  page->Close();
}

void AddScatter(const ReportRun& run, Markup* const page) {
  const proto::LoopDecision* mixture = nullptr;
  size_t with_scores = 0;
  for (const auto& decision : run.decisions()) {
    if (decision.has_temporal() && decision.temporal().outcome() ==
                                       proto::LoopDecision::Temporal::SCORED) {
      ++with_scores;
    }
    if (decision.fusion().has_true_loops()) mixture = &decision;
  }
  if (with_scores == 0) return;
  Chart chart("Grid score against temporal score",
              {"S_g, score on the grid", 0.3, 1.},
              {"S_t, temporal score", 0., 1.}, 640, 420);
  const size_t step = 1 + with_scores / kMaxPoints;
  size_t position = 0;
  for (const auto& decision : run.decisions()) {
    if (!decision.has_temporal() ||
        decision.temporal().outcome() !=
            proto::LoopDecision::Temporal::SCORED ||
        position++ % step != 0) {
      continue;
    }
    const bool accepted = decision.verdict() == proto::LoopDecision::ACCEPTED;
    chart.Point({decision.search().grid_score(), decision.temporal().score()},
                accepted ? "s1" : "s2",
                absl::StrFormat(
                    "submap (%d, %d) - node (%d, %d)\nS_g %.3f, "
                    "S_t %.3f, fused %.3f\n%s",
                    decision.submap_trajectory_id(), decision.submap_index(),
                    decision.node_trajectory_id(), decision.node_index(),
                    decision.search().grid_score(), decision.temporal().score(),
                    decision.fusion().final_score(), VerdictInWords(decision)),
                accepted ? 2.2 : 2.8);
  }
  if (mixture != nullptr) {
    const auto draw = [&chart](
                          const proto::LoopDecision::MixtureComponent& part,
                          const std::string& style) {
      Eigen::Matrix2d covariance;
      covariance << part.variance_grid(), part.covariance(), part.covariance(),
          part.variance_temporal();
      for (const double sigmas : {1., 2.}) {
        chart.Ellipse({part.mean_grid(), part.mean_temporal()}, covariance,
                      sigmas, style);
      }
    };
    draw(mixture->fusion().true_loops(), "s3");
    draw(mixture->fusion().false_loops(), "s4");
    chart.Legend("true", "s3");
    chart.Legend("false", "s4");
  }
  chart.Legend("accepted", "s1");
  chart.Legend("rejected", "s2");
  page->Open("figure");
  page->Raw(chart.ToSvg());
  page->Element(
      "figcaption", {},
      absl::StrCat("Candidates of ", run.name,
                   mixture != nullptr
                       ? ". The ellipses show the final mixture of true and "
                         "false loops, at one and two standard deviations."
                       : "."));
  page->Close();
}

}  // namespace

void AddScores(const ReportData& data, const Prepared& prepared,
               Markup* const page) {
  bool any = false;
  for (const auto& evidence : prepared.evidence) any = any || !evidence.empty();
  if (!any) return;
  AddHeading("scores", "Scores and residuals", page);
  for (size_t i = 0; i < data.runs.size(); ++i) {
    AddHistograms(data, i, prepared.evidence[i], page);
    AddScatter(data.runs[i], page);
  }
}

}  // namespace report
}  // namespace cartographer_ext
