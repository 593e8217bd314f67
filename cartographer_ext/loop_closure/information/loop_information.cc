// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/information/loop_information.h"

#include "Eigen/LU"
#include "cartographer_ext/common/planar_matrix.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// No match is less certain than this, metres and radians: even along a corridor
// the scan sees doors.
constexpr double kLeastCertainTranslation = 0.3;
constexpr double kLeastCertainRotation = 0.1;

// What the match does not observe; frame of the submap. Zero where nothing is
// known about it.
Eigen::Matrix3d UnobservableCovariance(const SearchMatch& match) {
  if (match.information.isZero(0.) || !match.information.allFinite()) {
    return Eigen::Matrix3d::Zero();
  }
  const Eigen::Vector3d least(
      1. / (kLeastCertainTranslation * kLeastCertainTranslation),
      1. / (kLeastCertainTranslation * kLeastCertainTranslation),
      1. / (kLeastCertainRotation * kLeastCertainRotation));
  Eigen::Matrix3d information = match.information;
  information.diagonal() += least;
  return information.inverse();
}

}  // namespace

Eigen::Matrix3d MatchCovariance(const LoopOptions& options,
                                const LoopCandidate& candidate) {
  const Eigen::Matrix3d rotation =
      PlanarRotation(candidate.RefinedInTrackingFrame().theta);
  return LoopCovariance(options) + rotation.transpose() *
                                       UnobservableCovariance(candidate.match) *
                                       rotation;
}

void WeighConstraint(const LoopOptions& options,
                     const ConstraintWeights& stock_weights,
                     LoopCandidate* const candidate) {
  candidate->weights =
      options.information.enabled
          ? ConfidenceWeights(options.information, stock_weights,
                              candidate->FinalScore())
          : stock_weights;
  if (!options.information.full_matrix ||
      candidate->match.information.isZero(0.)) {
    return;
  }
  const Eigen::Matrix3d certain = LoopCovariance(options);
  candidate->full_information =
      FullInformation(*candidate->weights, certain,
                      certain + UnobservableCovariance(candidate->match));
}

}  // namespace loop_closure
}  // namespace cartographer_ext
