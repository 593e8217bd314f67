// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Definition of a search, in a small Lua file:
//
//   return {
//     configuration = "stock.lua",
//     parameters = {
//       { key = "POSE_GRAPH.constraint_builder.min_score",
//         range = { 0.4, 0.8 } },
//       { key = "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.translation_weight",
//         range = { 1., 1000. }, scale = "log" },
//     },
//     objective = "relations",       -- or a table of weights
//     aggregation = "mean",          -- over recordings; max, geometric_mean
//     target_recall = 0.5,           -- of precision_at_recall
//     no_input_worse = true,         -- than with the initial configuration
//     inputs = { "a.clf.xz", "b.clf=b_truth.tum", "corridor.world#3" },
//     holdout = { "c.clf" },
//   }
//
// All except `parameters` are optional.
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
  // A result must not be worse than the initial configuration on any input,
  // however much better on others.
  bool no_input_worse = false;
  std::vector<std::string> inputs;
  std::vector<std::string> holdout;
};

// Errors name the file and the key or line.
absl::StatusOr<SearchSpec> ReadSearchSpec(const std::string& filename);

// A recording with its ground truth.
struct TuneInput {
  // Short, unique name for tables and the journal.
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
// its name and the extension .relations or .tum are used. The name contains the
// sizes of the files, so that a journal is not continued with different ones.
// Errors name the file.
absl::StatusOr<TuneInput> ParseInput(const std::string& text);

// Also refuses the same input twice.
absl::StatusOr<std::vector<TuneInput>> ParseInputs(
    const std::vector<std::string>& texts);

// Checks that every input has the ground truth that the objective needs. Errors
// name the recording and the missing data.
absl::Status CheckTruth(const std::vector<TuneInput>& inputs,
                        const Objective& objective);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_SEARCH_SPEC_H_
