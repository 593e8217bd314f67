// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A stored map and the results of re-runs of its pose graph, all evaluated
// alike.
#ifndef CARTOGRAPHER_EXT_REPORT_MAP_RUNS_H_
#define CARTOGRAPHER_EXT_REPORT_MAP_RUNS_H_

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/map/verdict/map_evaluation.h"
#include "cartographer_ext/report/report_data.h"
#include "cartographer_ext/rerun/rerun.h"
#include "cartographer_ext/rerun/rerun_configuration.h"

namespace cartographer_ext {
namespace report {

// Inputs of the runs; not owned.
struct RunInputs {
  const io::Pbstream* pbstream = nullptr;
  const evaluation::MapGraph* graph = nullptr;
  const evaluation::MapContents* contents = nullptr;
  const std::map<int, evaluation::Trajectory>* odometry = nullptr;
  const evaluation::GroundTruth* truth = nullptr;
  evaluation::MapEvaluationOptions evaluation;
  evaluation::RerunOptions rerun;
};

// The map of the file, evaluated as given.
ReportRun StoredRun(const RunInputs& inputs, evaluation::Evaluation evaluation);

// Re-runs the pose graph with stock's options and, if the configuration has our
// blocks, with ours; evaluates both and compares their loops with the stored
// ones. Names of the options and assumptions are added to `data`.
absl::Status AddReruns(const RunInputs& inputs,
                       const evaluation::RerunConfiguration& configuration,
                       ReportData* data);

// From the records of local SLAM beside a map; those of nodes only. Errors name
// the file; NotFound if there is none.
absl::StatusOr<std::vector<DegeneracySample>> ReadDegeneracy(
    const std::string& filename);

// Versions of this library, its host, and the libraries that affect results.
std::vector<std::pair<std::string, std::string>> Versions();

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_MAP_RUNS_H_
