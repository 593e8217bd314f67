// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/closed_prediction.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/loop_closure/consensus/candidate_edge.h"
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr double kFarSigmas = 3.;
// Of a prediction: what matches are off by anyway, metres and radians.
constexpr double kLeastTranslationSigma = 0.05;
constexpr double kLeastRotationSigma = 0.015;

}  // namespace

bool PredictAgain(const LoopOptions& options,
                  const uncertainty::PathUncertainty& paths,
                  const PathBetween& path_between,
                  LoopCandidate* const candidate) {
  if (candidate->is_inter_trajectory()) return false;
  const uncertainty::LoopEdge loop = CandidateEdge(options, paths, *candidate);
  if (!loop.a.is_node()) return false;
  const absl::optional<uncertainty::UncertainPose> path =
      path_between(loop.a, loop.b);
  if (!path.has_value()) return false;
  const double sigma = uncertainty::WorstTranslationSigma(path->covariance);
  if (sigma >=
      candidate->closed_sigma.value_or(candidate->plan.translation_sigma)) {
    return false;
  }
  const InnovationResult innovation = TestInnovation(
      options.innovation_veto.chi_square_bound, *path, loop.pose);
  if (innovation.vetoed) return false;
  candidate->closed_sigma = sigma;
  candidate->innovation = innovation;
  return true;
}

bool IsFarFromPrediction(const LoopCandidate& candidate) {
  if (!candidate.predicted.has_value() || candidate.plan.full_submap ||
      candidate.is_inter_trajectory()) {
    return false;
  }
  const Pose2 displacement =
      Between(*candidate.predicted, candidate.match.refined);
  return displacement.translation().norm() >
             kFarSigmas * std::max(candidate.plan.translation_sigma,
                                   kLeastTranslationSigma) ||
         std::abs(NormalizeAngle(displacement.theta)) >
             kFarSigmas *
                 std::max(candidate.plan.rotation_sigma, kLeastRotationSigma);
}

bool ContradictsPath(const LoopOptions& options,
                     const uncertainty::PathUncertainty& paths,
                     const PathBetween& path_between,
                     LoopCandidate* const candidate) {
  const uncertainty::LoopEdge loop = CandidateEdge(options, paths, *candidate);
  if (!loop.a.is_node()) return false;
  const absl::optional<uncertainty::UncertainPose> path =
      path_between(loop.a, loop.b);
  if (!path.has_value()) return false;
  const InnovationResult innovation = TestInnovation(
      options.compatible_subset.cycle.chi_square_bound, *path, loop.pose);
  if (!innovation.vetoed) return false;
  candidate->closed_sigma =
      uncertainty::WorstTranslationSigma(path->covariance);
  candidate->innovation = innovation;
  return true;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
