// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/motion_chain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/verdict/motion_disagreement.h"

namespace cartographer_ext {
namespace repair {
namespace {

using evaluation::GraphId;

// The wheels replace local SLAM where the two differ by more than this, and by
// as a multiple of the median difference.
constexpr double kLeastAngle = 0.087;    // radians
constexpr double kLeastDistance = 0.15;  // metres
constexpr double kOutlying = 10.;
// ... and only where at least this share of the difference lasts.
constexpr double kLasting = 0.5;

GraphId IdOf(const cartographer::mapping::proto::Node& node) {
  return {node.node_id().trajectory_id(), node.node_id().node_index()};
}

std::map<GraphId, io::TimeNs> NodeTimes(const io::Pbstream& pbstream) {
  std::map<GraphId, io::TimeNs> times;
  for (const auto& node : pbstream.nodes) {
    times[IdOf(node)] = evaluation::FromHostTicks(node.node_data().timestamp());
  }
  return times;
}

// How the motion from one node to the next differs between two chains.
struct StepDifference {
  GraphId from, to;
  double angle = 0., distance = 0.;  // radians, metres
  // Between two nodes kLastingSeconds before and after the step. Odometry that
  // is late, or freezes and then catches up, differs from step to step and not
  // there.
  double lasting_angle = 0., lasting_distance = 0.;
};

// Of all pairs of successive nodes of a trajectory, in order.
std::vector<StepDifference> CompareChains(
    const MotionChain& a, const MotionChain& b,
    const std::map<GraphId, io::TimeNs>& times) {
  const auto between = [&](const GraphId& from, const GraphId& to) {
    return Between(Between(a.at(from), a.at(to)),
                   Between(b.at(from), b.at(to)));
  };
  const io::TimeNs window = io::FromSeconds(evaluation::kLastingSeconds);
  std::vector<StepDifference> steps;
  auto first = times.begin(), last = times.begin();  // of the window
  for (auto to = times.begin(); to != times.end(); ++to) {
    if (to == times.begin()) continue;
    const auto from = std::prev(to);
    const int trajectory_id = to->first.trajectory_id;
    if (from->first.trajectory_id != trajectory_id) {
      first = last = to;
      continue;
    }
    while (first != from && first->second < from->second - window) ++first;
    if (last->first < to->first) last = to;
    for (auto next = std::next(last);
         next != times.end() && next->first.trajectory_id == trajectory_id &&
         next->second <= to->second + window;
         ++next) {
      last = next;
    }
    const Pose2 step = between(from->first, to->first);
    const Pose2 lasting = between(first->first, last->first);
    steps.push_back({from->first, to->first, std::abs(step.theta),
                     step.translation().norm(), std::abs(lasting.theta),
                     lasting.translation().norm()});
  }
  return steps;
}

}  // namespace

MotionChain LocalChain(const io::Pbstream& pbstream) {
  MotionChain chain;
  for (const auto& node : pbstream.nodes) {
    chain[IdOf(node)] = evaluation::ToPlanarPose(
        cartographer::transform::ToRigid3(node.node_data().local_pose()));
  }
  return chain;
}

MotionChain GlobalChain(const io::Pbstream& pbstream,
                        const evaluation::MapGraph& graph) {
  MotionChain chain = LocalChain(pbstream);
  for (auto& entry : chain) {
    const auto node = graph.nodes.find(entry.first);
    if (node != graph.nodes.end()) entry.second = node->second.global_pose;
  }
  return chain;
}

MotionChain OdometryChain(const io::Pbstream& pbstream) {
  const std::map<int, evaluation::Trajectory> odometry =
      evaluation::ReadOdometry(pbstream);
  const MotionChain local = LocalChain(pbstream);
  MotionChain chain;
  int64_t covered = 0;
  bool has_last = false;
  GraphId last;
  absl::optional<Pose2> last_wheels;
  for (const auto& record : pbstream.nodes) {
    const GraphId id = IdOf(record);
    absl::optional<Pose2> wheels;
    const auto readings = odometry.find(id.trajectory_id);
    if (readings != odometry.end()) {
      const auto pose = readings->second.Lookup(
          evaluation::FromHostTicks(record.node_data().timestamp()), 0);
      if (pose.has_value()) wheels = evaluation::ToPose2(*pose);
    }
    if (!has_last || last.trajectory_id != id.trajectory_id) {
      chain[id] = local.at(id);
    } else if (wheels.has_value() && last_wheels.has_value()) {
      chain[id] = chain[last] * Between(*last_wheels, *wheels);
      ++covered;
    } else {
      chain[id] = chain[last] * Between(local.at(last), local.at(id));
    }
    has_last = true;
    last = id;
    last_wheels = wheels;
  }
  if (2 * covered < static_cast<int64_t>(chain.size())) chain.clear();
  return chain;
}

MotionChain MixedChain(const io::Pbstream& pbstream) {
  const MotionChain wheels = OdometryChain(pbstream);
  if (wheels.empty()) return wheels;
  const MotionChain local = LocalChain(pbstream);
  const std::vector<StepDifference> steps =
      CompareChains(local, wheels, NodeTimes(pbstream));
  std::vector<double> angles, distances;
  for (const StepDifference& step : steps) {
    angles.push_back(step.angle);
    distances.push_back(step.distance);
  }
  if (steps.empty()) return local;
  const double max_angle =
      std::max(kLeastAngle, kOutlying * UpperMedian(angles));
  const double max_distance =
      std::max(kLeastDistance, kOutlying * UpperMedian(distances));
  MotionChain chain = local;
  for (const StepDifference& step : steps) {
    const bool differ = (step.angle > max_angle &&
                         step.lasting_angle >= kLasting * step.angle) ||
                        (step.distance > max_distance &&
                         step.lasting_distance >= kLasting * step.distance);
    const MotionChain& source = differ ? wheels : local;
    chain[step.to] =
        chain[step.from] * Between(source.at(step.from), source.at(step.to));
  }
  return chain;
}

}  // namespace repair
}  // namespace cartographer_ext
