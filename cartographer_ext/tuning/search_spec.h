// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a search is about, as a small Lua file says it:
//
//   return {
//     configuration = "stock.lua",
//     parameters = {
//       { key = "POSE_GRAPH.constraint_builder.min_score",
//         range = { 0.4, 0.8 } },
//       { key = "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.translation_weight",
//         range = { 1., 1000. }, scale = "log" },
//     },
//     objective = "relations",       -- or { relations = 1., cpu_seconds = 0.01
//     } aggregation = "mean",          -- over recordings; max, geometric_mean
//     target_recall = 0.5,           -- of precision_at_recall
//     no_input_worse = true,         -- than with the configuration as it is
//     inputs = { "a.clf.xz", "b.clf=b_truth.tum", "corridor.world#3" },
//     holdout = { "c.clf" },
//   }
//
// All but `parameters` are optional.
#ifndef CARTOGRAPHER_EXT_TUNING_SEARCH_SPEC_H_
#define CARTOGRAPHER_EXT_TUNING_SEARCH_SPEC_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer_ext/tuning/objective.h"
#include "cartographer_ext/tuning/parameter_space.h"

namespace cartographer_ext {
namespace tuning {

struct SearchSpec {
  std::string configuration;  // empty: not given
  std::vector<Parameter> parameters;
  Objective objective;
  // A result must not be worse than the configuration as it is on any input,
  // however much better on others.
  bool no_input_worse = false;
  std::vector<std::string> inputs;
  std::vector<std::string> holdout;
};

// Errors name the file and the key or line.
absl::StatusOr<SearchSpec> ReadSearchSpec(const std::string& filename);

// A recording with what is known about it.
struct TuneInput {
  // Short and unique: what tables and the journal call it.
  std::string name;
  // Log, bag, world, or a finished map (*.pbstream: loop closure only).
  std::string recording;
  std::string relations_filename;  // empty: none
  std::string reference_filename;  // empty: none
  uint64_t seed = 0;               // of worlds
  bool is_world = false;
  bool is_pbstream = false;
};

// FILE, FILE=TRUTH, or WORLD.world#SEED. TRUTH ending in .tum is a reference
// trajectory, others are relations. Without it, files beside the recording with
// its name but .relations or .tum at the end are taken. The name has the sizes
// of the files in it, so that a journal is not continued with others. Errors
// name the file.
absl::StatusOr<TuneInput> ParseInput(const std::string& text);

// Also refuses the same input twice.
absl::StatusOr<std::vector<TuneInput>> ParseInputs(
    const std::vector<std::string>& texts);

// That every input has the truth that the objective needs. Errors name the
// recording and what it lacks.
absl::Status CheckTruth(const std::vector<TuneInput>& inputs,
                        const Objective& objective);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_SEARCH_SPEC_H_
