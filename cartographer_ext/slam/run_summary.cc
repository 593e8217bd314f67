// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/run_summary.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/slam/decision_files.h"
#include "cartographer_ext/slam/match_files.h"

namespace cartographer_ext {
namespace evaluation {

namespace {

double Sigma(const uncertainty::CommonDrift& drift, const int i) {
  return std::sqrt(std::max(0., drift.covariance(i, i)));
}

// Means; standard deviations beside what is constant along the run.
nlohmann::ordered_json ToJson(const uncertainty::DriftEstimate& drift) {
  return {{"translation_per_metre", drift.mean.translation_per_metre},
          {"rotation_per_metre", drift.mean.rotation_per_metre},
          {"rotation_per_radian", drift.mean.rotation_per_radian},
          {"heading", drift.common.mean(0)},
          {"heading_sigma", Sigma(drift.common, 0)},
          {"turning", drift.common.mean(1)},
          {"turning_sigma", Sigma(drift.common, 1)},
          {"scale", drift.common.mean(2)},
          {"scale_sigma", Sigma(drift.common, 2)},
          {"cycles", drift.num_cycles}};
}

// Seconds from the first scan to the first one localised in the map.
double SecondsUntilLocalized(const SlamRun& run) {
  return io::ToSeconds(run.localized_at->time -
                       run.local_scan_poses.front().time);
}

// Null if that never happened.
nlohmann::ordered_json LocalizedToJson(const SlamRun& run) {
  if (!run.localized_at.has_value()) return nullptr;
  const Pose2 pose = ToPose2(run.localized_at->pose);
  return {{"time", io::ToSeconds(run.localized_at->time)},
          {"seconds", SecondsUntilLocalized(run)},
          {"x", pose.x},
          {"y", pose.y},
          {"theta", pose.theta}};
}

std::string LocalizedToText(const SlamRun& run) {
  if (!run.localized_at.has_value()) {
    return "Localised  never: no loop constrains the recording to the map\n";
  }
  const Pose2 pose = ToPose2(run.localized_at->pose);
  return absl::StrFormat(
      "Localised  after %.1f s, at x = %.1f m, y = %.1f m, %.0f degrees in the "
      "map frame\n",
      SecondsUntilLocalized(run), pose.x, pose.y, RadToDeg(pose.theta));
}

nlohmann::ordered_json ToJson(const MatchCounts& counts) {
  nlohmann::ordered_json json = {
      {"degenerate_scans", counts.degenerate},
      {"searches", counts.searched},
      {"relocated", counts.relocated},
      {"odometry_faults", counts.odometry_faults},
      {"slip_suspected", counts.slip_suspected},
      {"time_offset", counts.time_offset},
      {"odometry_scale", counts.odometry_scale},
      {"odometry_scale_sigma", counts.odometry_scale_sigma},
      {"rotation_scale", counts.rotation_scale},
      {"rotation_per_metre", counts.rotation_per_metre}};
  if (counts.gyroscope != proto::MatchRecord::NO_GYROSCOPE) {
    json["gyroscope"] = {
        {"state", absl::AsciiStrToLower(
                      proto::MatchRecord::Gyroscope_Name(counts.gyroscope))},
        {"factor", counts.gyroscope_factor},
        {"factor_sigma", counts.gyroscope_factor_sigma}};
  }
  return json;
}

}  // namespace

nlohmann::ordered_json ToJson(const SlamRun& run) {
  nlohmann::ordered_json json;
  json["scans"] = run.scans;
  json["matched_scans"] = run.local_scan_poses.size();
  json["scans_left_out"] = run.skipped_scans;
  json["odometry_readings"] = run.odometry_readings;
  json["imu_readings"] = run.imu_readings;
  json["sensor_seconds"] = run.sensor_seconds;
  json["nodes"] = run.nodes;
  json["submaps"] = run.submaps;
  json["constraints"] = {{"inter", run.inter_constraints},
                         {"intra", run.intra_constraints}};
  json["wall_seconds"] = run.wall_seconds;
  json["cpu_seconds"] = run.cpu_seconds;
  json["front_end_cpu_seconds"] = run.front_end_cpu_seconds;
  json["final_optimization_wall_seconds"] = run.final_optimization_wall_seconds;
  json["latency"] = {{"local_slam_milliseconds",
                      {{"p50", run.latency.local_slam_p50},
                       {"p99", run.latency.local_slam_p99},
                       {"max", run.latency.local_slam_max}}},
                     {"backlog_seconds", {{"max", run.latency.max_backlog}}}};
  json["peak_memory_bytes"] = run.peak_memory_bytes;
  json["loop_search"] = {
      {"count", run.loop_searches},
      {"found", run.loops_found},
      {"cpu_seconds", run.loop_search_cpu_seconds},
      // Otherwise all threads of the back end are counted.
      {"cpu_seconds_of_search_alone", run.loop_search_cpu_is_measured},
      // The parts of these seconds; all 0 if they were not measured.
      {"stages",
       {{"search", run.loop_cpu.search},
        {"build", run.loop_cpu.build},
        {"verification", run.loop_cpu.verification}}}};
  if (!run.matches.empty()) {
    json["local_slam"] = ToJson(CountMatches(run.matches));
  }
  if (!run.decisions.empty()) {
    const DecisionCounts counts = CountDecisions(run.decisions);
    json["loop_decisions"] = {{"accepted", counts.accepted},
                              {"rejected", counts.rejected},
                              {"not_found", counts.not_found},
                              {"undecided", counts.undecided},
                              {"skipped", counts.skipped}};
  }
  if (run.loaded_nodes > 0) json["localized"] = LocalizedToJson(run);
  json["drift"] = ToJson(run.drift);
  const optimization::SwitchedLoops& switched = run.switched_loops;
  json["optimizations"] = {
      {"robust", switched.optimizations},
      {"loops_switched_off", switched.off.size()},
      {"selection_cpu_seconds", switched.selection_cpu_seconds},
      {"solution_cpu_seconds", switched.solution_cpu_seconds}};
  const optimization::LoopsPutInForce& in_force = switched.in_force;
  if (in_force.before.loops > 0) {
    json["optimizations"]["loops_off_map"] = {
        {"loops", in_force.after.loops},
        {"before", in_force.before.off},
        {"after", in_force.after.off},
        {"steps_gave_way", in_force.relaxed}};
  }
  json["optimizations"]["loops_taken_back"] = switched.taken_back.size();
  json["metrics"] = run.metrics;
  json["warnings"] = run.input_warnings;
  for (const std::string& warning : run.warnings) {
    json["warnings"].push_back(warning);
  }
  return json;
}

std::string ToText(const SlamRun& run) {
  std::string text;
  absl::StrAppendFormat(&text, "Map        %d nodes, %d submaps, ", run.nodes,
                        run.submaps);
  if (run.loaded_nodes > 0) {
    // Loops of trimmed submaps are gone by the end.
    absl::StrAppendFormat(&text, "loops found by %d of %d searches\n",
                          run.loops_found, run.loop_searches);
    absl::StrAppend(&text, LocalizedToText(run));
  } else {
    absl::StrAppendFormat(&text, "%d loops from %d searches\n",
                          run.inter_constraints, run.loop_searches);
  }
  absl::StrAppendFormat(&text,
                        "Time       %.1f s for %.1f s of sensor data; CPU %.1f "
                        "s, including %.1f s of local SLAM\n",
                        run.wall_seconds, run.sensor_seconds, run.cpu_seconds,
                        run.front_end_cpu_seconds);
  if (run.latency.scans > 0) {
    absl::StrAppendFormat(
        &text,
        "Latency    local SLAM %.1f ms per scan (99 %% within %.1f, at most "
        "%.1f); back end at most %.1f s\n",
        run.latency.local_slam_p50, run.latency.local_slam_p99,
        run.latency.local_slam_max, run.latency.max_backlog);
  }
  if (run.drift.num_cycles > 0) {
    const uncertainty::CommonDrift& drift = run.drift.common;
    absl::StrAppendFormat(
        &text,
        "Drift      of local SLAM, estimated from %d cycles of loops: heading "
        "%.2f +- %.2f deg/m, rotation %.1f +- %.1f %%, scale %.1f +- %.1f %%\n",
        run.drift.num_cycles, RadToDeg(drift.mean(0)),
        RadToDeg(Sigma(drift, 0)), 100. * drift.mean(1), 100. * Sigma(drift, 1),
        100. * drift.mean(2), 100. * Sigma(drift, 2));
  }
  const optimization::LoopsPutInForce& in_force = run.switched_loops.in_force;
  if (in_force.tried) {
    absl::StrAppendFormat(
        &text, "In force   all but %d of %d loops, %s\n", in_force.after.off,
        in_force.after.loops,
        in_force.relaxed
            ? absl::StrFormat("all but %d before single steps of local SLAM "
                              "gave way to them",
                              in_force.before.off)
            : "which no single steps of local SLAM explain");
  }
  if (!run.switched_loops.taken_back.empty()) {
    absl::StrAppendFormat(
        &text,
        "Taken back %d loops, as the finished map contradicts "
        "them by more than 0.5 m or 17 degrees\n",
        run.switched_loops.taken_back.size());
  }
  return text;
}

}  // namespace evaluation
}  // namespace cartographer_ext
