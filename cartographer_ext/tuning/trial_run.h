// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// One run of a search: a configuration on a recording (or a finished map), and
// its metrics.
#ifndef CARTOGRAPHER_EXT_TUNING_TRIAL_RUN_H_
#define CARTOGRAPHER_EXT_TUNING_TRIAL_RUN_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/tuning/search_spec.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace tuning {

struct RunRequest {
  // Lua code of the configuration, its name in messages, and the folders for
  // its includes.
  std::string code;
  std::string name;
  std::vector<std::string> directories;
  TuneInput input;
  // Fraction of the recording by time that is run, in (0, 1]. Finished maps are
  // always used as a whole.
  double fidelity = 1.;
  // Overrides that of the configuration unless empty.
  std::string odometry_source;
  int num_threads = 1;
  // Whether self_consistency is wanted; it takes some seconds.
  bool wants_self_consistency = false;
};

// For workers in other processes.
nlohmann::json ToJson(const RunRequest& request);
absl::StatusOr<RunRequest> RequestFromJson(const nlohmann::json& json);

// Metrics by the names of objective.h, and besides them nodes, submaps, loops,
// loop_precision, loop_recall, node_contradiction, ray_contradiction,
// cycle_contradiction, wall_doubling. Metrics that are not available, for
// example relations without ground truth, are omitted.
absl::StatusOr<std::map<std::string, double>> RunTrial(
    const RunRequest& request);

// The answer of a worker (worker_pool.h) to a request.
nlohmann::json AnswerRequest(const nlohmann::json& request);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_TRIAL_RUN_H_
