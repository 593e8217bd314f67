// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How much the innovation of a loop speaks for it: the likelihood ratio between
// a right loop and one that may lead anywhere in the map.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_LOOP_EVIDENCE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_LOOP_EVIDENCE_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

// Squared innovation of a loop and the size of its covariance.
struct Innovation {
  double chi2 = 0.;             // d2
  double log_determinant = 0.;  // of S
  // S, in whitened units; not set where nothing but its size is asked for.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// Logarithm of the area (square metres) that poses are spread over.
double LogArea(const std::vector<Pose2>& poses);

// Logarithm of the volume of all relative poses within an area, in whitened
// units of `edge`, over (2 pi)^(3/2): what a wrong loop's density is compared
// with.
double LogVolume(const WhitenedEdge& edge, double log_area);

// log N(r; 0, S) - log 1 / (2 pi A det W^-1) of a loop with this innovation.
double LogEvidence(const WhitenedEdge& edge, const Innovation& innovation,
                   double log_area);

// Probability that a loop which leads anywhere in the area has a chi2 below the
// gate, or a squared innovation if its covariance has this determinant.
double ChanceToFit(const WhitenedEdge& edge, double log_area, double gate,
                   double log_determinant = 0.);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_LOOP_EVIDENCE_H_
