// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/comparison_report.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/report/map_figure.h"
#include "cartographer_ext/report/sections.h"
#include "cartographer_ext/report/style.h"

namespace cartographer_ext {
namespace report {
namespace {

using evaluation::LoneWalls;
using evaluation::MapComparison;
using evaluation::MovedPiece;
using evaluation::ToString;

std::vector<Eigen::Vector2d> SecondPath(const evaluation::MapGraph& graph,
                                        const Pose2& first_from_second) {
  std::vector<Eigen::Vector2d> path = NodePath(graph);
  for (Eigen::Vector2d& point : path) {
    if (point.allFinite()) point = first_from_second * point;
  }
  return path;
}

void AddMoved(const MapComparison& comparison, Markup* const page) {
  Table table({"nodes", "x", "y", "moved by", "at most", "turned"});
  for (const MovedPiece& piece : comparison.moved) {
    table.AddRow({absl::StrCat(ToString(piece.first_node), " to ",
                               ToString(piece.last_node)),
                  absl::StrFormat("%.1f m", piece.center.x()),
                  absl::StrFormat("%.1f m", piece.center.y()),
                  absl::StrFormat("%.2f m", piece.mean),
                  absl::StrFormat("%.2f m", piece.max),
                  absl::StrFormat("%.1f deg", RadToDeg(piece.max_rotation))});
  }
  if (!table.empty())
    page->Raw(table.ToHtml("Path pieces that moved in the second map"));
  Table walls({"walls only in", "x", "y", "extent"});
  for (const LoneWalls& group : comparison.lone_walls) {
    walls.AddRow({group.in_first ? "the first map" : "the second map",
                  absl::StrFormat("%.1f m", group.center.x()),
                  absl::StrFormat("%.1f m", group.center.y()),
                  absl::StrFormat("%.1f m", group.extent)});
  }
  if (!walls.empty()) page->Raw(walls.ToHtml("Walls in only one map"));
}

}  // namespace

void OpenPage(const std::string& title, Markup* const page) {
  page->Raw("<!DOCTYPE html>\n");
  page->Open("html", {{"lang", "en"}});
  AddHead(title, page);
  page->Open("body");
  page->Open("main");
  page->Element("h1", {}, title);
}

void ClosePage(Markup* const page) {
  page->Close();
  page->Open("script");
  page->Raw(Script());
  page->Raw(ViewerScript());
  page->Close();
  page->Close();
  page->Close();
}

void AddVerdictBox(const std::string& name,
                   const evaluation::SelfConsistency& consistency,
                   Markup* const page) {
  page->Open("div", {{"class", absl::StrCat("verdict ", consistency.word)}});
  page->Open("div");
  page->Element("div", {}, name);
  page->Element("div", {{"class", "word"}}, consistency.word);
  page->Close();
  page->Open("ul");
  for (const std::string& reason : consistency.reasons) {
    page->Element("li", {}, reason);
  }
  page->Close();
  page->Close();
}

void AddComparisonFigures(const ComparedMap& first, const ComparedMap& second,
                          const MapComparison& comparison, Markup* const page) {
  io::PictureBounds bounds;
  for (const auto* walls :
       {&comparison.common, &comparison.only_first, &comparison.only_second}) {
    for (const Eigen::Vector2d& wall : *walls) bounds.Add(wall);
  }
  MapFigure figure("Walls of the two aligned maps", bounds);
  figure.Dots(comparison.common, "s7");
  figure.Dots(comparison.only_first, "s2");
  figure.Dots(comparison.only_second, "s1");
  figure.Legend("walls in both", "s7");
  figure.Legend(absl::StrCat("only ", first.name), "s2");
  figure.Legend(absl::StrCat("only ", second.name), "s1");
  if (first.graph != nullptr) {
    figure.Path(NodePath(*first.graph), "s6 thin");
    figure.Legend(absl::StrCat("path, ", first.name), "s6");
  }
  if (second.graph != nullptr) {
    figure.Path(SecondPath(*second.graph, comparison.first_from_second),
                "s3 thin");
    figure.Legend(absl::StrCat("path, ", second.name), "s3");
  }
  page->Open("figure");
  page->Raw(figure.ToHtml());
  page->Element("figcaption", {},
                absl::StrFormat("%s translated by %.2f m, %.2f m and rotated "
                                "by %.1f degrees to align it with %s (by %s).",
                                second.name, comparison.first_from_second.x,
                                comparison.first_from_second.y,
                                RadToDeg(comparison.first_from_second.theta),
                                first.name, comparison.method));
  page->Close();
  AddMoved(comparison, page);
}

std::string MakeComparisonReport(const ComparedMap& first,
                                 const ComparedMap& second,
                                 const MapComparison& comparison,
                                 const std::string& command_line) {
  Markup page;
  OpenPage(absl::StrCat(first.name, " and ", second.name), &page);
  for (const ComparedMap* const map : {&first, &second}) {
    if (map->consistency != nullptr) {
      AddVerdictBox(map->name, *map->consistency, &page);
    }
  }
  page.Open("pre");
  page.Text(evaluation::ToText(comparison));
  page.Close();
  AddComparisonFigures(first, second, comparison, &page);
  page.Element("p", {{"class", "soft"}}, command_line);
  ClosePage(&page);
  return page.str();
}

}  // namespace report
}  // namespace cartographer_ext
