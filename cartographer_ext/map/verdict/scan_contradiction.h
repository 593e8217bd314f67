// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a map contradicts itself, without any truth. Each scan, at the pose
// that the map gives its node, is held against the submaps of other times: a
// return that lies where such a submap is sure of free space, and a ray that
// went through what such a submap is sure is a wall, both say that one of the
// two is in the wrong place. (Or that somebody moved the furniture; but then it
// is a few rays, not most of the scan.) A folded map has stretches of the path
// whose scans contradict most of what they are laid over.
//
// Scans are not held against the submaps they were inserted in, nor against
// those made just before or after, which local SLAM has aligned anyway.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_SCAN_CONTRADICTION_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_SCAN_CONTRADICTION_H_

#include <vector>

#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

struct ContradictionOptions {
  // Submaps with a node this near in the sequence are not of another time.
  int min_node_gap = 40;
  // Rays are followed up to this distance before the return, metres.
  double ray_margin = 0.4;
  // What a scan and a submap must have to say to each other, in rays.
  int min_judged = 25;
  // A pair of scan and submap is in conflict above this share of rays.
  double conflict_fraction = 0.35;
  // Conflicts with fewer successive nodes are chance.
  int min_stretch_nodes = 3;
  // Nodes without conflict that do not end a stretch.
  int stretch_break = 5;
};

// Of one scan against one submap of another time.
struct ScanConflict {
  GraphId node_id;
  GraphId submap_id;
  int judged = 0;     // rays about which the submap knows something
  int free_hits = 0;  // returns in free space
  int crossings = 0;  // rays through walls
  double fraction() const {
    return judged == 0 ? 0.
                       : static_cast<double>(free_hits + crossings) / judged;
  }
};

// Of one node against all submaps of other times.
struct NodeContradiction {
  GraphId node_id;
  io::TimeNs time = 0;
  int judged = 0;
  int contradicted = 0;
  double fraction = 0.;  // contradicted / judged
  // The submap with the largest share; meaningless when nothing was judged.
  GraphId worst_submap_id;
  double worst_fraction = 0.;
  bool in_conflict = false;
};

// Successive nodes in conflict with the map.
struct ConflictStretch {
  GraphId first_node, last_node;
  io::TimeNs begin = 0, end = 0;
  int num_nodes = 0;               // in conflict
  Eigen::Vector2d center{0., 0.};  // mean place of the nodes, map frame
  double metres = 0.;              // of path
  std::vector<GraphId> submaps;    // that are contradicted, by id
  double fraction = 0.;            // mean worst share
};

struct Contradictions {
  std::vector<NodeContradiction> nodes;  // by id
  std::vector<ScanConflict> conflicts;   // pairs above the share, by node
  std::vector<ConflictStretch> stretches;
  int64_t judged_nodes = 0;    // nodes that saw a place of another time
  int64_t conflict_nodes = 0;  // in stretches
  int64_t judged_rays = 0;
  int64_t contradicted_rays = 0;
  double ray_fraction() const {
    return judged_rays == 0 ? 0.
                            : static_cast<double>(contradicted_rays) /
                                  static_cast<double>(judged_rays);
  }
  double node_fraction() const {
    return judged_nodes == 0 ? 0.
                             : static_cast<double>(conflict_nodes) /
                                   static_cast<double>(judged_nodes);
  }
};

Contradictions FindContradictions(const MapGraph& graph,
                                  const MapContents& contents,
                                  const ContradictionOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_SCAN_CONTRADICTION_H_
