// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Global SLAM once more, from nothing but a stored map. Local SLAM is not
// repeated: a map has no raw scans, but it has its results, which are the local
// poses, the filtered clouds of the nodes, and the grids of the submaps. The
// nodes are handed to a new pose graph in the order of replay_plan.h, each with
// the submaps it was inserted in, and every submap turns finished with its last
// node. From there on everything is as in the first run: loops are searched,
// the graph is optimised every so many nodes, and a node's first pose comes
// from the chain of local poses, not from the optimised poses of the file.
//
// Clouds are stored to the millimetre, so results differ from the first run by
// rounding, and runs are chaotic; recorded_track.h can hold a run beside the
// first one.
//
// What this cannot know: a grid contains the scans of the nodes inserted in it.
// The pose graph never searches a node in such a submap, so no loop is found by
// comparing a scan with itself.
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
#include "cartographer_ext/rerun/loop_fate.h"
#include "cartographer_ext/slam/back_end_metrics.h"

namespace cartographer_ext {
namespace evaluation {

struct RerunOptions {
  int num_background_threads = 2;
  // Feeding waits while the back end's queue is longer.
  int max_queue_length = 200;
  // The optimisation is given the stored loops that are found again, so that
  // rounding does not add up (recorded_track.h).
  bool follow_recording = false;
  // Called now and then from the calling thread: nodes fed, nodes in total.
  std::function<void(int64_t, int64_t)> on_progress;
};

struct Rerun {
  std::string name;  // for people, such as "stock"
  // With the ids of the stored map. Nodes that lie in placeholders only have no
  // insertion constraints here.
  MapGraph graph;
  // Ours only; empty for stock, which keeps no records.
  std::vector<proto::LoopDecision> decisions;

  // Of the stored loops, as far as the rules of stock's search go.
  LoopFates fates;
  int64_t followed_loops = 0;

  int64_t nodes = 0;
  int64_t placeholders = 0;
  int64_t guessed_insertions = 0;  // see ReplayPlan::num_guessed
  int64_t searches = 0;
  int64_t matches = 0;  // searches that reached min_score

  // What it took. CPU seconds count all threads of the process.
  double wall_seconds = 0.;
  double cpu_seconds = 0.;
  LoopCpu loop_cpu;
  int64_t peak_memory_bytes = 0;  // more than before the run
  std::map<std::string, double> metrics;
};

// Errors: what MakeReplayPlan complains about. The options must be valid, as
// LoadSlamConfiguration makes sure.
absl::StatusOr<Rerun> RerunPoseGraph(
    const io::Pbstream& pbstream,
    const cartographer::mapping::proto::PoseGraphOptions& pose_graph_options,
    const RerunOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_RERUN_H_
