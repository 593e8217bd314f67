// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Windings. A loop measures a heading up to whole turns. Where odometry between its
// ends has turned by an uncertain angle, it may be off by one, and each choice is a
// local minimum of its own, which no descent leaves: with too many turns a ring
// becomes an eight. For chosen turns the headings are a linear problem, so that all
// choices that are likely can be listed (Carlone and Censi, "From angular manifolds
// to the integer lattice", 2014). With d the heading by which odometry misses each
// loop and C the covariance of that, turns k of the loops cost at least
//
//   (d + 2 pi k)' C^-1 (d + 2 pi k),
//
// whatever the positions are. Triangular factors of C give that sum loop by loop,
// so that turns are chosen in turn, the cheapest choices being kept.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_STARTS_WINDINGS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_STARTS_WINDINGS_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

// Whole turns that are added to the error of each edge at given poses, and the least
// chi2 of a map with them.
struct Winding {
  std::vector<int> turns;
  double chi2 = 0.;
};

struct WindingOptions {
  // What a map may cost. No winding that costs less is left out but for the limits
  // below.
  double max_chi2 = 0.;
  int max_windings = 30;
  // Choices that are kept while the turns of the loops are chosen one by one, and
  // loops for which they are chosen, evenly thinned. Those of the others follow.
  int max_choices = 100;
  int max_loops = 200;
};

// Other windings of the edges in force than that of the poses, the cheapest first.
// `weights` has one entry per edge, more than a half for those in force, which are
// all odometry and have to determine the headings; none otherwise.
std::vector<Winding> FindWindings(const std::vector<WhitenedEdge>& edges,
                                  const std::vector<double>& weights,
                                  const std::vector<Pose2>& poses,
                                  const WindingOptions& options);

// Whether the edges in force have the same winding in two maps.
bool HaveSameWinding(const std::vector<WhitenedEdge>& edges,
                     const std::vector<double>& weights,
                     const std::vector<Pose2>& a, const std::vector<Pose2>& b);

// The poses of a winding with regard to `poses`: the headings by least squares, then
// the positions. False, without effect, if they are not determined.
bool Rewind(const std::vector<WhitenedEdge>& edges,
            const std::vector<double>& weights, const std::vector<int>& turns,
            std::vector<Pose2>* poses);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_STARTS_WINDINGS_H_
