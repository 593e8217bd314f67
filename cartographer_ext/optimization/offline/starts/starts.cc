// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/starts/starts.h"

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "Eigen/Cholesky"
#include "Eigen/LU"
#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/optimization/solvers/block_ldlt.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "cartographer_ext/optimization/solvers/kernels.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kRobustRounds = 6;
// Width of the kernel in the first round; it narrows to the gate in the last.
constexpr double kFirstWidth = 1e4;

double PositionVariance(const PoseGraphEdge& edge) {
  return 2. / (edge.information(0, 0) + edge.information(1, 1));
}

// Typical variances of one odometry edge, to compare positions with angles.
struct Unit {
  double position = 1.;
  double angle = 1.;
};

Unit OdometryUnit(const PoseGraph& graph) {
  std::vector<double> positions, angles;
  for (const PoseGraphEdge& edge : graph.edges) {
    if (edge.is_loop) continue;
    positions.push_back(PositionVariance(edge));
    angles.push_back(1. / edge.information(2, 2));
  }
  Unit unit;
  if (positions.empty()) return unit;
  unit.position = UpperMedian(std::move(positions));
  unit.angle = UpperMedian(std::move(angles));
  return unit;
}

// Blocks of three hold two unknowns; the third is pinned.
void PinThird(const int size, BlockLdlt* const factor) {
  Eigen::Matrix3d pin = Eigen::Matrix3d::Zero();
  pin(2, 2) = 1.;
  for (int i = 0; i != size; ++i) factor->AddDiagonal(i, pin);
}

// Adds the residual M_to u_to - M_from u_from = target of two planar unknowns,
// the first of which is held at `held`.
struct PlanarTerm {
  Eigen::Matrix2d of_from, of_to;
  Eigen::Vector2d target;
};

void AddTerm(const PlanarTerm& term, const WhitenedEdge& edge,
             const Eigen::Vector2d& held, int* const pair,
             BlockLdlt* const factor, Eigen::VectorXd* const rhs) {
  const int a = edge.from - 1, b = edge.to - 1;
  const auto embed = [](const Eigen::Matrix2d& block) {
    Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
    result.topLeftCorner<2, 2>() = block;
    return result;
  };
  Eigen::Vector2d target = term.target;
  if (a < 0) target += term.of_from * held;
  if (b < 0) target -= term.of_to * held;
  if (b >= 0) {
    factor->AddDiagonal(b, embed(term.of_to.transpose() * term.of_to));
    rhs->segment<2>(3 * b) += term.of_to.transpose() * target;
  }
  if (a >= 0) {
    factor->AddDiagonal(a, embed(term.of_from.transpose() * term.of_from));
    rhs->segment<2>(3 * a) -= term.of_from.transpose() * target;
  }
  if (a >= 0 && b >= 0) {
    factor->AddOffDiagonal((*pair)++,
                           embed(-term.of_from.transpose() * term.of_to));
  }
}

Eigen::Matrix2d Rotation(const double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

// Solves for a planar unknown of each pose but the first, whose is held, from
// the terms of the edges in force: `make_term(edge, covariance, weight)`.
// `factor` has been analysed; the third of each three results is void.
template <typename MakeTerm>
bool SolvePlanar(const std::vector<WhitenedEdge>& edges,
                 const std::vector<double>& weights,
                 const Eigen::Vector2d& held, const MakeTerm& make_term,
                 BlockLdlt* const factor, Eigen::VectorXd* const result) {
  result->setZero();
  factor->SetZero();
  PinThird(result->size() / 3, factor);
  int pair = 0;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!(weights[i] > 0.)) continue;
    const Eigen::Matrix3d covariance =
        (edges[i].whitening.transpose() * edges[i].whitening).inverse();
    AddTerm(make_term(edges[i], covariance, weights[i]), edges[i], held, &pair,
            factor, result);
  }
  if (!factor->Factorize(0.)) return false;
  factor->Solve(result);
  return result->allFinite();
}

bool SolveRotations(const std::vector<WhitenedEdge>& edges,
                    const std::vector<double>& weights, BlockLdlt* const factor,
                    std::vector<Pose2>* const poses) {
  const int size = poses->size() - 1;
  const Eigen::Vector2d held(std::cos((*poses)[0].theta),
                             std::sin((*poses)[0].theta));
  const auto make_term = [](const WhitenedEdge& edge,
                            const Eigen::Matrix3d& covariance,
                            const double weight) {
    // The marginal information of the angle.
    const double strength = std::sqrt(weight / covariance(2, 2));
    PlanarTerm term;
    term.of_to = strength * Eigen::Matrix2d::Identity();
    term.of_from = strength * Rotation(edge.measurement.z());
    term.target.setZero();
    return term;
  };
  Eigen::VectorXd axes(3 * size);
  if (!SolvePlanar(edges, weights, held, make_term, factor, &axes)) {
    return false;
  }
  for (int i = 0; i != size; ++i) {
    (*poses)[i + 1].theta = std::atan2(axes[3 * i + 1], axes[3 * i]);
  }
  return true;
}

