// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/self_consistency.h"

#include <cmath>

namespace cartographer_ext {
namespace tuning {
namespace {

constexpr double kBadLoopResidual = 0.1;  // metres
constexpr double kBadBending = 0.01;      // metres a metre

double EntropyBits(const double p) {
  if (p <= 0. || p >= 1.) return 0.;
  return -(p * std::log2(p) + (1. - p) * std::log2(1. - p));
}

double MapEntropy(const io::OccupancyMap& map) {
  double sum = 0.;
  int64_t known = 0;
  for (const float p : map.occupancy) {
    if (std::isnan(p)) continue;
    sum += EntropyBits(p);
    ++known;
  }
  return known > 0 ? sum / static_cast<double>(known) : 0.;
}

double LoopResidual(const evaluation::MapGraph& graph) {
  double sum = 0.;
  int64_t count = 0;
  for (const evaluation::GraphConstraint& constraint : graph.constraints) {
    if (!constraint.is_loop) continue;
    const auto submap = graph.submaps.find(constraint.submap_id);
    const auto node = graph.nodes.find(constraint.node_id);
    if (submap == graph.submaps.end() || node == graph.nodes.end()) continue;
    sum += evaluation::Residual(constraint, submap->second, node->second)
               .translation()
               .norm();
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.;
}

double Bending(const evaluation::MapGraph& graph) {
  double change = 0., way = 0.;
  auto previous = graph.nodes.end();
  for (auto node = graph.nodes.begin(); node != graph.nodes.end(); ++node) {
    if (previous != graph.nodes.end() &&
        previous->first.trajectory_id == node->first.trajectory_id) {
      const Pose2 local =
          Between(previous->second.local_pose, node->second.local_pose);
      const Pose2 global =
          Between(previous->second.global_pose, node->second.global_pose);
      change += (global.translation() - local.translation()).norm();
      way += local.translation().norm();
    }
    previous = node;
  }
  return way > 0. ? change / way : 0.;
}

}  // namespace

double SelfConsistency::Total() const {
  return map_entropy + loop_residual / kBadLoopResidual + bending / kBadBending;
}

SelfConsistency ComputeSelfConsistency(const evaluation::MapGraph& graph,
                                       const io::OccupancyMap& map) {
  SelfConsistency result;
  result.map_entropy = MapEntropy(map);
  result.loop_residual = LoopResidual(graph);
  result.bending = Bending(graph);
  return result;
}

}  // namespace tuning
}  // namespace cartographer_ext
