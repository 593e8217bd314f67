// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Contradictions within a map, without ground truth. Each scan, at the pose of
// its node in the map, is compared with the submaps of other times: a return in
// space that such a submap holds free, or a ray through a wall of such a submap,
// indicates that one of the two is misplaced. (Moved furniture has the same
// effect, but on a few rays, not on most of the scan.) A folded map has path
// pieces whose scans contradict most of the submaps they overlap.
//
// A submap is placed by its inserted node nearest to the scan: where the
// optimisation has bent a submap, it lies elsewhere as drawn than the scans it
// was drawn from. But 20 m away from that node an error of its heading of one
// degree moves what the scan sees by 0.35 m, and so does an error of the heading
// of the scan itself. The map itself shows how well headings are known: by those that
// the inserted nodes of a submap give it, with standard deviation sigma. A scan
// is in conflict only if it is at all turns of the scan or of the submap about
// its nearest node within two sigma, as far as these move what the scan sees by
// no more than half a metre, beyond which a map is wrong in any case.
//
// Scans are not compared with the submaps they were inserted into, nor with
// those built just before or after, which local SLAM has aligned. What a scan
// contradicts though the robot has not come back since (IsOneVisit) is told apart:
// on one visit, local SLAM has aligned both with what lies between. A car
// that pitches, and sees crowns here and trunks there, contradicts what is 15 m
// ahead in a map that is right. And a person beside the robot hides half of what
// it sees, so that most of the rays end in space that was free, or pass where they
// stood, while local SLAM that goes astray is contradicted in many places: on one
// visit, the rays that contradict a submap around a single place of the size of a
// person (`object_size`), that with the most of them, do not count.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_SCAN_CONTRADICTION_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_SCAN_CONTRADICTION_H_

#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/path_piece.h"
#include "cartographer_ext/map/verdict/placed_submaps.h"

namespace cartographer_ext {
namespace evaluation {

struct ContradictionOptions {
  // Submaps with a node this close in the sequence are not of another time.
  int min_node_gap = 40;
  // Rays are traced up to this distance before the return, metres.
  double ray_margin = 0.4;
  // Minimum number of rays for which the submap has data.
  int min_judged = 25;
  // A pair of scan and submap is in conflict above this share of rays.
  double conflict_fraction = 0.35;
  // Turns that headings are taken to be off by, at most, in standard deviations.
  double heading_sigmas = 2.;
  // Displacements of what a scan sees by such turns, metres: these are tried up
  // to the second, and not at all up to the first (cells count as occupied that
  // far from a wall, see MapContentsOptions).
  double precision = 0.15;
  double max_displacement = 0.5;
  double object_size = 1.;                 // metres
  double visit_distance = kVisitDistance;  // metres
  DistinctNodeOptions distinct;
  PathPieceOptions pieces;
};

// Result of one scan against one submap of another time.
struct ScanConflict {
  GraphId node_id;
  GraphId submap_id;
  int judged = 0;     // rays for which the submap has data
  int free_hits = 0;  // returns in free space
  int crossings = 0;  // rays through walls
  bool is_one_visit = false;
  bool is_distinct = true;  // the node, DistinctNodes
  double fraction() const {
    return judged == 0 ? 0.
                       : static_cast<double>(free_hits + crossings) / judged;
  }
};

// Result of one node against all submaps of other times.
struct NodeContradiction {
  GraphId node_id;
  io::TimeNs time = 0;
  int judged = 0;
  int contradicted = 0;
  double fraction = 0.;  // contradicted / judged
  // The submap that has data for most of the rays, and the one with the largest
  // share; undefined if nothing was judged.
  GraphId widest_submap_id;
  int widest_judged = 0;
  GraphId worst_submap_id;
  double worst_fraction = 0.;
  bool in_conflict = false;
  // At least one of the submaps is of another visit.
  bool is_revisit = false;
  bool is_distinct = true;  // DistinctNodes: it counts
};

struct Contradictions {
  std::vector<NodeContradiction> nodes;  // by id
  std::vector<ScanConflict> conflicts;   // pairs above the share, by node
  std::vector<PathPiece> pieces;  // in conflict with submaps of other visits
  // In conflict with submaps of the same visit.
  std::vector<PathPiece> passing_pieces;
  // Numbers of distinct nodes.
  int64_t distinct_nodes = 0;
  int64_t judged_nodes = 0;    // that see a place mapped at another time
  int64_t revisit_nodes = 0;   // of these, on another visit
  int64_t conflict_nodes = 0;  // in path pieces of another visit
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

// Holds a scan (in the frame of its node, metres) against a submap in whose
// local frame the pose of the node is given. Where it turns out that fewer than
// `min_judged` rays can be judged, only the ends of the rays are counted.
ScanConflict HoldAgainst(const std::vector<Eigen::Vector2d>& scan,
                         const Pose2& local_from_node, const SubmapCells& cells,
                         const ContradictionOptions& options);

Contradictions FindContradictions(const MapGraph& graph,
                                  const MapContents& contents,
                                  const ContradictionOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_SCAN_CONTRADICTION_H_
