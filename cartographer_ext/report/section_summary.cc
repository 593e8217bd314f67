// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/report/sections.h"
#include "cartographer_ext/report/style.h"

namespace cartographer_ext {
namespace report {
namespace {

using evaluation::Evaluation;

std::string Percent(const double share) {
  return absl::StrFormat("%.1f %%", 100. * share);
}

void AddTile(const std::string& value, const std::string& label,
             Markup* const page) {
  page->Open("div", {{"class", "tile"}});
  page->Element("b", {}, value);
  page->Element("span", {}, label);
  page->Close();
}

void AddVerdict(const Evaluation& evaluation, Markup* const page) {
  const evaluation::Verdict verdict = evaluation::Judge(evaluation);
  page->Open("div", {{"class", absl::StrCat("verdict ", verdict.word)}});
  page->Element("div", {{"class", "word"}}, absl::StrCat("Map ", verdict.word));
  page->Open("ul");
  for (const std::string& reason : verdict.reasons) {
    page->Element("li", {}, reason);
  }
  page->Close();
  page->Close();
}

// One row of the table of runs: a label, and a cell for each run.
struct Row {
  std::string label;
  std::function<std::string(const ReportRun&)> cell;
};

// Against ground truth.
void AddAccuracyRows(std::vector<Row>* const rows) {
  rows->push_back({"verdict", [](const ReportRun& run) {
                     return evaluation::Judge(run.evaluation).word;
                   }});
  rows->push_back({"loops", [](const ReportRun& run) {
                     return absl::StrCat(run.graph.num_loops());
                   }});
  rows->push_back({"loops right / judged by truth", [](const ReportRun& run) {
                     const auto& loops = run.evaluation.loops;
                     return loops.has_value() && loops->judged > 0
                                ? absl::StrCat(loops->correct, " / ",
                                               loops->judged)
                                : std::string("-");
                   }});
  rows->push_back({"recall of revisits", [](const ReportRun& run) {
                     const auto& loops = run.evaluation.loops;
                     return loops.has_value() && loops->recall.has_value()
                                ? Percent(*loops->recall)
                                : std::string("-");
                   }});
  rows->push_back({"relations, mean error", [](const ReportRun& run) {
                     const auto& relations = run.evaluation.relations;
                     return relations.has_value()
                                ? absl::StrFormat(
                                      "%.4f m", relations->all.translation.mean)
                                : std::string("-");
                   }});
  rows->push_back({"relations off by > 0.5 m", [](const ReportRun& run) {
                     const auto& relations = run.evaluation.relations;
                     return relations.has_value()
                                ? Percent(
                                      relations->all.fraction_above_half_metre)
                                : std::string("-");
                   }});
  rows->push_back({"trajectory error (rmse)", [](const ReportRun& run) {
                     const auto& errors = run.evaluation.trajectory;
                     return errors.has_value()
                                ? absl::StrFormat("%.3f m", errors->ate.rmse)
                                : std::string("-");
                   }});
}

void AddConsistencyRows(std::vector<Row>* const rows) {
  const auto consistency =
      [](const std::function<std::string(const evaluation::SelfConsistency&)>&
             cell) {
        return [cell](const ReportRun& run) {
          return run.evaluation.consistency.has_value()
                     ? cell(*run.evaluation.consistency)
                     : std::string();
        };
      };
  rows->push_back(
      {"severely contradicted nodes",
       consistency([](const auto& c) { return Percent(c.severe_share); })});
  rows->push_back({"displaced nodes", consistency([](const auto& c) {
                     return Percent(c.displacements.displaced_share());
                   })});
  rows->push_back(
      {"path that may lie elsewhere",
       consistency([](const auto& c) { return Percent(c.loose.share()); })});
  rows->push_back({"rays contradicted", consistency([](const auto& c) {
                     return Percent(c.contradictions.ray_fraction());
                   })});
  rows->push_back({"open loop cycles", consistency([](const auto& c) {
                     return Percent(c.cycles.fraction());
                   })});
  rows->push_back({"mean map entropy", consistency([](const auto& c) {
                     return absl::StrFormat("%.3f", c.sharpness.mean_entropy);
                   })});
  rows->push_back({"walls, one visit", consistency([](const auto& c) {
                     return absl::StrFormat(
                         "%.1f cm",
                         100. * c.sharpness.single_visit_thickness.mean);
                   })});
  rows->push_back({"walls, all visits", consistency([](const auto& c) {
                     return absl::StrFormat(
                         "%.1f cm",
                         100. * c.sharpness.revisited_thickness.mean);
                   })});
  rows->push_back(
      {"loop residual, mean", [](const ReportRun& run) {
         return run.evaluation.loops.has_value()
                    ? absl::StrFormat(
                          "%.3f m",
                          run.evaluation.loops->residual_translation.mean)
                    : std::string("-");
       }});
}

std::vector<Row> Rows() {
  std::vector<Row> rows;
  AddAccuracyRows(&rows);
  AddConsistencyRows(&rows);
  return rows;
}

}  // namespace

void AddHead(const std::string& title, Markup* const page) {
  page->Open("head");
  page->Raw("<meta charset=\"utf-8\">\n");
  page->Raw(
      "<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n");
  page->Raw("<link rel=\"icon\" href=\"data:,\">\n");
  page->Element("title", {}, title);
  page->Open("style");
  page->Raw(StyleSheet());
  page->Close();
  page->Close();
}

void AddHeading(const std::string& id, const std::string& text,
                Markup* const page) {
  page->Element("h2", {{"id", id}}, text);
}

void AddSummary(const ReportData& data, Markup* const page) {
  const ReportRun& stored = data.runs.front();
  AddVerdict(stored.evaluation, page);
  page->Open("div", {{"class", "tiles"}});
  AddTile(absl::StrCat(stored.graph.nodes.size()), "nodes", page);
  AddTile(absl::StrCat(stored.graph.submaps.size()), "submaps", page);
  AddTile(absl::StrCat(stored.graph.num_loops()), "loops", page);
  AddTile(absl::StrFormat("%.1f m", stored.evaluation.trajectory_metres),
          "path", page);
  if (stored.evaluation.relations.has_value()) {
    AddTile(absl::StrFormat("%.3f m",
                            stored.evaluation.relations->all.translation.mean),
            "mean error of relations", page);
  }
  if (stored.evaluation.trajectory.has_value()) {
    AddTile(absl::StrFormat("%.3f m", stored.evaluation.trajectory->ate.rmse),
            "trajectory error (rmse)", page);
  }
  if (stored.evaluation.consistency.has_value()) {
    AddTile(Percent(stored.evaluation.consistency->severe_share),
            "of severely contradicted nodes", page);
  }
  page->Close();
  for (const std::string& note : data.notes) page->Element("p", {}, note);

  std::vector<std::string> head = {""};
  for (const ReportRun& run : data.runs) head.push_back(run.name);
  Table table(head);
  for (const Row& row : Rows()) {
    std::vector<std::string> cells = {row.label};
    bool any = false;
    for (const ReportRun& run : data.runs) {
      cells.push_back(row.cell(run));
      any = any || (!cells.back().empty() && cells.back() != "-");
    }
    if (any) table.AddRow(cells);
  }
  page->Raw(table.ToHtml("The map as stored and after each run"));
}

}  // namespace report
}  // namespace cartographer_ext
