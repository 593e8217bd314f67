// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise/map_evidence.h"

#include <cmath>
#include <limits>
#include <set>

#include "Eigen/LU"
#include "cartographer_ext/optimization/solvers/loop_evidence.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// What a wrong loop is expected to lose where another one of its group predicts it as
// well as it is measured: half of chi2, and of log det 2 I.
const double kOfFollower = 1.5 + 1.5 * std::log(2.);
}  // namespace

double LogEvidenceOfMap(const DecidedMap& map, const LoopSupport& support,
                        const std::vector<WhitenedEdge>& given,
                        const double log_area, RobustSolver* const solver) {
  const std::vector<Pose2>& poses = map.poses;
  const std::vector<double>& decisions = map.decisions;
  Eigen::VectorXd rhs;
  const BlockLdlt* const factor = solver->Factor(poses, decisions, &rhs);
  if (factor == nullptr) return -std::numeric_limits<double>::infinity();
  double result = 0.;
  for (int i = 0; i != factor->size(); ++i) {
    result -= 0.5 * std::log(factor->pivot(i).determinant());
  }
  std::set<Part> wrong;
  const std::vector<WhitenedEdge>& edges = solver->edges();
  for (size_t i = 0; i != edges.size(); ++i) {
    const WhitenedEdge& edge = edges[i];
    if (decisions[i] <= 0.5) {
      if (!wrong.insert(PartOf(edge, support.group[i])).second) {
        result += LogVolume(given[i], log_area) - kOfFollower;
      }
      continue;
    }
    result +=
        (edge.is_loop ? LogVolume(edge, log_area)
                      : std::log(std::abs(edge.whitening.determinant()))) -
        0.5 * Chi2(edge, poses[edge.from], poses[edge.to]);
  }
  return result;
}

double LogPriorOfDecisions(const std::vector<double>& decisions,
                           const LoopSupport& support,
                           const std::vector<WhitenedEdge>& edges) {
  std::set<Part> right, wrong;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!edges[i].is_loop) continue;
    (decisions[i] > 0.5 ? right : wrong)
        .insert(PartOf(edges[i], support.group[i]));
  }
  const double all = right.size() + wrong.size();
  double result = 0.;
  for (const size_t parts : {right.size(), wrong.size()}) {
    if (parts > 0) result += parts * std::log(parts / all);
  }
  return result;
}

double LogPosteriorOfMap(const DecidedMap& map, const LoopSupport& support,
                         const std::vector<WhitenedEdge>& edges,
                         const double log_area, RobustSolver* const solver) {
  return LogEvidenceOfMap(map, support, edges, log_area, solver) +
         LogPriorOfDecisions(map.decisions, support, edges);
}

}  // namespace optimization
}  // namespace cartographer_ext
