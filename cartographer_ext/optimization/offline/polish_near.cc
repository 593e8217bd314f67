// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/polish_near.h"

#include <cmath>
#include <utility>

#include "cartographer_ext/common/thread_time.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Information of a tie as a share of that of the positions of a typical edge.
constexpr double kStrongest = 1e2;
constexpr double kWeaker = 0.2;
constexpr int kNumStrengths = 15;
constexpr int kRounds = 30;

double MeanInformation(const std::vector<WhitenedEdge>& edges) {
  double sum = 0.;
  for (const WhitenedEdge& edge : edges) {
    sum += 0.5 * edge.whitening.leftCols<2>().squaredNorm();
  }
  return edges.empty() ? 0. : sum / edges.size();
}

}  // namespace

SolverSummary PolishNear(const std::vector<WhitenedEdge>& edges,
                         const std::vector<Pose2>& target, const double limit,
                         std::vector<Pose2>* const poses,
                         std::vector<double>* const weights) {
  CHECK_EQ(target.size(), poses->size());
  const double start = ThreadCpuSeconds();
  SolverSummary total;
  total.final_cost = TruncatedCost(edges, *poses);
  std::vector<WhitenedEdge> tied = edges;
  // To the first pose, which is held, so that the ties need no fill.
  for (size_t i = 1; i < target.size(); ++i) {
    WhitenedEdge tie;
    tie.from = 0;
    tie.to = i;
    const Pose2 place = Between(target[0], target[i]);
    tie.measurement << place.x, place.y, place.theta;
    tied.push_back(tie);
  }
  const double information = MeanInformation(edges);
  RobustSolver solver(tied);
  // The strongest ties within the limit, by bisection: stronger ones cost more.
  const std::vector<Pose2> start_poses = *poses;
  int first = 0, last = kNumStrengths;
  while (first != last) {
    const int middle = (first + last) / 2;
    const double share = kStrongest * std::pow(kWeaker, middle);
    const double strength = std::sqrt(share * information);
    for (size_t i = edges.size(); i != tied.size(); ++i) {
      tied[i].whitening = Eigen::Vector3d(strength, strength, 0.).asDiagonal();
    }
    std::vector<Pose2> tried = start_poses;
    std::vector<double> decisions;
    const SolverSummary summary =
        PolishTruncated(kChi2Gate, kRounds, &solver, &tried, &decisions);
    total.iterations += summary.iterations;
    total.analyses += summary.analyses;
    total.factor_blocks = summary.factor_blocks;
    const double cost = TruncatedCost(edges, tried);
    if (!(cost <= limit)) {
      first = middle + 1;
      continue;
    }
    last = middle;
    total.final_cost = cost;
    total.converged = summary.converged;
    *poses = std::move(tried);
    if (weights != nullptr) {
      decisions.resize(edges.size());
      *weights = std::move(decisions);
    }
  }
  total.cpu_seconds = ThreadCpuSeconds() - start;
  return total;
}

}  // namespace optimization
}  // namespace cartographer_ext
