// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The report of a new map: judged without ground truth, with the records beside
// it.
#ifndef CARTOGRAPHER_EXT_REPORT_MAP_REPORT_H_
#define CARTOGRAPHER_EXT_REPORT_MAP_REPORT_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/evaluation_report.h"

namespace cartographer_ext {
namespace report {

// A map from a file with its evaluation.
struct JudgedMap {
  std::string filename;
  evaluation::MapGraph graph;
  evaluation::MapContents contents;
  evaluation::Evaluation evaluation;
};

// Errors name the file.
absl::StatusOr<std::unique_ptr<JudgedMap>> JudgeMap(
    const std::string& pbstream_filename);

// The page of a map, with the records of loop closure and local SLAM beside it,
// if any. `title` and `command_line` are shown in the page. Errors name the
// file.
absl::StatusOr<std::string> MakeMapPage(const JudgedMap& map,
                                        const std::string& title,
                                        const std::string& command_line);

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_MAP_REPORT_H_
