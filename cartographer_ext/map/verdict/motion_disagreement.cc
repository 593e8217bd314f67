// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/motion_disagreement.h"

#include <cmath>
#include <iterator>
#include <utility>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/map/host_types.h"

namespace cartographer_ext {
namespace evaluation {

std::map<int, Trajectory> ReadOdometry(const io::Pbstream& pbstream) {
  std::map<int, std::vector<StampedPose>> poses;
  for (const auto& record : pbstream.odometry_data) {
    poses[record.trajectory_id()].push_back(
        {FromHostTicks(record.odometry_data().timestamp()),
         FromHostPose(cartographer::transform::ToRigid3(
             record.odometry_data().pose()))});
  }
  std::map<int, Trajectory> result;
  for (auto& entry : poses) {
    result.emplace(entry.first, Trajectory(std::move(entry.second)));
  }
  return result;
}

namespace {

// Whether no node was trimmed between the two.
bool IsNext(const GraphId& id, const GraphId& next_id) {
  return next_id.trajectory_id == id.trajectory_id &&
         next_id.index == id.index + 1;
}

// Fills in lasting_rotation of steps [begin, end), all of one trajectory, in
// sequence and with odometry; `rotations` are their signed differences in rotation.
void FillLastingRotation(const std::vector<double>& rotations,
                         const size_t begin, const size_t end,
                         std::vector<MotionStep>* const steps) {
  const auto window = static_cast<io::TimeNs>(kLastingSeconds * 1e9);
  // The steps [first, last) lie within the window around step i.
  size_t first = begin, last = begin;
  double sum = 0.;
  for (size_t i = begin; i != end; ++i) {
    const io::TimeNs time = (*steps)[i].time;
    while (last != end && (last <= i || (*steps)[last].time <= time + window)) {
      sum += rotations[last++];
    }
    while (first < i && (*steps)[first].time < time - window) {
      sum -= rotations[first++];
    }
    (*steps)[i].lasting_rotation = std::abs(sum);
  }
}

void FillLastingRotations(const std::vector<double>& rotations,
                          std::vector<MotionStep>* const steps) {
  size_t begin = 0;
  for (size_t i = 0; i <= steps->size(); ++i) {
    if (i != steps->size() && (*steps)[i].has_odometry &&
        (i == begin || IsNext((*steps)[i - 1].node_id, (*steps)[i].node_id))) {
      continue;
    }
    FillLastingRotation(rotations, begin, i, steps);
    begin = i != steps->size() && (*steps)[i].has_odometry ? i : i + 1;
  }
}

}  // namespace

MotionDisagreement CompareMotions(const MapGraph& graph,
                                  const std::map<int, Trajectory>& odometry) {
  MotionDisagreement result;
  std::vector<double> bends, bend_rotations, errors, rotations;
  std::vector<double> signed_rotations;  // of each step
  for (auto it = graph.nodes.begin(); it != graph.nodes.end(); ++it) {
    const auto next = std::next(it);
    if (next == graph.nodes.end() || !IsNext(it->first, next->first)) continue;
    MotionStep step;
    step.node_id = next->first;
    step.time = next->second.time;
    step.seconds = io::ToSeconds(next->second.time - it->second.time);
    const Pose2 local = Between(it->second.local_pose, next->second.local_pose);
    step.metres = local.translation().norm();
    const Pose2 bend = Between(
        local, Between(it->second.global_pose, next->second.global_pose));
    step.bend_translation = bend.translation().norm();
    step.bend_rotation = std::abs(bend.theta);
    bends.push_back(step.bend_translation);
    bend_rotations.push_back(RadToDeg(step.bend_rotation));
    signed_rotations.push_back(0.);
    const auto readings = odometry.find(it->first.trajectory_id);
    if (readings != odometry.end()) {
      const auto from = readings->second.Lookup(it->second.time, 0);
      const auto to = readings->second.Lookup(next->second.time, 0);
      if (from.has_value() && to.has_value()) {
        const Pose2 difference =
            Between(Between(ToPose2(*from), ToPose2(*to)), local);
        step.has_odometry = true;
        step.odometry_translation = difference.translation().norm();
        step.odometry_rotation = std::abs(difference.theta);
        signed_rotations.back() = difference.theta;
        errors.push_back(step.odometry_translation);
        rotations.push_back(RadToDeg(step.odometry_rotation));
      }
    }
    result.steps.push_back(step);
  }
  FillLastingRotations(signed_rotations, &result.steps);
  result.bend_translation = ComputeStatistics(std::move(bends));
  result.bend_rotation_degrees = ComputeStatistics(std::move(bend_rotations));
  result.odometry_translation = ComputeStatistics(std::move(errors));
  result.odometry_rotation_degrees = ComputeStatistics(std::move(rotations));
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
