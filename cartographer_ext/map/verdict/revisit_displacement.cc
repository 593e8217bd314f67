// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/revisit_displacement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "Eigen/Eigenvalues"
#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/map/verdict/placed_submaps.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

// Share of the returns that meet walls for each shift, row by row; for each the
// largest over the rotations.
using Shares = std::vector<double>;

// The shifts, in the map frame.
std::vector<Eigen::Vector2d> ShiftsOf(const DisplacementOptions& options) {
  const int steps =
      static_cast<int>(std::lround(options.window / options.step));
  std::vector<Eigen::Vector2d> shifts;
  for (int ix = -steps; ix <= steps; ++ix) {
    for (int iy = -steps; iy <= steps; ++iy) {
      shifts.emplace_back(ix * options.step, iy * options.step);
    }
  }
  return shifts;
}

Shares SharesOf(const std::vector<Eigen::Vector2d>& scan,
                const Pose2& local_from_map, const Pose2& map_from_node,
                const std::vector<Eigen::Vector2d>& shifts,
                const SubmapCells& cells, const DisplacementOptions& options) {
  const size_t stride =
      (scan.size() + options.max_points - 1) / options.max_points;
  std::vector<Eigen::Vector2d> local_shifts;
  for (const Eigen::Vector2d& shift : shifts) {
    local_shifts.push_back(Pose2(0., 0., local_from_map.theta) * shift);
  }
  std::vector<int> most(shifts.size(), 0);
  std::vector<Eigen::Vector2d> points;
  for (int k = -options.num_rotations; k <= options.num_rotations; ++k) {
    const Pose2 local_from_node =
        local_from_map * map_from_node *
        Pose2(0., 0., options.angular_window * k / options.num_rotations);
    points.clear();
    for (size_t i = 0; i < scan.size(); i += stride) {
      points.push_back(local_from_node * scan[i]);
    }
    const std::vector<int> hits =
        cells.CountNearOccupied(points, local_shifts, options.tolerance);
    for (size_t i = 0; i < hits.size(); ++i) {
      most[i] = std::max(most[i], hits[i]);
    }
  }
  Shares shares;
  for (const int hits : most) {
    shares.push_back(static_cast<double>(hits) /
                     static_cast<double>(points.size()));
  }
  return shares;
}

// The smallest shift that fits as well as the best; negative if none fits.
double Displacement(const Shares& shares,
                    const std::vector<Eigen::Vector2d>& shifts,
                    const DisplacementOptions& options) {
  const double best = *std::max_element(shares.begin(), shares.end());
  if (best < options.min_share) return -1.;
  double smallest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < shifts.size(); ++i) {
    if (shares[i] >= best - options.equal_share) {
      smallest = std::min(smallest, shifts[i].norm());
    }
  }
  return smallest;
}