bool SolvePositions(const std::vector<WhitenedEdge>& edges,
                    const std::vector<double>& weights, BlockLdlt* const factor,
                    std::vector<Pose2>* const poses) {
  const int size = poses->size() - 1;
  const auto make_term = [&](const WhitenedEdge& edge,
                             const Eigen::Matrix3d& covariance,
                             const double weight) {
    const Eigen::LLT<Eigen::Matrix2d> root(
        covariance.topLeftCorner<2, 2>().inverse());
    const Eigen::Matrix2d upper =
        std::sqrt(weight) * Eigen::Matrix2d(root.matrixU());
    PlanarTerm term;
    term.of_to = upper * Rotation((*poses)[edge.from].theta).transpose();
    term.of_from = term.of_to;
    term.target = upper * edge.measurement.head<2>();
    return term;
  };
  Eigen::VectorXd positions(3 * size);
  if (!SolvePlanar(edges, weights, (*poses)[0].translation(), make_term, factor,
                   &positions)) {
    return false;
  }
  for (int i = 0; i != size; ++i) {
    (*poses)[i + 1].x = positions[3 * i];
    (*poses)[i + 1].y = positions[3 * i + 1];
  }
  return true;
}

}  // namespace

std::vector<Pose2> ChainOdometry(const PoseGraph& graph) {
  std::vector<Pose2> poses = graph.poses;
  if (poses.empty()) return poses;
  const std::vector<std::vector<int>> edges_at = EdgesAtPoses(graph);
  std::vector<bool> reached(poses.size(), false);
  ChainFrom(graph, edges_at, 0, &reached, &poses);
  for (bool attached = true; attached;) {
    attached = false;
    for (const PoseGraphEdge& edge : graph.edges) {
      if (reached[edge.from] == reached[edge.to]) continue;
      const int known = reached[edge.from] ? edge.from : edge.to;
      const int other = edge.from == known ? edge.to : edge.from;
      poses[other] = MeasuredNeighbour(edge, known, poses);
      ChainFrom(graph, edges_at, other, &reached, &poses);
      attached = true;
    }
  }
  return poses;
}

std::vector<Pose2> SpanningTree(const PoseGraph& graph,
                                const std::vector<double>& weights) {
  std::vector<Pose2> poses = graph.poses;
  if (poses.empty()) return poses;
  const Unit unit = OdometryUnit(graph);
  const std::vector<std::vector<int>> edges_at = EdgesAtPoses(graph);
  std::vector<double> costs(poses.size(),
                            std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  costs[0] = 0.;
  queue.push({0., 0});
  while (!queue.empty()) {
    const Entry entry = queue.top();
    queue.pop();
    const int pose = entry.second;
    if (entry.first > costs[pose]) continue;
    for (const int i : edges_at[pose]) {
      const PoseGraphEdge& edge = graph.edges[i];
      if (edge.is_loop && weights[i] <= 0.5) continue;
      const int other = edge.from == pose ? edge.to : edge.from;
      const double cost = entry.first + PositionVariance(edge) / unit.position +
                          1. / (edge.information(2, 2) * unit.angle);
      if (cost >= costs[other]) continue;
      costs[other] = cost;
      poses[other] = MeasuredNeighbour(edge, pose, poses);
      queue.push({cost, other});
    }
  }
  return poses;
}

bool ChordalPoses(const std::vector<WhitenedEdge>& edges,
                  const std::vector<double>& weights,
                  std::vector<Pose2>* const poses) {
  if (poses->size() < 2) return true;
  BlockLdlt factor;
  factor.Analyze(poses->size() - 1, PairsInForce(edges, weights), {});
  std::vector<Pose2> result = *poses;
  if (!SolveRotations(edges, weights, &factor, &result) ||
      !SolvePositions(edges, weights, &factor, &result)) {
    return false;
  }
  *poses = std::move(result);
  return true;
}

bool PositionsOfHeadings(const std::vector<WhitenedEdge>& edges,
                         const std::vector<double>& weights,
                         std::vector<Pose2>* const poses) {
  if (poses->size() < 2) return true;
  BlockLdlt factor;
  factor.Analyze(poses->size() - 1, PairsInForce(edges, weights), {});
  return SolvePositions(edges, weights, &factor, poses);
}

bool RobustChordalPoses(const std::vector<WhitenedEdge>& edges,
                        std::vector<Pose2>* const poses) {
  std::vector<double> weights(edges.size(), 1.);
  std::vector<Pose2> result = *poses;
  const double narrowing =
      std::pow(kChi2Gate / kFirstWidth, 1. / (kRobustRounds - 1));
  double width = kFirstWidth;
  for (int round = 0; round != kRobustRounds; ++round, width *= narrowing) {
    if (!ChordalPoses(edges, weights, &result)) return false;
    for (size_t i = 0; i != edges.size(); ++i) {
      if (!edges[i].is_loop) continue;
      const double chi2 =
          Chi2(edges[i], result[edges[i].from], result[edges[i].to]);
      weights[i] = Squared(width / (width + chi2));
      // What hardly counts would only fill the factor.
      if (weights[i] < 1e-6) weights[i] = 0.;
    }
  }
  *poses = std::move(result);
  return true;
}

}  // namespace optimization
}  // namespace cartographer_ext
