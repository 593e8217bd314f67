// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The report of a map that was just made: judged without ground truth, with the
// records that lie beside it.
#ifndef CARTOGRAPHER_EXT_REPORT_MAP_REPORT_H_
#define CARTOGRAPHER_EXT_REPORT_MAP_REPORT_H_

#include <string>

#include "absl/status/statusor.h"
#include "cartographer_ext/map/verdict/evaluation_report.h"

namespace cartographer_ext {
namespace report {

struct MapReport {
  evaluation::Evaluation evaluation;
  std::string page;  // HTML
};

// Reads the map and, where they are there, the records of loop closure and
// local SLAM beside it. `title` and `command_line` stand in the page. Errors
// name the file.
absl::StatusOr<MapReport> ReportMap(const std::string& pbstream_filename,
                                    const std::string& title,
                                    const std::string& command_line);

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_MAP_REPORT_H_
