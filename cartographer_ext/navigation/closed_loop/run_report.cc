// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/run_report.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/io/picture.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr int kPicturePixels = 1600;

// Milliseconds that `fraction` of the control cycles took at most.
double CycleTime(const NavigationRun& run, const double fraction) {
  return run.cycle_seconds.empty()
             ? std::numeric_limits<double>::quiet_NaN()
             : 1e3 * NearestRankQuantile(run.cycle_seconds, fraction);
}

nlohmann::ordered_json LocalizationJson(
    const std::vector<LocalizationError>& errors, const int jumps) {
  return {{"median", MedianError(errors)},
          {"max", MaxError(errors)},
          {"jumps", jumps},
          {"scans", errors.size()}};
}

}  // namespace

nlohmann::ordered_json ToJson(const NavigationRun& run) {
  nlohmann::ordered_json json;
  json["goals"] = run.goals.size();
  json["reached"] = run.reached();
  json["collisions"] = {{"static", run.static_collisions},
                        {"moving", run.moving_collisions},
                        {"moving_unseen", run.unseen_collisions},
                        {"run_into_standing_still", run.run_into}};
  json["people_waited_seconds"] = run.people_waited_seconds;
  json["path_ratio"] = run.path_ratio;
  json["travelled_metres"] = run.travelled;
  json["shortest_metres"] = run.shortest;
  json["seconds"] = run.seconds;
  json["localization"] = LocalizationJson(run.localization, run.jumps);
  json["localization"]["stopped_cycles"] = run.lost_cycles;
  json["localization"]["late_optimizations"] = run.late_optimizations;
  json["control_cycle_milliseconds"] = {{"p50", CycleTime(run, 0.5)},
                                        {"p99", CycleTime(run, 0.99)},
                                        {"max", CycleTime(run, 1.)}};
  const double seconds = std::max(1e-9, run.seconds);
  json["cpu_share"] = {
      {"planning_and_control", run.planning_cpu_seconds / seconds},
      {"localization", run.localization_cpu_seconds / seconds},
      {"total",
       (run.planning_cpu_seconds + run.localization_cpu_seconds) / seconds}};
  json["least_clearance"] = run.least_clearance;
  json["plans"] = run.plans;
  json["recoveries"] = run.recoveries;
  json["times_given_way"] = run.times_given_way;
  json["each_goal"] = nlohmann::ordered_json::array();
  for (size_t i = 0; i != run.goals.size(); ++i) {
    const GoalResult& goal = run.goals[i];
    nlohmann::ordered_json entry = {{"x", goal.goal.x()},
                                    {"y", goal.goal.y()},
                                    {"reached", goal.reached},
                                    {"seconds", goal.time},
                                    {"true_error", run.goal_errors[i]}};
    if (!goal.reached) entry["reason"] = goal.reason;
    json["each_goal"].push_back(entry);
  }
  json["contacts"] = nlohmann::ordered_json::array();
  for (const Contact& contact : run.contacts) {
    json["contacts"].push_back(
        {{"seconds", contact.time},
         {"x", contact.place.x()},
         {"y", contact.place.y()},
         {"with", contact.with_moving ? "moving" : "static"},
         {"speed", contact.speed},
         {"turn_rate", contact.turn_rate}});
    if (contact.with_moving && std::isfinite(contact.unseen_seconds)) {
      json["contacts"].back()["unseen_seconds"] = contact.unseen_seconds;
    }
  }
  json["disturbances"] = nlohmann::ordered_json::array();
  for (const Disturbance& disturbance : run.disturbances) {
    json["disturbances"].push_back({{"kind", ToString(disturbance.kind)},
                                    {"happened", disturbance.present}});
  }
  json["map_from_world"] = {{"x", run.map_from_world.x},
                            {"y", run.map_from_world.y},
                            {"theta", run.map_from_world.theta}};
  return json;
}

