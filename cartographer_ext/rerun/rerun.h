// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Re-runs global SLAM from a stored map alone. Local SLAM is not repeated: a
// map has no raw scans, but it has the results of local SLAM: the local poses,
// the filtered clouds of the nodes, and the grids of the submaps. The nodes are
// added to a new pose graph in the order of replay_plan.h, each with the
// submaps it was inserted into, and every submap is finished with its last
// node. Everything else is as in the first run: loops are searched, the graph
// is optimised at the configured interval, and the initial pose of a node comes
// from the chain of local poses, not from the optimised poses of the file.
//
// Clouds are stored to the millimetre, so results differ from the first run by
// rounding, to which runs are sensitive; with recorded_track.h a run follows
// the first one.
//
// A grid contains the scans of the nodes inserted into it. The pose graph never
// searches a node in such a submap, so no scan is compared with itself.
#ifndef CARTOGRAPHER_EXT_RERUN_RERUN_H_
#define CARTOGRAPHER_EXT_RERUN_RERUN_H_

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/mapping/proto/pose_graph_options.pb.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/loop_decision.pb.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/rerun/loop_outcome.h"
#include "cartographer_ext/slam/back_end_metrics.h"

namespace cartographer_ext {
namespace evaluation {

struct RerunOptions {
  int num_background_threads = 2;
  // Feeding waits while the back end's queue is longer.
  int max_queue_length = 200;
  // The optimisation uses the stored loops that are reproduced, so that
  // rounding does not accumulate (recorded_track.h).
  bool follow_recording = false;
  // Called occasionally from the calling thread: nodes added, nodes in total.
  std::function<void(int64_t, int64_t)> on_progress;
};

struct Rerun {
  std::string name;  // for display, such as "stock"
  // With the ids of the stored map. Nodes in placeholders only have no
  // insertion constraints here.
  MapGraph graph;
  // Ours only; empty for stock, which keeps no records.
  std::vector<proto::LoopDecision> decisions;

  // Outcomes of the stored loops by the rules of stock's search.
  LoopOutcomes outcomes;
  int64_t followed_loops = 0;

  int64_t nodes = 0;
  int64_t placeholders = 0;
  int64_t guessed_insertions = 0;  // see ReplayPlan::num_guessed
  int64_t searches = 0;
  int64_t matches = 0;  // searches that reached min_score

  // Resource use. CPU seconds include all threads of the process.
  double wall_seconds = 0.;
  double cpu_seconds = 0.;
  LoopCpu loop_cpu;
  int64_t peak_memory_bytes = 0;  // more than before the run
  std::map<std::string, double> metrics;
};

// Errors: those of MakeReplayPlan. The options must be valid, as ensured by
// LoadSlamConfiguration.
absl::StatusOr<Rerun> RerunPoseGraph(
    const io::Pbstream& pbstream,
    const cartographer::mapping::proto::PoseGraphOptions& pose_graph_options,
    const RerunOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_RERUN_H_
