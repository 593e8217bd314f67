// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/report/sections.h"

namespace cartographer_ext {
namespace report {
namespace {

std::string Seconds(const double value) {
  return absl::StrFormat("%.2f s", value);
}

}  // namespace

void AddTiming(const ReportData& data, Markup* const page) {
  const bool any =
      std::any_of(data.runs.begin(), data.runs.end(),
                  [](const ReportRun& run) { return run.rerun.has_value(); });
  if (!any || !data.with_times) return;
  AddHeading("timing", "Time and memory", page);
  Table table({"run", "wall", "CPU", "search", "preparing submaps",
               "verification", "optimisation and the rest", "searches",
               "matches", "ms per search", "memory"});
  for (const ReportRun& run : data.runs) {
    if (!run.rerun.has_value()) continue;
    const evaluation::Rerun& rerun = *run.rerun;
    table.AddRow(
        {run.name, Seconds(rerun.wall_seconds), Seconds(rerun.cpu_seconds),
         Seconds(rerun.loop_cpu.search), Seconds(rerun.loop_cpu.build),
         Seconds(rerun.loop_cpu.verification),
         Seconds(std::max(0., rerun.cpu_seconds - rerun.loop_cpu.total())),
         absl::StrCat(rerun.searches), absl::StrCat(rerun.matches),
         rerun.searches == 0
             ? ""
             : absl::StrFormat("%.2f",
                               1e3 * rerun.loop_cpu.search / rerun.searches),
         absl::StrFormat(
             "%.0f MiB",
             static_cast<double>(rerun.peak_memory_bytes) / (1 << 20))});
  }
  page->Raw(
      table.ToHtml("CPU seconds of all threads. Search: including the "
                   "refinement of its matches. Verification: planning of "
                   "searches and verification of matches, ours only. Memory: "
                   "peak of the run in addition to the memory used before."));
}

void AddOrigin(const ReportData& data, Markup* const page) {
  AddHeading("origin", "Provenance", page);
  if (!data.assumptions.empty()) {
    page->Element("h3", {}, "Assumptions of the runs");
    page->Open("ul");
    for (const std::string& assumption : data.assumptions) {
      page->Element("li", {}, assumption);
    }
    page->Close();
  }
  if (data.runs.size() > 1) {
    page->Element(
        "p", {{"class", "soft"}},
        "The runs add the stored nodes and submaps to the pose graph in their "
        "recorded order; initial poses come from the chain of local poses. A "
        "node is never searched in a submap that it was inserted into, so no "
        "scan is compared with itself. Local SLAM is not repeated.");
  }
  if (!data.option_differences.empty()) {
    page->Element("h3", {},
                  absl::StrCat("Options: from stock (", data.stock_name,
                               ") to ours (", data.ours_name, ")"));
    page->Element("pre", {}, absl::StrJoin(data.option_differences, "\n"));
  }
  Table versions({"part", "version"});
  for (const auto& version : data.versions) {
    versions.AddRow({version.first, version.second});
  }
  if (!versions.empty()) page->Raw(versions.ToHtml("Versions"));
  page->Element("h3", {}, "Command line");
  page->Element("pre", {}, data.command_line);
}

}  // namespace report
}  // namespace cartographer_ext
