// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/loop_support.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "Eigen/Cholesky"
#include "Eigen/LU"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// A relative pose with the covariance of its error and the cosine and sine of
// its angle (uncertain_pose.h), which compositions would mostly go into.
struct Link {
  double x = 0.;
  double y = 0.;
  double theta = 0.;
  double cos = 1.;
  double sin = 0.;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

Link ToLink(const PoseGraphEdge& edge) {
  Link result;
  result.x = edge.measurement.x;
  result.y = edge.measurement.y;
  result.theta = edge.measurement.theta;
  result.cos = std::cos(result.theta);
  result.sin = std::sin(result.theta);
  result.covariance = edge.information.inverse();
  return result;
}

// Ad(z) C Ad(z)' for the pose of `z`, whose covariance is not used.
Eigen::Matrix3d Carried(const Eigen::Matrix3d& covariance, const Link& z) {
  Eigen::Matrix2d rotation;
  rotation << z.cos, -z.sin, z.sin, z.cos;
  const Eigen::Vector2d lever(z.y, -z.x);
  const double heading = covariance(2, 2);
  const Eigen::Vector2d turned = rotation * covariance.topRightCorner<2, 1>();
  const Eigen::Vector2d with_heading = turned + heading * lever;
  Eigen::Matrix3d result;
  result.topLeftCorner<2, 2>() =
      rotation * covariance.topLeftCorner<2, 2>() * rotation.transpose() +
      turned * lever.transpose() + lever * with_heading.transpose();
  result.topRightCorner<2, 1>() = with_heading;
  result.bottomLeftCorner<1, 2>() = with_heading.transpose();
  result(2, 2) = heading;
  return result;
}

// Pose only.
Link InversePose(const Link& z) {
  Link result;
  result.x = -z.cos * z.x - z.sin * z.y;
  result.y = z.sin * z.x - z.cos * z.y;
  result.theta = -z.theta;
  result.cos = z.cos;
  result.sin = -z.sin;
  return result;
}

Link Invert(const Link& z) {
  Link result = InversePose(z);
  result.covariance = Carried(z.covariance, z);
  return result;
}

Link Compose(const Link& lhs, const Link& rhs) {
  Link result;
  result.x = lhs.x + lhs.cos * rhs.x - lhs.sin * rhs.y;
  result.y = lhs.y + lhs.sin * rhs.x + lhs.cos * rhs.y;
  result.theta = NormalizeAngle(lhs.theta + rhs.theta);
  result.cos = lhs.cos * rhs.cos - lhs.sin * rhs.sin;
  result.sin = lhs.sin * rhs.cos + lhs.cos * rhs.sin;
  result.covariance =
      Carried(lhs.covariance, InversePose(rhs)) + rhs.covariance;
  return result;
}

// Paths from a pose to itself and to those after it, as far as needed.
struct Paths {
  int first = -1;
  std::vector<Link> known;
};

class Supporter {
 public:
  Supporter(const PoseGraph& graph, const LoopSupportOptions& options)
      : graph_(graph),
        options_(options),
        step_(graph.poses.size(), -1),
        paths_(std::max<size_t>(
            1, std::min<size_t>(options.max_paths, graph.poses.size()))) {
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
    VisitPairs([&](const int k, const int l) { Test(k, l); });
    MakeGroups();
    return std::move(result_);
  }

  std::vector<LoopCycle> Cycles() {
    std::vector<LoopCycle> result;
    VisitPairs([&](const int k, const int l) {
      Link late, early;
      if (!PathsBetween(k, l, &late, &early)) return;
      const Link cycle = Cycle(k, l, late, early);
      late.covariance.setZero();
      early.covariance.setZero();
      LoopCycle entry;
      entry.error = Eigen::Vector3d(cycle.x, cycle.y, cycle.theta);
      entry.of_loops = Cycle(k, l, late, early).covariance;
      entry.of_odometry = cycle.covariance - entry.of_loops;
      result.push_back(entry);
    });
    return result;
  }

 private:
  template <typename Visit>
  void VisitPairs(const Visit& visit) {
    result_.agreeing.resize(graph_.edges.size());
    std::stable_sort(loops_.begin(), loops_.end(),
                     [&](int i, int j) { return Early(i) < Early(j); });
    for (const int i : loops_) {
      early_.push_back(Early(i));
      late_.push_back(Late(i));
      links_.push_back(Loop(i));
      inverse_links_.push_back(Invert(links_.back()));
    }
    for (size_t k = 0; k != loops_.size(); ++k) {
      int tested = 0;
      for (size_t l = k + 1; l != loops_.size(); ++l) {
        if (early_[l] - early_[k] > options_.window) break;
        if (std::abs(late_[l] - late_[k]) > options_.window) continue;
        if (tested++ == options_.max_neighbours) break;
        visit(k, l);
      }
    }
  }

  int Early(const int i) const {
    return std::min(graph_.edges[i].from, graph_.edges[i].to);
  }
  int Late(const int i) const {
    return std::max(graph_.edges[i].from, graph_.edges[i].to);
  }

  // (early <- late).
  Link Loop(const int i) const {
    const Link loop = ToLink(graph_.edges[i]);
    return graph_.edges[i].from < graph_.edges[i].to ? loop : Invert(loop);
  }

  // (from <- to) along odometry; false where it is interrupted.
  bool Path(const int from, const int to, Link* const path) {
    const int first = std::min(from, to), length = std::abs(from - to);
    Paths& paths = paths_[first % paths_.size()];
    if (paths.first != first) {
      paths.first = first;
      paths.known.assign(1, Link());
    }
    while (static_cast<int>(paths.known.size()) <= length) {
      const int k = first + paths.known.size() - 1;
      if (step_[k] < 0) return false;
      const PoseGraphEdge& edge = graph_.edges[step_[k]];
      const Link step = ToLink(edge);
      paths.known.push_back(
          Compose(paths.known.back(), edge.from == k ? step : Invert(step)));
    }
    *path = from > to ? Invert(paths.known[length]) : paths.known[length];
    return true;
  }

  // The paths between the ends of the loops number k and l of loops_.
  bool PathsBetween(const int k, const int l, Link* const late,
                    Link* const early) {
    return Path(late_[k], late_[l], late) && Path(early_[l], early_[k], early);
  }

  Link Cycle(const int k, const int l, const Link& late,
             const Link& early) const {
    return Compose(Compose(Compose(links_[k], late), inverse_links_[l]), early);
  }

  // Whether the loops number k and l of loops_ agree.
  void Test(const int k, const int l) {
    const int i = loops_[k], j = loops_[l];
    Link path_late, path_early;
    if (!PathsBetween(k, l, &path_late, &path_early)) return;
    const Link cycle = Cycle(k, l, path_late, path_early);
    const Eigen::Vector3d error(cycle.x, cycle.y, cycle.theta);
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
  // By the number of their first pose modulo the size.
  std::vector<Paths> paths_;
  std::vector<int> loops_;
  std::vector<int> early_, late_;  // ends of loops_
  // (early <- late) of loops_, and (late <- early).
  std::vector<Link> links_, inverse_links_;
  LoopSupport result_;
};

}  // namespace

LoopSupport FindLoopSupport(const PoseGraph& graph,
                            const LoopSupportOptions& options) {
  return Supporter(graph, options).Run();
}

std::vector<LoopCycle> FindLoopCycles(const PoseGraph& graph,
                                      const LoopSupportOptions& options) {
  return Supporter(graph, options).Cycles();
}

}  // namespace optimization
}  // namespace cartographer_ext
