// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Everything that a report shows.
#ifndef CARTOGRAPHER_EXT_REPORT_REPORT_DATA_H_
#define CARTOGRAPHER_EXT_REPORT_REPORT_DATA_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/loop_decision.pb.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/evaluation_report.h"
#include "cartographer_ext/rerun/loop_comparison.h"
#include "cartographer_ext/rerun/rerun.h"

namespace cartographer_ext {
namespace report {

// The map as stored, or the result of a re-run.
struct ReportRun {
  std::string name;   // "as stored", "stock re-run", "ours"
  std::string style;  // class of its lines
  evaluation::MapGraph graph;
  evaluation::Evaluation evaluation;  // with loops and consistency
  // Resource use and decisions of the run; absent for the stored map.
  absl::optional<evaluation::Rerun> rerun;
  // Decisions of the run that made the stored map, if stored beside it.
  std::vector<proto::LoopDecision> stored_decisions;

  // Decisions of our loop closure; empty for stock.
  const std::vector<proto::LoopDecision>& decisions() const {
    return rerun.has_value() ? rerun->decisions : stored_decisions;
  }

  // Comparison of the loops of the stored map with those of this run.
  absl::optional<evaluation::LoopComparison> against_stored;
};

// Degeneracy of the scan match at a node, from the records of local SLAM.
struct DegeneracySample {
  io::TimeNs time = 0;
  double ratio = 0.;      // weakest to strongest direction, 0 to 1
  double direction = 0.;  // of the weakest, radians in the map
  bool degenerate = false;
};

struct ReportData {
  std::string title;
  std::string command_line;
  std::vector<std::pair<std::string, std::string>> versions;
  const evaluation::MapContents* contents = nullptr;
  // The stored map first.
  std::vector<ReportRun> runs;
  std::vector<DegeneracySample> degeneracy;
  std::string stock_name, ours_name;
  double stock_min_score = 0.;  // 0: unknown
  std::vector<std::string> assumptions;
  // Differences from stock's options to ours, one per line.
  std::vector<std::string> option_differences;
  std::vector<std::string> notes;
  // Times are not reproducible; without them the page is.
  bool with_times = true;
};

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_REPORT_DATA_H_
