// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs the host on a recording from the first reading to the finished map. Used
// by every command that maps: gives the map, its statistics, and the trajectory
// at every scan.
//
// Input of the host, in order of time:
// * every scan as points in the tracking frame (scan_conversion.h). A scan that
//   is not later than the previous one, or has no point, is skipped and counted.
// * odometry at its own stamps, if the recording has any and the configuration
//   uses it. Readings that are not later than the previous one are skipped and
//   counted.
// * IMU readings if trajectory_builder_2d.use_imu_data is set.
//
// Feeding pauses while the back end has a long queue, which bounds memory on
// slow machines without affecting the result.
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
#include "cartographer_ext/loop_closure/decision_records.h"
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

// Progress of a run.
struct SlamProgress {
  enum class Stage { kFeeding, kOptimizing };
  Stage stage = Stage::kFeeding;
  int64_t scans = 0;
  int64_t total_scans = 0;
  int64_t queue_length = 0;  // of the back end
};

struct SlamRunOptions {
  // Overrides the configuration when positive.
  int num_background_threads = 0;
  // The map to start from, if any.
  StartingState state;
  // Feeding waits while the back end's queue is longer.
  int max_queue_length = 1000;
  // Readings are fed at this multiple of real time; 0: as fast as possible.
  double realtime_factor = 0.;
  // Called from the calling thread after each scan, with the number of scans so
  // far and in the recording. May add to the pose graph.
  std::function<void(int64_t, int64_t,
                     cartographer::mapping::MapBuilderInterface*)>
      after_scan;
  // Called occasionally from the calling thread.
  std::function<void(const SlamProgress&)> on_progress;
};

// A run and its input.
struct SlamRun : FedReadings {
  // Finished and optimised; holds the map.
  std::unique_ptr<cartographer::mapping::MapBuilderInterface> map_builder;
  int trajectory_id = 0;

  // The loaded map.
  int64_t loaded_nodes = 0;
  int64_t loaded_submaps = 0;

  // Contents of the map, including the loaded part.
  int64_t nodes = 0;
  int64_t submaps = 0;
  int64_t inter_constraints = 0;
  int64_t intra_constraints = 0;
  // Inter-submap constraints between the recording and the loaded map.
  int64_t constraints_to_loaded = 0;
  // Verdicts of the robust optimisation problem in the last optimisation and
  // its cost in all of them; `optimizations` is 0 without it.
  optimization::SwitchedLoops switched_loops;
  // (local <- tracking) and (map <- tracking) at every scan that local SLAM
  // matched. If the configuration trims nodes (pure localisation), there is
  // nothing to optimise at the end, and the global poses are the online ones.
  std::vector<StampedPose> local_scan_poses;
  std::vector<StampedPose> global_scan_poses;
  // (map <- tracking) as published online, see online_poses.h.
  std::vector<StampedPose> online_scan_poses;

  // In a loaded map: the first scan whose pose in it is known, after an
  // optimisation with a loop to the map. None if there is none, or without a
  // map.
  absl::optional<StampedPose> localized_at;

  // Resource use. CPU seconds include all threads.
  double wall_seconds = 0.;
  double cpu_seconds = 0.;
  LatencySummary latency;
  double front_end_cpu_seconds = 0.;  // of the feeding thread: local SLAM
  double final_optimization_wall_seconds = 0.;
  int64_t peak_memory_bytes = 0;  // of the process so far
  int64_t loop_searches = 0;
  int64_t loops_found = 0;
  // CPU seconds of loop closure, all stages except the optimisation, if the
  // host's metrics include them; otherwise of all threads except the feeding
  // one.
  double loop_search_cpu_seconds = 0.;
  bool loop_search_cpu_is_measured = false;
  LoopCpu loop_cpu;  // the same by stage
  // The host's metrics, as difference between end and start.
  std::map<std::string, double> metrics;

  // Drift of local SLAM on this trajectory as estimated by our loop closure;
  // without it, or without loops, the prior (no cycles).
  uncertainty::DriftEstimate drift;
  // Decisions on loop candidates; empty without our loop closure.
  loop_closure::DecisionRecords decisions;
  // One per matched scan; empty with stock's local SLAM.
  std::vector<proto::MatchRecord> matches;

  std::vector<std::string> warnings;
  // Warnings about the recording and the configuration.
  std::vector<std::string> input_warnings;
};

// Errors: those of the source, a recording without scans or without scans used
// by local SLAM, a required but missing IMU, an unreadable initial map.
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
