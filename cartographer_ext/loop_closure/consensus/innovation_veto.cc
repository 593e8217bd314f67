// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/loop_closure/consensus/candidate_edge.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"

namespace cartographer_ext {
namespace loop_closure {

InnovationResult TestInnovation(const double chi_square_bound,
                                const uncertainty::UncertainPose& prior,
                                const uncertainty::UncertainPose& loop) {
  // The cycle test with certain, empty paths asks the same.
  uncertainty::CycleConsistencyOptions cycle;
  cycle.test = uncertainty::CycleTest::kChiSquare;
  cycle.chi_square_bound = chi_square_bound;
  const uncertainty::CycleResult test =
      uncertainty::TestCycle(cycle, Invert(prior), uncertainty::UncertainPose(),
                             Invert(loop), uncertainty::UncertainPose());
  InnovationResult result;
  result.innovation = test.error;
  result.chi_square = test.chi_square;
  result.bound = chi_square_bound;
  result.vetoed = !test.compatible;
  result.covariance = test.covariance;
  result.translation_sigma =
      uncertainty::WorstTranslationSigma(test.covariance);
  result.rotation_sigma = std::sqrt(std::max(0., test.covariance(2, 2)));
  return result;
}

absl::optional<InnovationResult> InnovationByPath(
    const LoopOptions& options, const uncertainty::PathUncertainty& paths,
    const LoopCandidate& candidate) {
  if (candidate.is_inter_trajectory()) return absl::nullopt;
  uncertainty::LoopEdge loop = CandidateEdge(options, paths, candidate);
  if (!loop.a.is_node()) {
    const absl::optional<uncertainty::NodeId> nearest =
        paths.Nearest(candidate.submap.trajectory_id,
                      candidate.submap_local_pose.translation());
    if (!nearest.has_value()) return absl::nullopt;
    loop.a = *nearest;
    loop.pose.pose = candidate.RefinedFromAnchor(*paths.LocalPose(*nearest));
  }
  const absl::optional<uncertainty::UncertainPose> prior =
      paths.Between(loop.a, loop.b);
  if (!prior.has_value()) return absl::nullopt;
  return TestInnovation(options.innovation_veto.chi_square_bound, *prior,
                        loop.pose);
}

void VetoByInnovation(const LoopOptions& options,
                      const uncertainty::PathUncertainty& paths,
                      LoopCandidate* const candidate) {
  if (!options.innovation_veto.enabled) return;
  const absl::optional<InnovationResult> innovation =
      InnovationByPath(options, paths, *candidate);
  if (!innovation.has_value()) return;
  candidate->innovation = innovation;
  if (innovation->vetoed) {
    candidate->Reject(proto::LoopDecision::INNOVATION_TOO_LARGE);
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
