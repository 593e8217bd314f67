// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A bounded history of the scans of recent nodes. The host guarantees a node's
// data only until its constraints are computed and does not announce when it is
// trimmed, so code that uses several nodes keeps its own copies. They are taken
// of every proposed node, before any sampler, so that the sequence has no gaps.
//
// Not thread-safe; nodes may be added in any order (a finished submap is
// proposed with all older nodes in a burst).
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_NODE_HISTORY_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_NODE_HISTORY_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/verification/beam_agreement.h"
#include "cartographer_ext/loop_closure/verification/range_signature.h"

namespace cartographer_ext {
namespace loop_closure {

// A node with the description of its scan.
struct HistoryNode {
  int node_index = 0;
  int64_t time = 0;  // host ticks
  Pose2 local_pose;  // (local frame of the trajectory <- node)
  // (gravity-aligned <- tracking frame), radians.
  double aligned_theta = 0.;
  // Description of the scan for the temporal score, one of the two
  // (DescribeScan).
  std::vector<Beam> beams;
  RangeSignature signature;
};

// Recent nodes by trajectory, see above.
class NodeHistory {
 public:
  // Keeps the newest `max_nodes` (> 0) nodes of each trajectory.
  explicit NodeHistory(int max_nodes);

  // Returns false, without effect, if the node exists already or is older than
  // all that are kept of a full trajectory.
  bool Add(int trajectory_id, HistoryNode node);
  bool Contains(int trajectory_id, int node_index) const;
  // Null if the node is not kept.
  const HistoryNode* Find(int trajectory_id, int node_index) const;
  int size(int trajectory_id) const;

  // Up to `count` nodes that end with `node_index`, oldest first; going back,
  // the next one is the first at least `spacing` metres of travel (>= 0) away.
  // Empty when `node_index` is not kept. Looks back over at most `max_scan`
  // nodes, so a stationary robot costs little.
  std::vector<const HistoryNode*> Sequence(int trajectory_id, int node_index,
                                           int count, double spacing,
                                           int max_scan) const;

  void DeleteTrajectory(int trajectory_id);

 private:
  const size_t max_nodes_;
  std::map<int, std::map<int, HistoryNode>> trajectories_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_NODE_HISTORY_H_
