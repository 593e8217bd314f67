// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/loop_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <utility>

namespace cartographer_ext {
namespace evaluation {
namespace {

// A piece of time in which the robot is where it was before.
struct Revisit {
  io::TimeNs begin = 0;
  io::TimeNs end = 0;
  bool closed = false;
};

// What the loop constraints are compared with: (a <- b) at two stamps.
struct TrueRelation {
  io::TimeNs time_a = 0;  // while the submap was built
  io::TimeNs time_b = 0;  // near the node
  Pose2 a_from_b;
};

// The parts of a graph that judging needs, prepared once.
class Judge {
 public:
  explicit Judge(const MapGraph& graph)
      : graph_(graph), inserted_(graph.InsertedNodes()) {
    for (const auto& entry : graph.nodes) {
      const int trajectory_id = entry.first.trajectory_id;
      if (local_.count(trajectory_id) == 0) {
        local_.emplace(trajectory_id, graph.LocalTrajectory(trajectory_id));
      }
    }
  }

  const MapGraph& graph() const { return graph_; }

  // Nodes inserted in the submap, in order; empty where there are none.
  const std::vector<GraphId>& Inserted(const GraphId& submap_id) const {
    static const std::vector<GraphId>* const kNone = new std::vector<GraphId>;
    const auto it = inserted_.find(submap_id);
    return it == inserted_.end() ? *kNone : it->second;
  }

  // Largest distance in time between the node and those of the submap.
  io::TimeNs TimeGap(const GraphConstraint& constraint) const {
    const io::TimeNs time = graph_.nodes.at(constraint.node_id).time;
    io::TimeNs gap = 0;
    for (const GraphId& id : Inserted(constraint.submap_id)) {
      gap = std::max<io::TimeNs>(gap,
                                 std::llabs(time - graph_.nodes.at(id).time));
    }
    return gap;
  }

  // Where the loop puts b, seen from a.
  absl::optional<Pose2> Claim(const GraphConstraint& constraint,
                              const io::TimeNs time_a,
                              const io::TimeNs time_b) const {
    const auto& submap = graph_.submaps.at(constraint.submap_id);
    const auto& node = graph_.nodes.at(constraint.node_id);
    const auto local_a = LocalPose(constraint.submap_id.trajectory_id, time_a);
    const auto local_b = LocalPose(constraint.node_id.trajectory_id, time_b);
    if (!local_a.has_value() || !local_b.has_value()) return absl::nullopt;
    const Pose2 submap_from_a = Between(submap.local_pose, *local_a);
    const Pose2 node_from_b = Between(node.local_pose, *local_b);
    return Between(submap_from_a, constraint.relative_pose * node_from_b);
  }

 private:
  absl::optional<Pose2> LocalPose(const int trajectory_id,
                                  const io::TimeNs time) const {
    const auto it = local_.find(trajectory_id);
    if (it == local_.end()) return absl::nullopt;
    const auto pose = it->second.Lookup(time, 0);
    if (!pose.has_value()) return absl::nullopt;
    return ToPose2(*pose);
  }

