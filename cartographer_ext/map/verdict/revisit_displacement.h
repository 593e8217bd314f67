// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How far the scans of a revisit lie from where they fit. A map that is off by
// less than a metre hardly contradicts itself: along a smooth corridor only the
// few returns of doors and corners tell. So each scan is shifted and turned on
// the submap of another time that it overlaps most, and the shares of returns
// that meet walls are averaged over consecutive nodes for each shift in the map
// frame. The displacement is the smallest shift that fits as well as the best:
// where the path does not tell (along a blank corridor), it is zero.
//
// An agreeing node, as a loop, also ties its submap to itself, and all that was
// driven between the two. Where nothing ties a step of the path, nothing tells
// whether what was driven before and after it is in place.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_REVISIT_DISPLACEMENT_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_REVISIT_DISPLACEMENT_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/path_piece.h"
#include "cartographer_ext/map/verdict/scan_contradiction.h"

namespace cartographer_ext {
namespace evaluation {

struct DisplacementOptions {
  double window = 0.8;                   // metres each way
  double step = 0.1;                     // metres
  double angular_window = DegToRad(4.);  // radians each way
  int num_rotations = 3;                 // each way
  // A return this close to an occupied cell meets a wall, metres.
  double tolerance = 0.1;
  int max_points = 60;  // of a scan
  // Of the nodes that see a place again every second is looked at, and so many
  // of them together (fewer where fewer see it); no more than twice the stride
  // apart. In large maps the stride is larger, for no more than `max_nodes`.
  int stride = 2;
  int max_nodes = 1000;
  int nodes_together = 5;
  // Shifts fit as well as the best if their share of returns is at most so much
  // smaller.
  double equal_share = 0.03;
  // If the best share is smaller, the place has changed or hardly overlaps.
  double min_share = 0.5;
  // Nodes that lie farther from where they fit are displaced, metres.
  double limit = 0.2;
  // So many agreeing nodes (of those looked at) and loops tie a step of the path;
  // fewer in small maps: a tenth of the nodes looked at, but at least one.
  int min_ties = 10;
  // A path no longer than this needs no ties, metres.
  double free_length = 50.;
  PathPieceOptions pieces{3, 8};
};

struct NodeDisplacement {
  GraphId node_id;
  GraphId submap_id;
  bool is_judged = false;
  double displacement = 0.;  // metres
  bool is_distinct = true;   // DistinctNodes: it counts
};

// A node whose scan agrees with a submap of another time.
struct RevisitTie {
  GraphId node_id;
  // The inserted node of the submap that places it.
  GraphId anchor_id;
  // What the scan tells about the position of the node, in the map frame, 1 /
  // square metres: nothing along a blank corridor.
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
};

struct RevisitDisplacements {
  std::vector<NodeDisplacement> nodes;  // that were looked at, by id
  int judged_nodes = 0;                 // distinct ones
  int displaced_nodes = 0;              // of these
  std::vector<PathPiece> pieces;        // displaced
  std::vector<RevisitTie> ties;         // by node
  // Nodes of the largest part of the path that is tied together, of all nodes.
  double tied_share = 0.;
  double displaced_share() const {
    return judged_nodes == 0
               ? 0.
               : static_cast<double>(displaced_nodes) / judged_nodes;
  }
};

// `contradictions` of the same map.
RevisitDisplacements FindDisplacements(const MapGraph& graph,
                                       const MapContents& contents,
                                       const Contradictions& contradictions,
                                       const DisplacementOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_REVISIT_DISPLACEMENT_H_
