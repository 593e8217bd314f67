// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/loop_cycles.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace cartographer_ext {
namespace evaluation {
namespace {

struct Loop {
  size_t position = 0;  // among the loops
  const GraphConstraint* constraint = nullptr;
  const GraphSubmap* submap = nullptr;
  const GraphNode* node = nullptr;
};

// How far the cycle of two loops is from closing.
Pose2 Closure(const Loop& a, const Loop& b) {
  return a.constraint->relative_pose *
         Between(a.node->local_pose, b.node->local_pose) *
         b.constraint->relative_pose.Inverse() *
         Between(b.submap->local_pose, a.submap->local_pose);
}

}  // namespace

LoopCycles ComputeLoopCycles(const MapGraph& graph,
                             const LoopCycleOptions& options) {
  LoopCycles result;
  std::vector<Loop> loops;
  size_t count = 0;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (!constraint.is_loop) continue;
    const size_t position = count++;
    const auto submap = graph.submaps.find(constraint.submap_id);
    const auto node = graph.nodes.find(constraint.node_id);
    if (submap == graph.submaps.end() || node == graph.nodes.end()) continue;
    loops.push_back({position, &constraint, &submap->second, &node->second});
  }
  result.inconsistent_fraction.assign(count, 0.);
  result.partners.assign(count, 0);
  std::sort(loops.begin(), loops.end(), [](const Loop& a, const Loop& b) {
    return std::make_pair(a.constraint->node_id, a.constraint->submap_id) <
           std::make_pair(b.constraint->node_id, b.constraint->submap_id);
  });
  std::vector<double> translations, rotations;
  std::vector<int> open(count, 0);
  for (size_t i = 0; i < loops.size(); ++i) {
    const GraphConstraint& a = *loops[i].constraint;
    int partners = 0;
    for (size_t k = i + 1; k < loops.size() && partners < options.max_partners;
         ++k) {
      const GraphConstraint& b = *loops[k].constraint;
      if (b.node_id.trajectory_id != a.node_id.trajectory_id ||
          b.node_id.index - a.node_id.index > options.max_node_gap) {
        break;
      }
      if (b.submap_id.trajectory_id != a.submap_id.trajectory_id ||
          std::abs(b.submap_id.index - a.submap_id.index) >
              options.max_submap_gap ||
          (loops[i].node->local_pose.translation() -
           loops[k].node->local_pose.translation())
                  .norm() > options.max_metres) {
        continue;
      }
      ++partners;
      const Pose2 closure = Closure(loops[i], loops[k]);
      const double translation = closure.translation().norm();
      const double rotation = std::abs(closure.theta);
      translations.push_back(translation);
      rotations.push_back(RadToDeg(rotation));
      ++result.cycles;
      ++result.partners[loops[i].position];
      ++result.partners[loops[k].position];
      if (translation > options.consistent_translation ||
          rotation > options.consistent_rotation) {
        ++result.inconsistent;
        ++open[loops[i].position];
        ++open[loops[k].position];
      }
    }
  }
  for (size_t i = 0; i < count; ++i) {
    if (result.partners[i] > 0) {
      result.inconsistent_fraction[i] =
          static_cast<double>(open[i]) / result.partners[i];
    }
  }
  result.translation = ComputeStatistics(std::move(translations));
  result.rotation_degrees = ComputeStatistics(std::move(rotations));
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