// Inverse of the second moment, about the pose in the map, of the shifts that fit
// as well as the best, less that of all shifts: where nothing tells, all fit.
Eigen::Matrix2d InformationOf(const Shares& shares,
                              const std::vector<Eigen::Vector2d>& shifts,
                              const DisplacementOptions& options) {
  const double best = *std::max_element(shares.begin(), shares.end());
  Eigen::Matrix2d fitting = Eigen::Matrix2d::Zero();
  double all = 0.;
  int num_fitting = 0;
  for (size_t i = 0; i < shifts.size(); ++i) {
    all += Squared(shifts[i].x()) / static_cast<double>(shifts.size());
    if (shares[i] < best - options.equal_share) continue;
    fitting += shifts[i] * shifts[i].transpose();
    ++num_fitting;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(fitting /
                                                            num_fitting);
  const double noise = Squared(options.tolerance);
  const Eigen::Vector2d information =
      ((axes.eigenvalues().array() + noise).inverse() - 1. / (all + noise))
          .max(0.);
  return axes.eigenvectors() * information.asDiagonal() *
         axes.eigenvectors().transpose();
}

struct Look {
  NodeDisplacement node;
  GraphId anchor_id;
  Shares shares;
};

// Judges consecutive looks, each by those around it.
void JudgeRun(const std::vector<Look>& run,
              const std::vector<Eigen::Vector2d>& shifts,
              const DisplacementOptions& options,
              RevisitDisplacements* const result) {
  const size_t together = std::min<size_t>(options.nodes_together, run.size());
  for (size_t i = 0; i < run.size(); ++i) {
    const size_t first =
        std::min(i - std::min(i, together / 2), run.size() - together);
    Shares mean(shifts.size(), 0.);
    for (size_t k = first; k < first + together; ++k) {
      for (size_t s = 0; s < shifts.size(); ++s) {
        mean[s] += run[k].shares[s] / static_cast<double>(together);
      }
    }
    const double displacement = Displacement(mean, shifts, options);
    NodeDisplacement node = run[i].node;
    node.is_judged = displacement >= 0.;
    node.displacement = std::max(0., displacement);
    result->nodes.push_back(node);
    if (!node.is_judged || node.displacement > options.limit) continue;
    result->ties.push_back(
        {node.node_id, run[i].anchor_id, InformationOf(mean, shifts, options)});
  }
}

// The submaps by id, and the positions of the nodes in the sequence.
struct Order {
  std::map<GraphId, const PlacedSubmap*> submaps;
  std::map<GraphId, int> positions;

  Order(const MapGraph& graph, const std::vector<PlacedSubmap>& placed) {
    for (const PlacedSubmap& submap : placed) submaps[submap.id] = &submap;
    for (const auto& node : graph.nodes) {
      positions.emplace(node.first, static_cast<int>(positions.size()));
    }
  }
};

// First and last position of what a submap and a node tie together; none if
// either is missing.
std::vector<std::pair<int, int>> SpanOf(const Order& order,
                                        const GraphId& submap_id,
                                        const GraphId& node_id) {
  const auto submap = order.submaps.find(submap_id);
  const auto node = order.positions.find(node_id);
  if (submap == order.submaps.end() || node == order.positions.end()) return {};
  const std::vector<Anchor>& anchors = submap->second->anchors;
  return {{std::min(node->second, order.positions.at(anchors.front().node_id)),
           std::max(node->second, order.positions.at(anchors.back().node_id))}};
}

double PathLength(const MapGraph& graph) {
  double length = 0.;
  const std::pair<const GraphId, GraphNode>* last = nullptr;
  for (const auto& node : graph.nodes) {
    if (last != nullptr &&
        last->first.trajectory_id == node.first.trajectory_id) {
      length += (node.second.global_pose.translation() -
                 last->second.global_pose.translation())
                    .norm();
    }
    last = &node;
  }
  return length;
}

// See RevisitDisplacements::tied_share.
double TiedShare(const MapGraph& graph, const Order& order,
                 const std::vector<NodeDisplacement>& nodes,
                 const DisplacementOptions& options) {
  if (PathLength(graph) <= options.free_length) return 1.;
  // Ties over each step from a position to the next, as differences.
  std::vector<int> ties(graph.nodes.size() + 1, 0);
  const auto tie = [&](const GraphId& submap_id, const GraphId& node_id) {
    for (const auto& span : SpanOf(order, submap_id, node_id)) {
      ++ties[span.first];
      --ties[span.second];
    }
  };
  for (const NodeDisplacement& node : nodes) {
    if (node.is_judged && node.displacement <= options.limit) {
      tie(node.submap_id, node.node_id);
    }
  }
  for (const GraphConstraint& constraint : graph.constraints) {
    if (constraint.is_loop) tie(constraint.submap_id, constraint.node_id);
  }
  const int needed = std::max(
      1, std::min(options.min_ties, static_cast<int>(nodes.size() / 10)));
  int largest = 0, length = 1, count = 0;
  for (const int change : ties) {
    count += change;
    length = count >= needed ? length + 1 : 1;
    largest = std::max(largest, length);
  }
  return largest > 1 ? static_cast<double>(largest) /
                           static_cast<double>(graph.nodes.size())
                     : 0.;
}

}  // namespace

RevisitDisplacements FindDisplacements(const MapGraph& graph,
                                       const MapContents& contents,
                                       const Contradictions& contradictions,
                                       const DisplacementOptions& options) {
  const std::vector<PlacedSubmap> placed = PlaceSubmaps(graph, contents);
  const Order order(graph, placed);
  const std::vector<Eigen::Vector2d> shifts = ShiftsOf(options);
  const int stride = static_cast<int>(std::max<int64_t>(
      options.stride,
      (contradictions.judged_nodes - 1) / options.max_nodes + 1));
  RevisitDisplacements result;
  std::vector<Look> run;
  int skipped = 0;
  for (const NodeContradiction& seen : contradictions.nodes) {
    if (seen.judged == 0) continue;
    const GraphId& id = seen.node_id;
    if (!run.empty()) {
      const GraphId& last = run.back().node.node_id;
      if (last.trajectory_id != id.trajectory_id ||
          id.index - last.index > 2 * stride) {
        JudgeRun(run, shifts, options, &result);
        run.clear();
      } else if (++skipped < stride) {
        continue;
      }
    }
    skipped = 0;
    const PlacedSubmap& submap = *order.submaps.at(seen.widest_submap_id);
    const Pose2& pose = graph.nodes.at(id).global_pose;
    Look look;
    look.node.node_id = id;
    look.node.submap_id = submap.id;
    look.node.is_distinct = seen.is_distinct;
    look.anchor_id = submap.NearestAnchor(pose.translation()).node_id;
    look.shares =
        SharesOf(contents.scans.at(id), submap.LocalFromMap(pose.translation()),
                 pose, shifts, *submap.cells, options);
    run.push_back(std::move(look));
  }
  JudgeRun(run, shifts, options, &result);
  std::vector<PieceNode> displaced;
  for (const NodeDisplacement& node : result.nodes) {
    if (!node.is_judged) continue;
    result.judged_nodes += node.is_distinct;
    if (node.displacement <= options.limit) continue;
    result.displaced_nodes += node.is_distinct;
    displaced.push_back({node.node_id, node.submap_id, 0., node.displacement,
                         node.is_distinct});
  }
  result.pieces = JoinToPieces(graph, displaced, options.pieces);
  result.tied_share = TiedShare(graph, order, result.nodes, options);
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