  const MapGraph& graph_;
  const std::map<GraphId, std::vector<GraphId>> inserted_;
  std::map<int, Trajectory> local_;
};

bool Resolvable(const MapGraph& graph, const GraphConstraint& constraint) {
  return graph.submaps.count(constraint.submap_id) > 0 &&
         graph.nodes.count(constraint.node_id) > 0;
}

// Merges stamps (sorted) into pieces.
std::vector<Revisit> MergeRevisits(const std::vector<io::TimeNs>& times,
                                   const io::TimeNs longest_break) {
  std::vector<Revisit> revisits;
  for (const io::TimeNs time : times) {
    if (revisits.empty() || time - revisits.back().end > longest_break) {
      revisits.push_back({time, time, false});
    } else {
      revisits.back().end = time;
    }
  }
  return revisits;
}

// Runs over the loops; `truth` gives an optional TrueRelation for each.
template <typename Truth>
LoopStatistics Compute(const Judge& judge, const Truth& truth,
                       std::vector<Revisit> revisits,
                       const LoopStatisticsOptions& options) {
  const MapGraph& graph = judge.graph();
  LoopStatistics result;
  std::vector<double> residual_translation, residual_rotation;
  for (size_t i = 0; i < graph.constraints.size(); ++i) {
    const GraphConstraint& constraint = graph.constraints[i];
    if (!constraint.is_loop || !Resolvable(graph, constraint)) continue;
    ++result.accepted;
    const GraphNode& node = graph.nodes.at(constraint.node_id);
    const Pose2 residual =
        Residual(constraint, graph.submaps.at(constraint.submap_id), node);
    LoopJudgement judgement;
    judgement.constraint = i;
    judgement.residual_translation = residual.translation().norm();
    judgement.residual_rotation = std::abs(residual.theta);
    residual_translation.push_back(judgement.residual_translation);
    residual_rotation.push_back(RadToDeg(judgement.residual_rotation));

    const absl::optional<TrueRelation> expected = truth(constraint);
    absl::optional<Pose2> claim;
    if (expected.has_value()) {
      claim = judge.Claim(constraint, expected->time_a, expected->time_b);
    }
    if (claim.has_value()) {
      const Pose2 error = Between(expected->a_from_b, *claim);
      judgement.translation_error = error.translation().norm();
      judgement.rotation_error = std::abs(error.theta);
      const bool correct =
          judgement.translation_error <= options.correct_translation &&
          judgement.rotation_error <= options.correct_rotation;
      judgement.verdict = correct ? LoopVerdict::kCorrect : LoopVerdict::kWrong;
      ++result.judged;
      if (correct) {
        ++result.correct;
        if (judge.TimeGap(constraint) > options.loop_time_gap) {
          for (Revisit& revisit : revisits) {
            if (node.time >= revisit.begin - options.bridge &&
                node.time <= revisit.end + options.bridge) {
              revisit.closed = true;
            }
          }
        }
      }
    }
    result.loops.push_back(judgement);
  }
  result.residual_translation = ComputeStatistics(residual_translation);
  result.residual_rotation_degrees = ComputeStatistics(residual_rotation);
  result.revisits = static_cast<int64_t>(revisits.size());
  result.revisits_closed =
      std::count_if(revisits.begin(), revisits.end(),
                    [](const Revisit& revisit) { return revisit.closed; });
  if (result.judged > 0) {
    result.precision = static_cast<double>(result.correct) /
                       static_cast<double>(result.judged);
  }
  if (result.revisits > 0) {
    result.recall = static_cast<double>(result.revisits_closed) /
                    static_cast<double>(result.revisits);
  }
  return result;
}

// Stamps of the nodes that the reference places near an earlier pose.
std::vector<io::TimeNs> RevisitingNodes(const MapGraph& graph,
                                        const Trajectory& reference,
                                        const LoopStatisticsOptions& options) {
  using Cell = std::pair<int64_t, int64_t>;
  std::vector<std::pair<io::TimeNs, Eigen::Vector2d>> visits;
  for (const auto& entry : graph.nodes) {
    const auto pose =
        reference.Lookup(entry.second.time, options.stamp_tolerance);
    if (!pose.has_value()) continue;
    visits.emplace_back(entry.second.time, pose->translation().head<2>());
  }
  std::sort(visits.begin(), visits.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto cell_of = [&](const Eigen::Vector2d& position) {
    return Cell(std::llround(position.x() / options.revisit_distance),
                std::llround(position.y() / options.revisit_distance));
  };
  // Positions enter the grid once they are old enough to count as earlier.
  std::map<Cell, std::vector<Eigen::Vector2d>> earlier;
  std::vector<io::TimeNs> times;
  size_t next = 0;
  for (const auto& visit : visits) {
    while (visit.first - visits[next].first > options.loop_time_gap) {
      earlier[cell_of(visits[next].second)].push_back(visits[next].second);
      ++next;
    }
    const Cell centre = cell_of(visit.second);
    bool found = false;
    for (int64_t dx = -1; dx <= 1 && !found; ++dx) {
      for (int64_t dy = -1; dy <= 1 && !found; ++dy) {
        const auto it = earlier.find({centre.first + dx, centre.second + dy});
        if (it == earlier.end()) continue;
        for (const Eigen::Vector2d& position : it->second) {
          if ((position - visit.second).norm() <= options.revisit_distance) {
            found = true;
            break;
          }
        }
      }
    }
    if (found) times.push_back(visit.first);
  }
  return times;
}

}  // namespace

LoopStatistics ComputeLoopStatistics(const MapGraph& graph) {
  return Compute(
      Judge(graph),
      [](const GraphConstraint&) { return absl::optional<TrueRelation>(); }, {},
      LoopStatisticsOptions());
}

LoopStatistics ComputeLoopStatistics(const MapGraph& graph,
                                     const Trajectory& reference,
                                     const LoopStatisticsOptions& options) {
  const Judge judge(graph);
  const auto truth =
      [&](const GraphConstraint& constraint) -> absl::optional<TrueRelation> {
    // The inserted node nearest to where the loop puts its node: the shorter
    // the path between them, the less local drift enters.
    const Pose2 submap_local =
        graph.submaps.at(constraint.submap_id).local_pose;
    const Eigen::Vector2d claimed =
        submap_local * constraint.relative_pose.translation();
    absl::optional<TrueRelation> result;
    double nearest = std::numeric_limits<double>::infinity();
    for (const GraphId& id : judge.Inserted(constraint.submap_id)) {
      const GraphNode& node = graph.nodes.at(id);
      const double distance = (node.local_pose.translation() - claimed).norm();
      if (distance >= nearest) continue;
      const auto a = reference.Lookup(node.time, options.stamp_tolerance);
      if (!a.has_value()) continue;
      const io::TimeNs time_b = graph.nodes.at(constraint.node_id).time;
      const auto b = reference.Lookup(time_b, options.stamp_tolerance);
      if (!b.has_value()) return absl::nullopt;
      nearest = distance;
      result = {node.time, time_b, Between(ToPose2(*a), ToPose2(*b))};
    }
    return result;
  };
  return Compute(judge, truth,
                 MergeRevisits(RevisitingNodes(graph, reference, options),
                               options.revisit_break),
                 options);
}

LoopStatistics ComputeLoopStatistics(const MapGraph& graph,
                                     const std::vector<Relation>& relations,
                                     const LoopStatisticsOptions& options) {
  // Both directions of every relation, in order of the second stamp.
  std::vector<TrueRelation> sorted;
  std::vector<io::TimeNs> revisit_times;
  for (const Relation& relation : relations) {
    const Pose2 expected = ToPose2(relation.relative);
    sorted.push_back({relation.time1, relation.time2, expected});
    sorted.push_back({relation.time2, relation.time1, expected.Inverse()});
    if (std::llabs(relation.time2 - relation.time1) > options.loop_time_gap) {
      revisit_times.push_back(std::max(relation.time1, relation.time2));
    }
  }
  const auto earlier = [](const TrueRelation& a, const TrueRelation& b) {
    return a.time_b < b.time_b;
  };
  std::stable_sort(sorted.begin(), sorted.end(), earlier);
  std::sort(revisit_times.begin(), revisit_times.end());

  const Judge judge(graph);
  const auto truth =
      [&](const GraphConstraint& constraint) -> absl::optional<TrueRelation> {
    const std::vector<GraphId>& inserted = judge.Inserted(constraint.submap_id);
    if (inserted.empty()) return absl::nullopt;
    const io::TimeNs first =
        graph.nodes.at(inserted.front()).time - options.bridge;
    const io::TimeNs last =
        graph.nodes.at(inserted.back()).time + options.bridge;
    const io::TimeNs time = graph.nodes.at(constraint.node_id).time;
    TrueRelation key;
    key.time_b = time - options.bridge;
    absl::optional<TrueRelation> result;
    for (auto it = std::lower_bound(sorted.begin(), sorted.end(), key, earlier);
         it != sorted.end() && it->time_b <= time + options.bridge; ++it) {
      if (it->time_a < first || it->time_a > last) continue;
      if (!result.has_value() ||
          std::llabs(it->time_b - time) < std::llabs(result->time_b - time)) {
        result = *it;
      }
    }
    return result;
  };
  return Compute(judge, truth,
                 MergeRevisits(revisit_times, options.revisit_break), options);
}

}  // namespace evaluation
}  // namespace cartographer_ext
