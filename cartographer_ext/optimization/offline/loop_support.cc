// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/loop_support.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "Eigen/Cholesky"
#include "Eigen/LU"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using uncertainty::Compose;
using uncertainty::Invert;
using uncertainty::UncertainPose;

UncertainPose ToUncertainPose(const PoseGraphEdge& edge) {
  return {edge.measurement, edge.information.inverse()};
}

class Supporter {
 public:
  Supporter(const PoseGraph& graph, const LoopSupportOptions& options)
      : graph_(graph),
        options_(options),
        step_(graph.poses.size(), -1),
        paths_(graph.poses.size()) {
    for (size_t i = 0; i != graph.edges.size(); ++i) {
      const PoseGraphEdge& edge = graph.edges[i];
      if (edge.is_loop) {
        loops_.push_back(i);
      } else if (std::abs(edge.from - edge.to) == 1) {
        step_[std::min(edge.from, edge.to)] = i;
      }
    }
  }

  LoopSupport Run() {
    result_.agreeing.resize(graph_.edges.size());
    std::stable_sort(loops_.begin(), loops_.end(),
                     [&](int i, int j) { return Early(i) < Early(j); });
    for (const int i : loops_) loop_poses_.push_back(Loop(i));
    for (size_t k = 0; k != loops_.size(); ++k) {
      int tested = 0;
      for (size_t l = k + 1; l != loops_.size(); ++l) {
        if (Early(loops_[l]) - Early(loops_[k]) > options_.window) break;
        if (std::abs(Late(loops_[l]) - Late(loops_[k])) > options_.window) {
          continue;
        }
        if (tested++ == options_.max_neighbours) break;
        Test(k, l);
      }
    }
    MakeGroups();
    return std::move(result_);
  }

 private:
  int Early(const int i) const {
    return std::min(graph_.edges[i].from, graph_.edges[i].to);
  }
  int Late(const int i) const {
    return std::max(graph_.edges[i].from, graph_.edges[i].to);
  }

  // (early <- late).
  UncertainPose Loop(const int i) const {
    const UncertainPose loop = ToUncertainPose(graph_.edges[i]);
    return graph_.edges[i].from < graph_.edges[i].to ? loop : Invert(loop);
  }

  // (from <- to) along odometry; false where it is interrupted.
  bool Path(const int from, const int to, UncertainPose* const path) {
    const int first = std::min(from, to), length = std::abs(from - to);
    std::vector<UncertainPose>& known = paths_[first];
    if (known.empty()) known.push_back(UncertainPose());
    while (static_cast<int>(known.size()) <= length) {
      const int k = first + known.size() - 1;
      if (step_[k] < 0) return false;
      const PoseGraphEdge& edge = graph_.edges[step_[k]];
      const UncertainPose step = ToUncertainPose(edge);
      known.push_back(
          Compose(known.back(), edge.from == k ? step : Invert(step)));
    }
    *path = from > to ? Invert(known[length]) : known[length];
    return true;
  }

  // Whether the loops number k and l of loops_ agree.
  void Test(const int k, const int l) {
    const int i = loops_[k], j = loops_[l];
    UncertainPose path_late, path_early;
    if (!Path(Late(i), Late(j), &path_late) ||
        !Path(Early(j), Early(i), &path_early)) {
      return;
    }
    const UncertainPose cycle = Compose(
        Compose(Compose(loop_poses_[k], path_late), Invert(loop_poses_[l])),
        path_early);
    const Eigen::Vector3d error(cycle.pose.x, cycle.pose.y, cycle.pose.theta);
    const double chi2 = error.dot(cycle.covariance.llt().solve(error));
    result_.cycle_chi2.push_back(chi2);
    if (!(chi2 < options_.gate)) return;
    result_.agreeing[i].push_back(j);
    result_.agreeing[j].push_back(i);
  }

  void MakeGroups() {
    result_.group.assign(graph_.edges.size(), -1);
    for (const int first : loops_) {
      if (result_.group[first] >= 0) continue;
      std::vector<int> members = {first};
      result_.group[first] = result_.groups.size();
      for (size_t next = 0; next != members.size(); ++next) {
        for (const int other : result_.agreeing[members[next]]) {
          if (result_.group[other] >= 0) continue;
          result_.group[other] = result_.groups.size();
          members.push_back(other);
        }
      }
      std::sort(members.begin(), members.end());
      result_.groups.push_back(std::move(members));
    }
  }

  const PoseGraph& graph_;
  const LoopSupportOptions options_;
  std::vector<int> step_;  // odometry edge between pose k and pose k + 1, or -1
  // Paths from each pose to itself and to those after it, as far as needed.
  std::vector<std::vector<UncertainPose>> paths_;
  std::vector<int> loops_;
  std::vector<UncertainPose> loop_poses_;  // (early <- late) of loops_
  LoopSupport result_;
};

}  // namespace

LoopSupport FindLoopSupport(const PoseGraph& graph,
                            const LoopSupportOptions& options) {
  return Supporter(graph, options).Run();
}

}  // namespace optimization
}  // namespace cartographer_ext
