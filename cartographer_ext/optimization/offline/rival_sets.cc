// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/rival_sets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "Eigen/Cholesky"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/starts/windings.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr size_t kMaxSample = 50;

std::vector<bool> LoopsInForce(const std::vector<WhitenedEdge>& edges,
                               const std::vector<Pose2>& poses,
                               const double gate) {
  std::vector<bool> result(edges.size());
  for (size_t i = 0; i != edges.size(); ++i) {
    result[i] = edges[i].is_loop &&
                Chi2(edges[i], poses[edges[i].from], poses[edges[i].to]) < gate;
  }
  return result;
}

double LargestShift(const std::vector<Pose2>& a, const std::vector<Pose2>& b) {
  const Pose2 motion = Align(b, a);
  double result = 0.;
  for (size_t i = 0; i != a.size(); ++i) {
    result = std::max(
        result, (a[i].translation() - (motion * b[i]).translation()).norm());
  }
  return result;
}

// Whether the loops in force in both maps have the same winding there.
bool AreWoundAlike(const std::vector<WhitenedEdge>& edges,
                   const std::vector<bool>& ours,
                   const std::vector<bool>& theirs, const std::vector<Pose2>& a,
                   const std::vector<Pose2>& b) {
  std::vector<double> weights(edges.size());
  for (size_t i = 0; i != edges.size(); ++i) {
    weights[i] = !edges[i].is_loop || (ours[i] && theirs[i]) ? 1. : 0.;
  }
  return HaveSameWinding(edges, weights, a, b);
}

// By how many of its standard deviations a pose of `theirs` is off `ours`, at
// most.
double Deviation(const std::vector<Pose2>& ours,
                 const std::vector<Pose2>& theirs,
                 const std::vector<bool>& in_force,
                 RobustSolver* const solver) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  std::vector<double> weights(edges.size());
  for (size_t i = 0; i != edges.size(); ++i) {
    weights[i] = !edges[i].is_loop || in_force[i] ? 1. : 0.;
  }
  Eigen::VectorXd rhs;
  const BlockLdlt* const factor = solver->Factor(ours, weights, &rhs);
  if (factor == nullptr) return std::numeric_limits<double>::infinity();
  const Pose2 motion = ours[0] * theirs[0].Inverse();
  const auto shift = [&](const size_t i) -> Eigen::Vector2d {
    return (motion * theirs[i]).translation() - ours[i].translation();
  };
  std::vector<size_t> sample;
  const size_t count = std::min(kMaxSample, ours.size() - 1);
  for (size_t k = 1; k <= count; ++k) {
    sample.push_back(k * (ours.size() - 1) / count);
  }
  size_t largest = 1;
  for (size_t i = 1; i != ours.size(); ++i) {
    if (shift(i).norm() > shift(largest).norm()) largest = i;
  }
  sample.push_back(largest);
  double result = 0.;
  BlockLdlt::Columns columns;
  for (const size_t i : sample) {
    columns.setZero(rhs.size(), 3);
    columns.middleRows<3>(3 * i - 3).setIdentity();
    factor->Solve(&columns);
    const Eigen::Matrix2d covariance = columns.block<2, 2>(3 * i - 3, 0);
    result = std::max(result, shift(i).dot(covariance.llt().solve(shift(i))));
  }
  return std::sqrt(result);
}

}  // namespace

std::vector<RivalSets> FindRivalSets(
    const std::vector<Pose2>& poses,
    const std::vector<Alternative>& alternatives, const RivalOptions& options,
    RobustSolver* const solver) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  const double cost = TruncatedCost(edges, poses, options.gate);
  const std::vector<bool> ours = LoopsInForce(edges, poses, options.gate);
  const int num_ours = std::count(ours.begin(), ours.end(), true);
  const int min_loops = num_ours < 10 * options.min_loops
                            ? options.min_loops - 1
                            : options.min_loops;
  std::vector<RivalSets> result;
  std::set<std::pair<std::vector<int>, std::vector<int>>> seen;
  for (const Alternative& alternative : alternatives) {
    // Its own cost is that of the usual gate.
    const double their_cost =
        options.gate == kChi2Gate
            ? alternative.cost
            : TruncatedCost(edges, alternative.poses, options.gate);
    if (!alternative.is_likelier && their_cost > cost + options.gate) continue;
    const std::vector<bool> theirs =
        LoopsInForce(edges, alternative.poses, options.gate);
    RivalSets rival;
    for (size_t i = 0; i != edges.size(); ++i) {
      if (ours[i] && !theirs[i]) rival.only_in_force.push_back(i);
      if (theirs[i] && !ours[i]) rival.only_in_rival.push_back(i);
    }
    const bool is_near =
        !alternative.is_likelier &&
        static_cast<int>(std::min(rival.only_in_force.size(),
                                  rival.only_in_rival.size())) < min_loops;
    if ((is_near &&
         AreWoundAlike(edges, ours, theirs, poses, alternative.poses)) ||
        !seen.insert({rival.only_in_force, rival.only_in_rival}).second) {
      continue;
    }
    rival.is_likelier = alternative.is_likelier;
    rival.cost_difference = their_cost - cost;
    rival.largest_shift = LargestShift(poses, alternative.poses);
    if (rival.largest_shift > 0.) {
      rival.deviation = Deviation(poses, alternative.poses, ours, solver);
    }
    rival.moves_map = rival.largest_shift > options.same_place &&
                      rival.deviation > options.same_deviation;
    if (is_near && !rival.moves_map) continue;
    result.push_back(std::move(rival));
  }
  std::stable_sort(
      result.begin(), result.end(), [](const RivalSets& a, const RivalSets& b) {
        return std::make_tuple(!a.moves_map, !a.is_likelier,
                               a.cost_difference) <
               std::make_tuple(!b.moves_map, !b.is_likelier, b.cost_difference);
      });
  if (result.size() > options.max_rivals) result.resize(options.max_rivals);
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
