// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Is this loop right? One scan fits behind every door; the scans on the path to
// it fit in one place only. VerifySequence compares them all with the map.
#include <cstdio>
#include <vector>

#include "cartographer_ext/loop_closure/verification/temporal_verification.h"
#include "corridor.h"

using cartographer_ext::Pose2;
namespace loop_closure = cartographer_ext::loop_closure;

loop_closure::OccupancyView ToView(
    const examples::Map& map,
    const loop_closure::TemporalVerificationOptions& options) {
  loop_closure::OccupancyView view(Eigen::Vector2d(map.origin.x, map.origin.y),
                                   map.resolution, map.width, map.height);
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      view.Set(i, j,
               map.at(i, j) > 0.5f ? loop_closure::CellState::kOccupied
                                   : loop_closure::CellState::kFree);
    }
  }
  view.FindDistances(
      loop_closure::DistanceReach(options.beams, map.resolution));
  return view;
}

int main() {
  const loop_closure::TemporalVerificationOptions options;
  const loop_closure::OccupancyView view =
      ToView(examples::Corridor(), options);
  const std::vector<loop_closure::ReferenceMap> maps = {{&view, Pose2()}};

  // Ten nodes along the corridor, in a local frame that knows nothing of the
  // map.
  const Pose2 local_from_map(3., -2., 0.7);
  std::vector<loop_closure::HistoryNode> nodes(10);
  std::vector<const loop_closure::HistoryNode*> query;
  Pose2 truth;
  for (int i = 0; i < 10; ++i) {
    truth = Pose2(8. + 0.5 * i, 1.2, 0.05);
    nodes[i].node_index = i;
    nodes[i].local_pose = local_from_map * truth;
    loop_closure::DescribeScan(options, examples::Scan(truth), &nodes[i]);
    query.push_back(&nodes[i]);
  }
  // The candidates: the right place, and the same place one door further.
  const Pose2 next_door(truth.x - 2.5, truth.y, truth.theta);
  const double right =
      loop_closure::VerifySequence(options, query, truth, maps).score;
  const double wrong =
      loop_closure::VerifySequence(options, query, next_door, maps).score;
  std::printf("temporal score of the right loop %.3f, of a wrong one %.3f\n",
              right, wrong);
  return right > wrong ? 0 : 1;
}
