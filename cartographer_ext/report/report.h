// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The report of a map as one self-contained HTML file without network, server
// or fonts. docs/report.md describes its figures.
#ifndef CARTOGRAPHER_EXT_REPORT_REPORT_H_
#define CARTOGRAPHER_EXT_REPORT_REPORT_H_

#include <string>

#include "absl/status/statusor.h"
#include "cartographer_ext/report/report_data.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace report {

// An error without runs, or if the map has no nodes.
absl::StatusOr<std::string> MakeReport(const ReportData& data);

// The numbers of the runs as JSON: an array of objects with name, loops,
// evaluation, comparison, times.
nlohmann::ordered_json RunsToJson(const ReportData& data);

// The re-runs as text, several lines; empty without re-runs.
std::string RunsToText(const ReportData& data);

// The loops of all runs with their evidence as CSV, with a header line.
std::string LoopsToCsv(const ReportData& data);

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_REPORT_H_