nlohmann::ordered_json ToJson(const ShadowLocalization& shadow,
                              const double seconds) {
  nlohmann::ordered_json json = LocalizationJson(shadow.errors, shadow.jumps);
  json["cpu_share"] = shadow.cpu_seconds / std::max(1e-9, seconds);
  return json;
}

std::string ToText(const NavigationRun& run) {
  std::string text = absl::StrFormat(
      "Goals         %d of %d reached in %.0f s, %.1f m, %.2f times the "
      "shortest path\n",
      run.reached(), run.goals.size(), run.seconds, run.travelled,
      run.path_ratio);
  for (size_t i = 0; i != run.goals.size(); ++i) {
    if (run.goals[i].reached) continue;
    absl::StrAppendFormat(&text, "              goal %d not reached: %s\n",
                          i + 1, run.goals[i].reason);
  }
  absl::StrAppendFormat(
      &text,
      "Collisions    %d with stationary obstacles (least clearance %.2f m), "
      "%d with moving ones; run into %d times while stationary\n",
      run.static_collisions, run.least_clearance, run.moving_collisions,
      run.run_into);
  absl::StrAppendFormat(
      &text,
      "Localisation  median %.3f m, largest %.3f m, %d jumps above 0.5 m\n",
      MedianError(run.localization), MaxError(run.localization), run.jumps);
  if (run.lost_cycles > 0) {
    absl::StrAppendFormat(
        &text,
        "              stopped for %d of %d control cycles, because the robot "
        "was lost or saw nothing\n",
        run.lost_cycles, run.cycle_seconds.size());
  }
  absl::StrAppendFormat(
      &text,
      "CPU           %.1f %% of a core, of it localisation %.1f %%; a control "
      "cycle %.2f ms, 99 %% below %.2f ms\n",
      100. * (run.planning_cpu_seconds + run.localization_cpu_seconds) /
          std::max(1e-9, run.seconds),
      100. * run.localization_cpu_seconds / std::max(1e-9, run.seconds),
      CycleTime(run, 0.5), CycleTime(run, 0.99));
  return text;
}

absl::Status WriteRunPicture(const NavigationRun& run, const std::string& title,
                             const std::string& filename) {
  io::PictureBounds bounds;
  bounds.Add(run.map);
  io::Picture picture(bounds, kPicturePixels);
  picture.DrawMap(run.map);
  for (const Disturbance& disturbance : run.disturbances) {
    if (!disturbance.present) continue;
    if (disturbance.kind == Disturbance::Kind::kCrossing) {
      picture.DrawLine(run.map_from_world * disturbance.discs.front().center,
                       run.map_from_world * disturbance.end,
                       {io::palette::kPurple, 2., true});
      continue;
    }
    for (const simulation::Disc& disc : disturbance.discs) {
      picture.DrawCircle(run.map_from_world * disc.center, disc.radius,
                         {io::palette::kVermilion, 2.});
    }
  }
  std::vector<Eigen::Vector2d> path;
  for (const Pose2& pose : run.true_path) path.push_back(pose.translation());
  picture.DrawPolyline(path, {io::palette::kBlue, 2.});
  for (size_t i = 0; i != run.goals.size(); ++i) {
    const Eigen::Vector2d goal = run.goals[i].goal;
    if (!goal.allFinite()) continue;
    picture.DrawDot(
        goal, 6.,
        run.goals[i].reached ? io::palette::kGreen : io::palette::kVermilion);
    picture.DrawText(goal + Eigen::Vector2d(0.2, 0.2), absl::StrCat(i + 1), 18.,
                     io::palette::kBlack);
  }
  picture.SetTitle(title);
  picture.AddLegend("path driven", io::palette::kBlue);
  picture.AddLegend("goal reached", io::palette::kGreen);
  picture.AddLegend("obstacle put in the path, goal missed",
                    io::palette::kVermilion);
  picture.AddLegend("sudden crossing", io::palette::kPurple);
  return picture.Write(filename);
}

}  // namespace navigation
}  // namespace cartographer_ext
