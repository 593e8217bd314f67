// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Local SLAM driven through a simulated room, for tests.
#ifndef TESTS_FRONT_END_DROPIN_SIMULATED_DRIVE_H_
#define TESTS_FRONT_END_DROPIN_SIMULATED_DRIVE_H_

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/internal/2d/local_trajectory_builder_options_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/front_end/dropin/adaptive_local_trajectory_builder_2d.h"
#include "cartographer_ext/front_end/match_recorder.h"
#include "cartographer_ext/uncertainty/step_errors.h"
#include "tests/front_end/dropin/simulated_room.h"

namespace cartographer_ext {
namespace front_end {
namespace test {

inline cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D
StockOptions() {
  cartographer::common::LuaParameterDictionary dictionary(
      "include 'common_2d.lua' include 'front_end_default.lua' "
      "return TRAJECTORY_BUILDER_2D",
      absl::make_unique<cartographer::common::ConfigurationFileResolver>(
          std::vector<std::string>{"configuration_files"}));
  return cartographer::mapping::CreateLocalTrajectoryBuilderOptions2D(
      &dictionary);
}

inline Pose2 ToPose2(const cartographer::transform::Rigid3d& pose) {
  return Pose2(pose.translation().x(), pose.translation().y(),
               cartographer::transform::GetYaw(pose.rotation()));
}

// A loop through the room with turns in both directions.
inline Pose2 Path(const double t) {
  return Pose2(1.5 * std::sin(0.25 * t), 1.2 * std::sin(0.5 * t) - 0.5,
               0.9 * std::sin(0.35 * t));
}

struct RunResult {
  int matched = 0;
  int nodes = 0;
  double mean_error = 0.;  // metres
  double max_error = 0.;
  double max_turn_error = 0.;  // radians
  Pose2 last;                  // seen from the first pose
  Pose2 true_last;
  std::vector<proto::MatchRecord> records;
  // What of the step to each of them is doubted, radians squared.
  std::vector<double> doubts;
};

struct RunOptions {
  std::vector<Wall> walls = Room();
  std::function<Pose2(double)> path = Path;
  std::function<Pose2(double)> odometry = Path;
  std::function<bool(double)> has_scan = [](double) { return true; };
  std::function<bool(double)> has_odometry = [](double) { return true; };
  // Most beams end at people.
  std::function<bool(double)> is_crowded = [](double) { return false; };
  bool use_odometry = true;
  double seconds = 40.;
  double max_range = 12.;
  double field_of_view = 2. * kPi;  // radians, ahead
  cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D stock =
      StockOptions();
  FrontEndOptions own;
};

inline RunResult RunDrive(const RunOptions& options) {
  const auto context = std::make_shared<PoseGraphContext>();
  context->Get<MatchRecorder>()->Start(100000);
  const ScopedPoseGraphContext scope(context);
  AdaptiveLocalTrajectoryBuilder2D builder(options.stock, options.own,
                                           {"scan"});
  Random random(5);
  RunResult result;
  bool has_first = false;
  Pose2 first_true, first_found;
  double next_odometry = 0.;
  for (int i = 0; i <= static_cast<int>(10. * options.seconds); ++i) {
    const double t = 0.1 * i;
    while (options.use_odometry && next_odometry <= t) {
      if (options.has_odometry(next_odometry)) {
        builder.AddOdometryData(
            Odometry(next_odometry, options.odometry(next_odometry)));
      }
      next_odometry += 0.05;
    }
    if (!options.has_scan(t)) continue;
    auto scan =
        Scan(options.walls, t, options.path(t), options.max_range, &random);
    if (options.is_crowded(t)) {
      for (auto& point : scan.ranges) {
        const bool is_wall = random.Uniform(0., 1.) < 0.2;
        if (!is_wall) point.position *= random.Uniform(0.3, 0.8);
      }
    }
    const auto unseen =
        [&](const cartographer::sensor::TimedRangefinderPoint& point) {
          return std::abs(std::atan2(point.position.y(), point.position.x())) >
                 0.5 * options.field_of_view + 1e-3;
        };
    scan.ranges.erase(
        std::remove_if(scan.ranges.begin(), scan.ranges.end(), unseen),
        scan.ranges.end());
    const auto matched = builder.AddRangeData("scan", scan);
    if (matched == nullptr) continue;
    ++result.matched;
    result.nodes += matched->insertion_result != nullptr;
    const Pose2 found = ToPose2(matched->local_pose);
    if (!has_first) {
      has_first = true;
      first_true = options.path(t);
      first_found = found;
    }
    result.last = Between(first_found, found);
    result.true_last = Between(first_true, options.path(t));
    const Pose2 error = Between(result.true_last, result.last);
    result.mean_error += std::hypot(error.x, error.y);
    result.max_error = std::max(result.max_error, std::hypot(error.x, error.y));
    result.max_turn_error =
        std::max(result.max_turn_error, std::abs(error.theta));
  }
  result.mean_error /= std::max(1, result.matched);
  result.records = context->Get<MatchRecorder>()->All();
  for (const proto::MatchRecord& record : result.records) {
    result.doubts.push_back(
        context->Get<uncertainty::StepErrors>()->At(record.time()).doubt(2, 2));
  }
  return result;
}

inline int Count(const std::vector<proto::MatchRecord>& records,
                 const proto::MatchRecord::OdometryState state) {
  int count = 0;
  for (const proto::MatchRecord& record : records) {
    count += record.odometry() == state;
  }
  return count;
}

}  // namespace test
}  // namespace front_end
}  // namespace cartographer_ext

#endif  // TESTS_FRONT_END_DROPIN_SIMULATED_DRIVE_H_
