// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Sharpness of the walls of a map, from the returns of all scans, without
// ground truth:
//
// * mean map entropy (Droeschel et al., Razlaw et al., "Evaluation of
//   registration methods for sparse 3D laser scans", 2015): the mean over all
//   returns q of h(q) = 1/2 ln |2 pi e S(q)|, where S(q) is the covariance of
//   the returns within a radius of q. Smaller is sharper.
// * wall thickness: where these returns lie along a line, twice the standard
//   deviation across it, which is the root of the smaller eigenvalue of S.
//
// Both depend on the place (bushes are thicker than walls). The thickness from
// returns of a single visit reflects the place and the laser; additional
// thickness in the map is the doubling of walls by inconsistent visits.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_MAP_SHARPNESS_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_MAP_SHARPNESS_H_

#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/metrics/statistics.h"

namespace cartographer_ext {
namespace evaluation {

struct SharpnessOptions {
  double radius = 0.3;  // metres
  int min_neighbours = 10;
  // Nodes this close in the sequence are one visit.
  int visit_nodes = 40;
  // Number of returns that are evaluated, evenly sampled.
  int64_t max_samples = 20000;
  // Number of returns kept as neighbours, evenly sampled.
  int64_t max_points = 400000;
  // Minimum ratio of the eigenvalues of a line.
  double min_elongation = 4.;
};

struct Sharpness {
  int64_t samples = 0;
  double mean_entropy = 0.;  // nats
  // Twice the standard deviation across walls, metres.
  Statistics wall_thickness;
  // The same for single visits, at the places with several visits.
  Statistics single_visit_thickness;
  Statistics revisited_thickness;  // at the same places, all visits
  // Mean ratio of the two; 1 if no place was visited twice.
  double doubling = 1.;
};

Sharpness ComputeSharpness(const MapGraph& graph, const MapContents& contents,
                           const SharpnessOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_MAP_SHARPNESS_H_
