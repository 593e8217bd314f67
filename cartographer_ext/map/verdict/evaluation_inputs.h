// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads what is evaluated, and the ground truth, from files: of a map only
// what is then used.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_EVALUATION_INPUTS_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_EVALUATION_INPUTS_H_

#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/map_evaluation.h"
#include "cartographer_ext/metrics/trajectory.h"

namespace cartographer_ext {
namespace evaluation {

// Names; those that are empty are not read.
struct EvaluationFiles {
  std::string pbstream;
  std::string trajectory;            // TUM
  std::string relations;             // ground truth
  std::string reference_trajectory;  // ground truth, TUM
};

// What a map is read for, besides its graph. To make the contents and their
// tables of distances takes longer than all the rest of the reading.
struct EvaluationUses {
  bool contents = true;      // consistency is checked, or pictures are made
  bool stored_grids = true;  // the pose graph is run again
};

struct EvaluationInputs {
  // Without the cells of its grids unless `stored_grids` are used.
  absl::optional<io::Pbstream> pbstream;
  // The following three: of the pbstream.
  MapGraph graph;
  MapContents contents;  // empty unless used
  std::map<int, Trajectory> odometry;
  absl::optional<Trajectory> trajectory;
  GroundTruth truth;
};

// Errors name the file.
absl::StatusOr<EvaluationInputs> ReadEvaluationInputs(
    const EvaluationFiles& files, const EvaluationUses& uses);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_EVALUATION_INPUTS_H_
