// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The distance between consecutive nodes of a trajectory, and the factor on the
// weights of its loops that follows from it.
//
// Cartographer gives every step of local SLAM from node to node the same weight,
// however long the step is. The balance between these and the weights of loops
// was chosen for nodes as dense as the motion filter leaves them. If nodes are s
// times farther apart (a recording with one scan per metre), the chain of nodes
// is s times stiffer per metre, and there are s times fewer loops. Beyond
// residuals of millimetres the Huber loss makes the force of a loop proportional
// to its weight, so the balance is restored if a loop has s^2 times the weight.
// All loops of a trajectory get the same factor; their ratios do not change.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_INFORMATION_TYPICAL_STEP_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_INFORMATION_TYPICAL_STEP_H_

#include <cstddef>
#include <deque>
#include <map>

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace loop_closure {

// Typical step per trajectory, and the factor on weights of loops, see above.
// Not thread-safe.
class TypicalStep {
 public:
  // `dense_step`: distance up to which nodes are dense, metres, > 0.
  explicit TypicalStep(double dense_step) : dense_step_(dense_step) {}

  // Adds the next node of a trajectory with its pose (local frame <- node);
  // nodes in between may be missing, older ones are ignored.
  void Add(int trajectory_id, int node_index, const Pose2& local_pose);
  // Factor on the weights of loops of this trajectory, >= 1, from the median of
  // its newest steps; 1 if nodes are dense or fewer than ten steps are known.
  double WeightFactor(int trajectory_id) const;
  // Forgets a trajectory.
  void DeleteTrajectory(int trajectory_id) {
    trajectories_.erase(trajectory_id);
  }

 private:
  static constexpr size_t kMostSteps = 1000;
  static constexpr size_t kFewestSteps = 10;

  struct Trajectory {
    int newest_node = -1;
    Pose2 newest_pose;
    std::deque<double> steps;  // metres, newest last
  };

  const double dense_step_;
  std::map<int, Trajectory> trajectories_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_INFORMATION_TYPICAL_STEP_H_
