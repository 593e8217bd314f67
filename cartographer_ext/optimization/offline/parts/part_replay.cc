// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/parts/part_replay.h"

#include <algorithm>
#include <utility>

#include "Eigen/LU"
#include "cartographer_ext/optimization/solvers/refused_loops.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Parts that are replayed one after the other.
constexpr int kMaxParts = 10;
// Poses on both sides of a part that are replayed with it, as its ends are not known
// exactly, and what is next to it is bent.
constexpr int kMargin = 2 * kStretchOfPath;

// `edge`, one end of which is held at `place` in the frame of the held pose 0, as an
// edge between that and its other end.
PoseGraphEdge ToHeldPose(PoseGraphEdge edge, const bool holds_from,
                         const Pose2& place) {
  if (holds_from) {
    edge.measurement = place * edge.measurement;
    return edge;
  }
  edge.measurement = edge.measurement * place.Inverse();
  // e = Ad(q <- h) e', so that e' Omega e keeps its value.
  const Eigen::Matrix3d adjoint = uncertainty::Adjoint(place.Inverse());
  edge.information = adjoint.transpose() * edge.information * adjoint;
  return edge;
}

// The whole moved so that its first pose is `first`.
void MoveFirstTo(const Pose2& first, std::vector<Pose2>* const poses) {
  const Pose2 motion = first * poses->front().Inverse();
  for (Pose2& pose : *poses) pose = motion * pose;
  poses->front() = first;
}

}  // namespace

PoseGraph GraphOfPart(const PoseGraph& graph, const std::vector<Pose2>& poses,
                      const PartOfPath& part, const PartSide side) {
  const int last = std::min<int>(part.end, graph.poses.size());
  const int held = side == PartSide::kBegin ? part.begin - 1 : last;
  const auto is_in_part = [&](const int pose) {
    return part.begin <= pose && pose < last;
  };
  // In the order of the replay, the held pose first.
  const auto number = [&](const int pose) {
    return is_in_part(pose) ? std::abs(pose - held) : 0;
  };
  PoseGraph result;
  for (int k = 0; k <= last - part.begin; ++k) {
    const int pose = side == PartSide::kBegin ? held + k : held - k;
    result.ids.push_back(k);
    result.poses.push_back(poses[pose]);
  }
  for (PoseGraphEdge edge : graph.edges) {
    const bool from_in_part = is_in_part(edge.from);
    if (!from_in_part && !is_in_part(edge.to)) continue;
    const int from = edge.from, to = edge.to;
    if (!from_in_part || !is_in_part(to)) {
      const int outside = from_in_part ? to : from;
      // On the other side the rest may be lost, too.
      edge.is_loop = edge.is_loop || outside != held;
      edge =
          ToHeldPose(edge, !from_in_part, Between(poses[held], poses[outside]));
    }
    edge.from = number(from);
    edge.to = number(to);
    result.edges.push_back(edge);
  }
  return result;
}

bool ReplayPart(const PoseGraph& graph, const PartOfPath& part,
                const PartSide side, const SmootherOptions& options,
                std::vector<Pose2>* const poses) {
  const int last = std::min<int>(part.end, graph.poses.size());
  if (side == PartSide::kBegin ? part.begin == 0
                               : last == static_cast<int>(graph.poses.size())) {
    return false;
  }
  ReplayResult replay;
  if (!Replay(GraphOfPart(graph, *poses, part, side), options, &replay).ok()) {
    return false;
  }
  const Pose2 first = poses->front();
  for (int k = 1; k <= last - part.begin; ++k) {
    (*poses)[side == PartSide::kBegin ? part.begin - 1 + k : last - k] =
        replay.poses[k];
  }
  MoveFirstTo(first, poses);
  return true;
}

bool ReplayLostParts(const PoseGraph& graph, const SmootherOptions& options,
                     RobustSolver* const solver,
                     std::vector<Pose2>* const poses) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  double lowest = TruncatedCost(edges, *poses);
  bool changed = false;
  for (int count = 0; count != kMaxParts; ++count) {
    const absl::optional<PartOfPath> part =
        FindLostPart(edges, DecideLoops(edges, *poses, kChi2Gate));
    if (!part.has_value()) break;
    PartOfPath wider;
    wider.begin = std::max(0, part->begin - kMargin);
    wider.end = part->end + kMargin;
    std::vector<Pose2> best;
    for (const PartSide side : {PartSide::kBegin, PartSide::kEnd}) {
      std::vector<Pose2> moved = *poses;
      if (!ReplayPart(graph, wider, side, options, &moved)) continue;
      // What holds the part to the rest may be bent, so that right loops lie just
      // beyond the gate.
      SolverOptions soft;
      soft.kernel = DefaultKernel(KernelType::kGemanMcClure);
      soft.kernel.parameter = kChi2Gate;
      solver->Solve(soft, &moved);
      PolishTruncated(kChi2Gate, kFullPolishRounds, solver, &moved, nullptr);
      const double cost = TruncatedCost(edges, moved);
      if (cost >= lowest - kChi2Gate) continue;
      lowest = cost;
      best = std::move(moved);
    }
    if (best.empty()) break;
    *poses = std::move(best);
    changed = true;
  }
  return changed;
}

bool ReplayLostParts(const PoseGraph& graph, const SmootherOptions& options,
                     RobustSolver* const solver, ReplayResult* const replay) {
  if (!ReplayLostParts(graph, options, solver, &replay->poses)) return false;
  std::vector<double> weights =
      DecideLoops(solver->edges(), replay->poses, options.gate);
  if (options.adaptive_gate) {
    PolishAdapted(kFullPolishRounds, solver, &replay->poses, &weights);
  }
  for (size_t i = 0; i != weights.size(); ++i) {
    replay->accepted[i] = weights[i] > 0.5;
  }
  return true;
}

}  // namespace optimization
}  // namespace cartographer_ext
