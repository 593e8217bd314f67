// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How often each place that a submap sees is tied to it. Nodes near each other
// along the path are one pass: they say nearly the same. Passes at one place, of
// whichever lap, say the same about the submap up to their noise, so that a few
// of them are enough.
//
// Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_PLACE_PASSES_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_PLACE_PASSES_H_

#include <array>
#include <map>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// What counts as a pass, and how many a place takes.
struct PassLimits {
  double length = 2.;  // metres of path from the first node of a pass
  int most = 3;        // > 0
};

// The passes of one submap, by cells of 2 m and a quarter of a turn.
class PlacePasses {
 public:
  // Adds a node at a pose (submap <- node; metres, radians), if the place takes
  // it.
  void Add(const uncertainty::VertexId& node, const Pose2& pose,
           const PassLimits& limits, const uncertainty::PathUncertainty& paths);
  // Whether the node is of a pass that the place has, or it has fewer than
  // `limits.most`.
  bool Takes(const uncertainty::VertexId& node, const Pose2& pose,
             const PassLimits& limits,
             const uncertainty::PathUncertainty& paths) const;
  // Passes at the place of a pose.
  int Count(const Pose2& pose) const;
  // Forgets the nodes of a trajectory up to an index.
  void Forget(int trajectory_id, int last_node_index);

 private:
  using Place = std::array<int, 3>;

  static Place PlaceOf(const Pose2& pose);

  std::map<Place, std::vector<uncertainty::VertexId>> passes_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_PLACE_PASSES_H_
