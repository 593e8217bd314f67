// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How likely a map and a noise are together. Truncated costs with different noise
// cannot be compared; densities can.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_MAP_EVIDENCE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_MAP_EVIDENCE_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/loop_support.h"
#include "cartographer_ext/optimization/offline/noise/loops_by_chance.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// The logarithm of the density of all measurements in a map, integrated over its
// poses (Laplace) and up to a constant: with H and chi2 of the edges in force and W
// the covariance of each,
//
//   - (chi2 + log det H) / 2 - sum over odometry (log det W) / 2
//   + sum over loops in force log V,
//
// where V is the volume of all relative poses (LogVolume): a wrong loop leads
// anywhere. Others of its group follow it with the noise of the `given` edges, which
// that of right loops says nothing about.
double LogEvidenceOfMap(const DecidedMap& map, const LoopSupport& support,
                        const std::vector<WhitenedEdge>& given, double log_area,
                        RobustSolver* solver);

// The logarithm of the probability of the decisions: all groups of loops are right with
// one and the same probability, that which makes the decisions likeliest. Where most are
// in force a rejected one is less likely wrong, and where hardly any is, one in force is
// less likely right.
double LogPriorOfDecisions(const std::vector<double>& decisions,
                           const LoopSupport& support,
                           const std::vector<WhitenedEdge>& edges);

// The sum of both, for edges with the noise that is given.
double LogPosteriorOfMap(const DecidedMap& map, const LoopSupport& support,
                         const std::vector<WhitenedEdge>& edges,
                         double log_area, RobustSolver* solver);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_MAP_EVIDENCE_H_
