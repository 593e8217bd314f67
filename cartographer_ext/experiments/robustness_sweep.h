// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs back ends on many graphs with outliers. Every finished run is a line of
// a journal, so that an interrupted sweep can be resumed.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_ROBUSTNESS_SWEEP_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_ROBUSTNESS_SWEEP_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/experiments/sweep_graphs.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace experiments {

// Standard deviations (DeviationFromOptimum) up to which a map is the optimum.
constexpr double kSameMap = 0.1;

struct SweepRun {
  std::string dataset, kernel, type;
  bool is_family = false;       // `dataset` is the name of a family
  std::string requested_count;  // as in SweepOptions::counts
  int count = 0;                // outliers
  double outlier_share = 0.;    // of all loops
  int seed = 0;
  double cpu_seconds = 0.;
  double ate = 0.;         // metres, to the optimum without outliers
  double ate_truth = -1.;  // metres, where truth was given
  double rpe = 0.;         // square metres
  double precision = 0., recall = 0.;  // of the loops in force
  double truncated = 0.;               // TruncatedCost
  double selected_truncated = 0.;      // auto: of the member chosen
  int iterations = 0;
  bool converged = false;
  // r_isam, milliseconds.
  double step_mean = 0., step_p99 = 0., step_max = 0.;
  // DeviationFromOptimum; -1 where it is not known.
  double deviation = -1.;
  // The map is the optimum without outliers: `ate` within its limit, or
  // `deviation` at most kSameMap, as in a valley so flat that the data do not
  // say where in it the map is.
  bool success = false;
  bool success_by_ate = false;
  // Families: metres, ATE to the truth of the optimum without outliers; a
  // success may add half of it.
  double inherent_ate = -1.;
  // Truncated cost of the right map, measured as `truncated`.
  double right_truncated = 0.;
  // A failure with less than the cost of the right map: the data favour a wrong
  // one, and no estimator with this cost could succeed.
  bool undecidable = false;
};

nlohmann::ordered_json ToJson(const SweepRun& run);
// False when a key is missing or of another kind.
bool FromJson(const nlohmann::json& json, SweepRun* run);

// All runs in the order data set, type, count, seed, kernel, those of the
// journal included. Bad input (a file, a name, a journal of something else) is
// an error.
absl::StatusOr<std::vector<SweepRun>> RunSweep(const SweepOptions& options);

}  // namespace experiments
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_ROBUSTNESS_SWEEP_H_
