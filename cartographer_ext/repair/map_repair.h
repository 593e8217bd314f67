// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Repairs a finished map from its own contents. Each step produces a version of
// the map and is kept only if that version is better (map_quality.h):
//
//   loops re-evaluated     robust selection among the stored loops; wrong ones
//                          are removed
//   loop closure re-run    global SLAM from the stored nodes and submaps, with
//                          our loop closure and with stock's
//   local SLAM re-run      node clouds matched and submaps rebuilt, along the
//                          stored chain of poses, along the odometry, and
//                          with odometry where the two differ; then loop
//                          closure for each
//   submaps rebuilt        along the best version so far
//
// After each run of loop closure its loops are re-evaluated and the remaining ones
// optimised at full weight: the host's Huber loss limits the force of a single
// loop and leaves a part of large errors. The steps stop as soon as the map is
// sound. Stock's loop closure, which takes the longest, is not run either on a map
// that does not contradict itself any more. The result is the best version, or
// the input if none may be written (WhyNotWritten).
#ifndef CARTOGRAPHER_EXT_REPAIR_MAP_REPAIR_H_
#define CARTOGRAPHER_EXT_REPAIR_MAP_REPAIR_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/mapping/proto/local_trajectory_builder_options_2d.pb.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/self_consistency.h"
#include "cartographer_ext/repair/local_faults.h"
#include "cartographer_ext/repair/loops_by_hand.h"
#include "cartographer_ext/repair/map_quality.h"
#include "cartographer_ext/rerun/rerun_configuration.h"

namespace cartographer_ext {
namespace repair {

struct RepairOptions {
  bool loops = true;  // steps that only change loops
  bool local = true;  // steps that re-run local SLAM
  // Options of the pose graph, stock and ours.
  evaluation::RerunConfiguration configuration;
  // Options of local SLAM, ours.
  cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D local_slam;
  // Indices of constraints that the user wants removed, see FindLoops.
  std::vector<int> dropped_loops;
  // Loops that the user wants to add; those that do not match are rejected.
  std::vector<LoopByHand> added_loops;
  // The repaired map keeps the frame of the map by a robust fit of its nodes;
  // otherwise its first node is fixed.
  bool keep_frame = false;
  // Leave the odometry readings out of the repaired map. Cartographer optimises
  // a map again unless it is loaded frozen, and its default weights make the
  // odometry as strong as local SLAM.
  bool drop_odometry = false;
  int max_rounds = 3;  // of local SLAM along the best version so far
  int num_background_threads = 2;
  // Called at the start of a step, with its name.
  std::function<void(const std::string&)> on_step;
  // Called within a step: nodes done and in total.
  std::function<void(int64_t, int64_t)> on_progress;
};

// The map at some point of the repair.
struct MapVersion {
  std::shared_ptr<const io::Pbstream> pbstream;
  evaluation::MapGraph graph;
  evaluation::SelfConsistency consistency;
  MapQuality quality;
};

struct RepairStep {
  std::string name;
  bool kept = false;
  std::string reason;  // why it was kept or not, a clause
  bool has_quality = false;
  MapQuality quality;
  int64_t loops = 0;
};

struct MapRepair {
  MapVersion before, after;
  std::vector<RepairStep> steps;
  // Errors of local SLAM, according to the repaired map.
  std::vector<LocalFault> faults;
  bool changed() const { return before.pbstream != after.pbstream; }
  // A sentence without full stop, such as "nothing to repair: ...".
  std::string conclusion;
  // Advice for the user, sentences.
  std::vector<std::string> advice;
};

MapVersion Assess(std::shared_ptr<const io::Pbstream> pbstream);

// Re-evaluates the loops of the map; null with a reason if there are none or
// none is wrong.
std::shared_ptr<const io::Pbstream> JudgeLoops(const MapVersion& version,
                                               std::string* reason);

// Errors: a map without nodes or clouds.
absl::StatusOr<MapRepair> RepairMap(io::Pbstream pbstream,
                                    const RepairOptions& options);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_MAP_REPAIR_H_
