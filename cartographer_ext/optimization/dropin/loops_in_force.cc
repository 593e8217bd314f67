// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Only where the swap is selected; see the overlay.
#include "cartographer_ext/swaps.h"
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/optimization/dropin/loops_in_force.h"

namespace cartographer_ext {
namespace optimization {
namespace {

namespace mapping = cartographer::mapping;
namespace transform = cartographer::transform;
using Constraint = mapping::PoseGraphInterface::Constraint;

// See the header.
constexpr double kOffRadians = 0.1;
constexpr double kPullOfLoops = 30.;
constexpr double kStepHuberScale = 300.;
constexpr int64_t kLeastOff = 5;
constexpr double kShareOff = 0.02;
constexpr double kShareStillOff = 0.1;
constexpr double kStillOffOfThese = 0.25;
constexpr double kFarOffMetres = 0.5;
constexpr double kFarOffRadians = 0.3;

using Nodes =
    mapping::MapById<mapping::NodeId, mapping::optimization::NodeSpec2D>;
using Submaps =
    mapping::MapById<mapping::SubmapId, mapping::optimization::SubmapSpec2D>;

bool IsPresentLoop(const Constraint& constraint, const Nodes& nodes,
                   const Submaps& submaps) {
  return constraint.tag == Constraint::INTER_SUBMAP &&
         nodes.Contains(constraint.node_id) &&
         submaps.Contains(constraint.submap_id);
}

// Of a loop that is present.
bool IsOffMap(const Constraint& loop, const Nodes& nodes,
              const Submaps& submaps, const double metres,
              const double radians) {
  return IsOff(loop, submaps.at(loop.submap_id).global_pose,
               nodes.at(loop.node_id).global_pose_2d, metres, radians);
}

void CountSteps(const Nodes& nodes, const double metres, const double radians,
                LoopsOffMap* const result) {
  for (const int trajectory_id : nodes.trajectory_ids()) {
    const auto trajectory = nodes.trajectory(trajectory_id);
    if (trajectory.begin() == trajectory.end()) continue;
    for (auto last = trajectory.begin(), next = std::next(last);
         next != trajectory.end(); last = next, ++next) {
      const transform::Rigid2d by_local_slam =
          last->data.local_pose_2d.inverse() * next->data.local_pose_2d;
      const transform::Rigid2d error =
          by_local_slam.inverse() *
          (last->data.global_pose_2d.inverse() * next->data.global_pose_2d);
      ++result->steps;
      result->steps_off += error.translation().norm() > metres ||
                           std::abs(error.normalized_angle()) > radians;
    }
  }
}

// Whether enough loops are in force after the problem was relaxed, and not by
// steps that follow any loop.
bool IsInForce(const LoopsOffMap& before, const LoopsOffMap& after) {
  return after.off <= kShareStillOff * after.loops &&
         after.off <= kStillOffOfThese * before.off &&
         after.steps_off - before.steps_off <= kShareOff * after.steps;
}

}  // namespace

bool IsOff(const Constraint& constraint, const transform::Rigid2d& submap_pose,
           const transform::Rigid2d& node_pose, const double metres,
           const double radians) {
  const transform::Rigid2d error =
      transform::Project2D(constraint.pose.zbar_ij).inverse() *
      submap_pose.inverse() * node_pose;
  return error.translation().norm() > metres ||
         std::abs(error.normalized_angle()) > radians;
}

LoopsOffMap CountLoopsOffMap(const std::vector<Constraint>& constraints,
                             const Nodes& nodes, const Submaps& submaps,
                             const double distance) {
  LoopsOffMap result;
  for (const Constraint& constraint : constraints) {
    if (!IsPresentLoop(constraint, nodes, submaps)) continue;
    ++result.loops;
    result.off += IsOffMap(constraint, nodes, submaps, distance, kOffRadians);
  }
  CountSteps(nodes, distance, kOffRadians, &result);
  return result;
}

std::vector<LoopId> TakeOutFarOff(const Nodes& nodes, const Submaps& submaps,
                                  std::vector<Constraint>* const constraints) {
  std::vector<LoopId> taken;
  std::vector<Constraint> kept;
  int64_t loops = 0;
  for (const Constraint& constraint : *constraints) {
    const bool is_loop = IsPresentLoop(constraint, nodes, submaps);
    loops += is_loop;
    if (is_loop &&
        IsOffMap(constraint, nodes, submaps, kFarOffMetres, kFarOffRadians)) {
      taken.push_back(MakeLoopId(constraint.submap_id, constraint.node_id));
    } else {
      kept.push_back(constraint);
    }
  }
  if (static_cast<double>(taken.size()) > kShareStillOff * loops) return {};
  *constraints = std::move(kept);
  return taken;
}

std::vector<Relaxation> RelaxationsOf(
    const mapping::optimization::proto::OptimizationProblemOptions& options,
    const std::vector<Constraint>& constraints) {
  Relaxation single;
  single.pull_of_loops = kPullOfLoops;
  single.step_translation_weight = options.local_slam_pose_translation_weight();
  single.step_rotation_weight = options.local_slam_pose_rotation_weight();
  single.step_huber_scale = kStepHuberScale;
  std::vector<Relaxation> relaxations{single};
  const auto insertion = std::find_if(
      constraints.begin(), constraints.end(), [](const Constraint& constraint) {
        return constraint.tag == Constraint::INTRA_SUBMAP;
      });
  if (insertion == constraints.end() || single.step_translation_weight <= 0. ||
      single.step_rotation_weight <= 0.) {
    return relaxations;
  }
  Relaxation all = single;
  all.step_translation_factor = std::min(
      1., insertion->pose.translation_weight / single.step_translation_weight);
  all.step_rotation_factor = std::min(
      1., insertion->pose.rotation_weight / single.step_rotation_weight);
  relaxations.push_back(all);
  return relaxations;
}

LoopsPutInForce PutLoopsInForce(
    const std::function<void(const Relaxation*)>& solve,
    const std::function<LoopsOffMap()>& count,
    const std::vector<Relaxation>& relaxations) {
  LoopsPutInForce result;
  result.before = count();
  result.after = result.before;
  result.tried = result.before.off >= kLeastOff &&
                 result.before.off >= kShareOff * result.before.loops;
  if (!result.tried) return result;
  for (const Relaxation& relaxation : relaxations) {
    solve(&relaxation);
    result.after = count();
    result.relaxed = IsInForce(result.before, result.after);
    if (result.relaxed) return result;
  }
  solve(nullptr);
  result.after = count();
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
#endif  // CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
