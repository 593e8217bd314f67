// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Places of the path that may lie elsewhere without the map showing it. A map
// contradicts itself only where two visits overlap in it. If half of the visits
// to a place are drawn twenty metres beside it, in space that nothing else
// covers, what is left agrees. Nothing but the drift of local SLAM tells then
// where those visits belong.
//
// So the errors of the poses of the nodes are taken to be Gaussian. They are
// fixed against each other by the steps of local SLAM, with its usual noise
// (path_uncertainty.h), and by ties, nodes whose scan agrees with a submap of
// another time, with the information of that scan (revisit_displacement.h). With e
// an error in the frame of its node (uncertain_pose.h), C the covariance of a step
// or a tie (a <- b), and A the adjoint of (b <- a), the information matrix is the
// sum of those of
//
//   e_b - A e_a ~ N(0, C).
//
// A tie counts where the robot has come back in between: on a straight way a scan
// agrees with what was seen a little earlier because local SLAM has aligned both.
// Its inverse gives the covariance of the relative pose of any two nodes. Of two
// places it is not known how they lie to each other if the standard deviation of
// their relative position is above `limit`, and they are within reach: no farther
// apart in the map than `sigmas` of it. Loose are the fewest places without which
// that is known of all others: if nothing ties a wing to a building, the smaller
// one of the two.
//
// Loops are not used: a wrong one would fix what it has put there. Where it is
// right, scans agree. Nor does it help where scans agree in the wrong place.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_LOOSE_PLACES_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_LOOSE_PLACES_H_

#include <string>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/placed_submaps.h"
#include "cartographer_ext/map/verdict/revisit_displacement.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace evaluation {

struct LoosePlaceOptions {
  uncertainty::PathNoiseOptions noise;  // of local SLAM
  double tie_rotation = 0.03;           // of a tie, radians
  // Half of the half metre beyond which a map is broken.
  double limit = 0.25;  // metres
  double sigmas = 2.;
  // Two places this close are visits of one.
  double visit_distance = kVisitDistance;  // metres
  // Indices of nodes; places closer in the sequence are one visit.
  int min_node_gap = 40;
  // Evenly along the path, but no closer than `min_spacing` metres.
  int max_places = 150;
  double min_spacing = 0.5;
};

// `other_id`: the place that is the most within its reach.
struct LoosePlace {
  GraphId node_id;
  GraphId other_id;
  double sigma = 0.;     // standard deviation in the worst direction, metres
  double distance = 0.;  // in the map, metres
};

struct LoosePlaces {
  std::vector<LoosePlace> places;  // by node
  int looked_at = 0;
  double share() const {
    return looked_at == 0 ? 0. : static_cast<double>(places.size()) / looked_at;
  }
};

// Such as "7.5 % of the path may lie elsewhere without contradicting anything".
std::string DescribeLooseShare(double share);

LoosePlaces FindLoosePlaces(const MapGraph& graph,
                            const std::vector<RevisitTie>& ties,
                            const LoosePlaceOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_LOOSE_PLACES_H_
