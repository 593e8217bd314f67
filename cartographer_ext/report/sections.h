// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The sections of the page, in order. Each adds a heading with an anchor and
// its content, or nothing if there is nothing to show.
#ifndef CARTOGRAPHER_EXT_REPORT_SECTIONS_H_
#define CARTOGRAPHER_EXT_REPORT_SECTIONS_H_

#include <string>
#include <vector>

#include "Eigen/Core"
#include "absl/status/status.h"
#include "cartographer_ext/io/picture.h"
#include "cartographer_ext/report/loop_evidence.h"
#include "cartographer_ext/report/markup.h"
#include "cartographer_ext/report/report_data.h"

namespace cartographer_ext {
namespace report {

// Data used by several sections.
struct Prepared {
  // Parallel to ReportData::runs.
  std::vector<std::vector<LoopEvidence>> evidence;
  std::vector<std::string> image_ids;  // empty without a picture
  io::PictureBounds bounds;            // of all maps
  io::TimeNs start = 0;                // of the first node
};

void AddHeading(const std::string& id, const std::string& text, Markup* page);
// The head of a page, including its style.
void AddHead(const std::string& title, Markup* page);

// Verdict, figures, and all runs in one table.
void AddSummary(const ReportData& data, Markup* page);
// Where the map contradicts itself; before and after.
void AddMaps(const ReportData& data, const Prepared& prepared, Markup* page);
// The map as stored, with rings at contradicted path pieces and wrong turns. A
// click on one shows two scans over each other: of a node in conflict and of
// the visit that it contradicts; before and after a turn.
void AddPlaces(const ReportData& data, const Prepared& prepared, Markup* page);
// The nodes of those scans.
std::vector<evaluation::GraphId> NodesOfPlaces(const ReportData& data);
// Loops on the map, coloured by verdict.
void AddLoops(const ReportData& data, const Prepared& prepared, Markup* page);
// The scans of loops and places as data for the script: { "trajectory:node":
// [x, y, ...] }, centimetres in the frame of the node.
void AddScans(const ReportData& data, const Prepared& prepared, Markup* page);
// Histograms of scores and residuals, and the two scores against each other.
void AddScores(const ReportData& data, const Prepared& prepared, Markup* page);
// Quantities along the path: contradiction, odometry, degeneracy.
void AddPath(const ReportData& data, const Prepared& prepared, Markup* page);
// Which loops the runs have in common, and why candidates were rejected.
void AddComparison(const ReportData& data, Markup* page);
// The worst loops with their scans, as pictures and as a table.
void AddWorstLoops(const ReportData& data, const Prepared& prepared,
                   Markup* page);
// Time and memory of the runs.
void AddTiming(const ReportData& data, Markup* page);
// Options, versions, command line.
void AddOrigin(const ReportData& data, Markup* page);

// Positions of the nodes; trajectories are separated by a point that is not
// finite.
std::vector<Eigen::Vector2d> NodePath(const evaluation::MapGraph& graph);
// Seconds after `start` of each of these positions; not finite between
// trajectories.
std::vector<double> NodeSeconds(const evaluation::MapGraph& graph,
                                io::TimeNs start);

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_SECTIONS_H_
