// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How good is a map when nobody knows the truth? A map that folded contradicts
// itself: walls are drawn twice and stand where other submaps saw free space,
// loops pull against each other, and the path of local SLAM is bent between
// neighbouring nodes, where it is best. None of the three is proof, so they are
// kept apart and added in the scale of what is bad.
#ifndef CARTOGRAPHER_EXT_TUNING_SELF_CONSISTENCY_H_
#define CARTOGRAPHER_EXT_TUNING_SELF_CONSISTENCY_H_

#include "cartographer_ext/evaluation/map_graph.h"
#include "cartographer_ext/io/occupancy_map.h"

namespace cartographer_ext {
namespace tuning {

struct SelfConsistency {
  // Mean entropy of the known cells in bits, 0 to 1. Walls drawn twice raise
  // it.
  double map_entropy = 0.;
  // Mean distance in metres between what loops say and where the optimised
  // poses are.
  double loop_residual = 0.;
  // Mean change in metres, per metre of way, of the motion between neighbouring
  // nodes by the optimisation.
  double bending = 0.;

  // map_entropy + loop_residual / 0.1 m + bending / 0.01.
  double Total() const;
};

SelfConsistency ComputeSelfConsistency(const evaluation::MapGraph& graph,
                                       const io::OccupancyMap& map);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_SELF_CONSISTENCY_H_
