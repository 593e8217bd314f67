// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Drives a recording through the host from the first reading to the finished
// map. The same for every command that maps: the map, the numbers beside it,
// and the trajectory at every scan.
//
// What reaches the host, in order of time:
// * every scan as points in the tracking frame (scan_conversion.h). A scan that
//   is not later than the one before, or has no point, is left out and counted.
// * odometry at its own stamps, where the recording has any and the
//   configuration wants it. Readings that are not later than the one before are
//   left out and counted.
// * IMU readings where trajectory_builder_2d.use_imu_data is set.
//
// Feeding pauses while the back end has much left to do, which bounds memory on
// slow machines and changes no result.
#ifndef CARTOGRAPHER_EXT_SLAM_SLAM_RUNNER_H_
#define CARTOGRAPHER_EXT_SLAM_SLAM_RUNNER_H_

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/loop_decision.pb.h"
#include "cartographer_ext/match_record.pb.h"
#include "cartographer_ext/metrics/trajectory.h"
#include "cartographer_ext/optimization/selection/switched_loops.h"
#include "cartographer_ext/slam/back_end_metrics.h"
#include "cartographer_ext/slam/latency_meter.h"
#include "cartographer_ext/slam/sensor_feeder.h"
#include "cartographer_ext/slam/starting_state.h"
#include "cartographer_ext/uncertainty/drift_model.h"

namespace cartographer_ext {
namespace evaluation {

// How far a run is.
struct SlamProgress {
  enum class Stage { kFeeding, kOptimizing };
  Stage stage = Stage::kFeeding;
  int64_t scans = 0;
  int64_t total_scans = 0;
  int64_t queue_length = 0;  // work left in the back end
};

struct SlamRunOptions {
  // Overrides the configuration when positive.
  int num_background_threads = 0;
  // The map to start from, if any.
  StartingState state;
  // Feeding waits while the back end's queue is longer.
  int max_queue_length = 1000;
  // Readings are fed when they would have come, this many times as fast; 0: as
  // fast as possible.
  double realtime_factor = 0.;
  // Called from the calling thread after each scan that was fed, with their
  // number so far and the number in the recording. May add to the pose graph.
  std::function<void(int64_t, int64_t,
                     cartographer::mapping::MapBuilderInterface*)>
      after_scan;
  // Called now and then from the calling thread.
  std::function<void(const SlamProgress&)> on_progress;
};

// A run, with what was fed to it.
struct SlamRun : FedReadings {
  // Finished and optimised; holds the map.
  std::unique_ptr<cartographer::mapping::MapBuilderInterface> map_builder;
  int trajectory_id = 0;

  // What it started from.
  int64_t loaded_nodes = 0;
  int64_t loaded_submaps = 0;

  // What came out, with what was loaded.
  int64_t nodes = 0;
  int64_t submaps = 0;
  int64_t inter_constraints = 0;
  int64_t intra_constraints = 0;
  // Of the inter constraints those between the recording and what was loaded.
  int64_t constraints_to_loaded = 0;
  // Verdicts of the robust optimisation problem in the last optimisation and
  // what it took in all of them; `optimizations` is 0 without it.
  optimization::SwitchedLoops switched_loops;
  // (local <- tracking) and (map <- tracking) at every scan that local SLAM
  // matched. Where the configuration trims nodes (pure localisation) nothing is
  // left to optimise in the end, and the global ones are the online ones.
  std::vector<StampedPose> local_scan_poses;
  std::vector<StampedPose> global_scan_poses;
  // (map <- tracking) as it was known when the scan came, see online_poses.h.
  std::vector<StampedPose> online_scan_poses;

  // In a loaded map: the first scan of which the place in it is known, from an
  // optimisation with a loop to the map on. None when never, or without a map.
  absl::optional<StampedPose> localized_at;

  // What it took. CPU seconds count all threads.
  double wall_seconds = 0.;
  double cpu_seconds = 0.;
  LatencySummary latency;
  double front_end_cpu_seconds = 0.;  // of the feeding thread: local SLAM
  double final_optimization_wall_seconds = 0.;
  int64_t peak_memory_bytes = 0;  // of the process so far
  int64_t loop_searches = 0;
  int64_t loops_found = 0;
  // CPU seconds of closing loops, all stages but the optimisation, where the
  // host's metrics tell; else of all threads but the feeding one.
  double loop_search_cpu_seconds = 0.;
  bool loop_search_cpu_is_measured = false;
  LoopCpu loop_cpu;  // the same by stage
  // The host's metrics at the end, less those at the start.
  std::map<std::string, double> metrics;

  // What our loop closure learnt of local SLAM's drift on this trajectory;
  // without it, or without loops, what it assumes before (no cycles).
  uncertainty::DriftEstimate drift;
  // Why loop candidates were accepted or not, where our loop closure ran.
  std::vector<proto::LoopDecision> decisions;
  // One a matched scan; empty with the stock local SLAM.
  std::vector<proto::MatchRecord> matches;

  std::vector<std::string> warnings;
  // What was odd about the recording and the configuration.
  std::vector<std::string> input_warnings;
};

// Errors: the source's own, a recording without scans or of which local SLAM
// used none, IMU wanted but absent, a map to start from that cannot be read.
absl::StatusOr<SlamRun> RunSlam(const SlamConfiguration& configuration,
                                io::SensorSource* source,
                                const SlamRunOptions& options);

// Writes the map of a run atomically.
absl::Status WritePbstream(
    cartographer::mapping::MapBuilderInterface* map_builder,
    const std::string& filename);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_SLAM_RUNNER_H_
