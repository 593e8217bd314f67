// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/rival_sets.h"

#include <algorithm>
#include <set>
#include <utility>

#include "cartographer_ext/optimization/offline/graph_metrics.h"

namespace cartographer_ext {
namespace optimization {
namespace {

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

}  // namespace

std::vector<RivalSets> FindRivalSets(
    const std::vector<WhitenedEdge>& edges, const std::vector<Pose2>& poses,
    const double cost, const std::vector<Alternative>& alternatives,
    const RivalOptions& options) {
  const std::vector<bool> ours = LoopsInForce(edges, poses, options.gate);
  const int num_ours = std::count(ours.begin(), ours.end(), true);
  const int min_loops = num_ours < 10 * options.min_loops
                            ? options.min_loops - 1
                            : options.min_loops;
  std::vector<RivalSets> result;
  std::set<std::pair<std::vector<int>, std::vector<int>>> seen;
  for (const Alternative& alternative : alternatives) {
    if (alternative.cost > cost + options.gate) continue;
    const std::vector<bool> theirs =
        LoopsInForce(edges, alternative.poses, options.gate);
    RivalSets rival;
    for (size_t i = 0; i != edges.size(); ++i) {
      if (ours[i] && !theirs[i]) rival.only_in_force.push_back(i);
      if (theirs[i] && !ours[i]) rival.only_in_rival.push_back(i);
    }
    if (static_cast<int>(std::min(rival.only_in_force.size(),
                                  rival.only_in_rival.size())) < min_loops ||
        !seen.insert({rival.only_in_force, rival.only_in_rival}).second) {
      continue;
    }
    rival.cost_difference = alternative.cost - cost;
    rival.largest_shift = LargestShift(poses, alternative.poses);
    result.push_back(std::move(rival));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const RivalSets& a, const RivalSets& b) {
                     return a.cost_difference < b.cost_difference;
                   });
  if (result.size() > options.max_rivals) result.resize(options.max_rivals);
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
