// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/loose_places.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <map>
#include <utility>

#include "Eigen/Geometry"
#include "Eigen/LU"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/optimization/solvers/block_ldlt.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using optimization::BlockLdlt;
using uncertainty::Adjoint;

// Standard deviations of a step in which the robot stood still, and of a pose of
// which nothing is known, in metres and radians. They keep matrices invertible.
constexpr double kLeastStep = 1e-4;
constexpr double kAnywhere = 1e3;
// Points that stand for the stretch of path around a place.
constexpr double kMaxStretchPoints = 24.;

// Of the relative pose (first <- second), by position in the sequence.
struct Factor {
  int first, second;
  Eigen::Matrix3d information;  // frame of the second
};

// The nodes of a map in sequence, and what fixes them against each other.
class PathTies {
 public:
  PathTies(const MapGraph& graph, const std::vector<RevisitTie>& ties,
           const LoosePlaceOptions& options)
      : options_(options) {
    AddSteps(graph);
    for (const RevisitTie& tie : ties) AddTie(tie);
  }

  // Positions of nodes, evenly along the path.
  std::vector<int> Places() const {
    std::vector<int> places;
    const double spacing = Spacing();
    for (int i = 0; i < size(); ++i) {
      if (places.empty() ||
          ids_[i].trajectory_id != ids_[places.back()].trajectory_id ||
          travelled_[i] - travelled_[places.back()] >= spacing) {
        places.push_back(i);
      }
    }
    return places;
  }
  double Spacing() const {
    return std::max(options_.min_spacing,
                    travelled_.back() / options_.max_places);
  }

  // Columns of the covariance of all errors: for each of `places` the three of
  // that node, of which the rows of `places` are kept. Empty where the
  // information is singular.
  std::vector<BlockLdlt::Columns> Covariances(
      const std::vector<int>& places) const {
    BlockLdlt solver;
    if (!Factorize(&solver)) return {};
    std::vector<BlockLdlt::Columns> result;
    for (const int place : places) {
      BlockLdlt::Columns all = BlockLdlt::Columns::Zero(3 * size(), 3);
      all.block<3, 3>(3 * place, 0).setIdentity();
      solver.Solve(&all);
      BlockLdlt::Columns kept(3 * places.size(), 3);
      for (size_t k = 0; k < places.size(); ++k) {
        kept.block<3, 3>(3 * k, 0) = all.block<3, 3>(3 * places[k], 0);
      }
      result.push_back(std::move(kept));
    }
    return result;
  }

  // Of each of `places`, where the path is nearer to it than to the others, at
  // distances of no less than `spacing` metres.
  std::vector<std::vector<Eigen::Vector2d>> Stretches(
      const std::vector<int>& places, const double spacing) const {
    std::vector<std::vector<Eigen::Vector2d>> stretches(places.size());
    for (size_t k = 0; k < places.size(); ++k) {
      const int begin = k == 0 ? 0 : (places[k - 1] + places[k] + 1) / 2;
      const int end =
          k + 1 == places.size() ? size() : (places[k] + places[k + 1] + 1) / 2;
      double last = -std::numeric_limits<double>::infinity();
      for (int i = begin; i < end; ++i) {
        if (ids_[i].trajectory_id != ids_[places[k]].trajectory_id ||
            std::abs(travelled_[i] - travelled_[places[k]]) > Spacing() ||
            (i != places[k] && travelled_[i] - last < spacing)) {
          continue;
        }
        last = travelled_[i];
        stretches[k].push_back(poses_[i].translation());
      }
    }
    return stretches;
  }

  int size() const { return static_cast<int>(ids_.size()); }
  const GraphId& id(const int i) const { return ids_[i]; }
  const Pose2& pose(const int i) const { return poses_[i]; }

 private:
  void AddSteps(const MapGraph& graph) {
    uncertainty::PathUncertainty path(
        options_.noise, std::max(1, static_cast<int>(graph.nodes.size())));
    const auto vertex = [](const GraphId& id) {
      return uncertainty::NodeId{id.trajectory_id, id.index};
    };
    for (const auto& node : graph.nodes) {
      positions_[node.first] = size();
      ids_.push_back(node.first);
      poses_.push_back(node.second.global_pose);
      path.Add(vertex(node.first), node.second.local_pose);
    }
    travelled_.assign(ids_.size(), 0.);
    for (int i = 1; i < size(); ++i) {
      travelled_[i] = travelled_[i - 1];
      const auto step = path.Parts(vertex(ids_[i - 1]), vertex(ids_[i]));
      if (!step.has_value()) continue;  // of two trajectories
      travelled_[i] +=
          path.Travelled(vertex(ids_[i - 1]), vertex(ids_[i])).value_or(0.);
      const Eigen::Matrix3d covariance =
          step->Total({}, Eigen::Matrix3d::Zero()) +
          Squared(kLeastStep) * Eigen::Matrix3d::Identity();
      factors_.push_back({i - 1, i, covariance.inverse()});
    }
  }

  void AddTie(const RevisitTie& tie) {
    const auto anchor = positions_.find(tie.anchor_id);
    const auto node = positions_.find(tie.node_id);
    if (anchor == positions_.end() || node == positions_.end()) return;
    if (IsOneVisit(anchor->second, node->second)) return;
    const Eigen::Matrix2d map_from_node =
        Eigen::Rotation2Dd(poses_[node->second].theta).toRotationMatrix();
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    information.topLeftCorner<2, 2>() =
        map_from_node.transpose() * tie.information * map_from_node;
    information(2, 2) = 1. / Squared(options_.tie_rotation);
    factors_.push_back({anchor->second, node->second, information});
  }

  // Whether the robot has not come back in between.
  bool IsOneVisit(const int i, const int k) const {
    return ids_[i].trajectory_id == ids_[k].trajectory_id &&
           evaluation::IsOneVisit(
               std::abs(travelled_[i] - travelled_[k]),
               (poses_[i].translation() - poses_[k].translation()).norm(),
               options_.visit_distance);
  }

  bool Factorize(BlockLdlt* const solver) const {
    std::vector<std::pair<int, int>> pairs;
    for (const Factor& factor : factors_) {
      pairs.emplace_back(factor.first, factor.second);
    }
    solver->Analyze(size(), pairs, {});
    solver->SetZero();
    for (int i = 0; i < size(); ++i) {
      solver->AddDiagonal(
          i, 1. / Squared(kAnywhere) * Eigen::Matrix3d::Identity());
    }
    for (size_t k = 0; k < factors_.size(); ++k) {
      const Factor& factor = factors_[k];
      const Eigen::Matrix3d first =
          -Adjoint(Between(poses_[factor.second], poses_[factor.first]));
      solver->AddDiagonal(factor.first,
                          first.transpose() * factor.information * first);
      solver->AddDiagonal(factor.second, factor.information);
      solver->AddOffDiagonal(static_cast<int>(k),
                             first.transpose() * factor.information);
    }
    return solver->Factorize(0.);
  }

  const LoosePlaceOptions options_;
  std::vector<GraphId> ids_;
  std::vector<Pose2> poses_;
  std::vector<double> travelled_;  // metres
  std::map<GraphId, int> positions_;
  std::vector<Factor> factors_;
};

// Standard deviation of the position of place k as seen from place i, metres.
double Sigma(const PathTies& path, const std::vector<int>& places,
             const std::vector<BlockLdlt::Columns>& covariances, const size_t i,
             const size_t k) {
  const Eigen::Matrix3d adjoint =
      Adjoint(Between(path.pose(places[i]), path.pose(places[k])));
  const Eigen::Matrix3d cross = covariances[k].block<3, 3>(3 * i, 0);
  return uncertainty::WorstTranslationSigma(
      covariances[i].block<3, 3>(3 * i, 0) - adjoint * cross.transpose() -
      cross * adjoint.transpose() +
      adjoint * covariances[k].block<3, 3>(3 * k, 0) * adjoint.transpose());
}

double LeastDistance(const std::vector<Eigen::Vector2d>& a,
                     const std::vector<Eigen::Vector2d>& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& i : a) {
    for (const Eigen::Vector2d& k : b) {
      least = std::min(least, (i - k).squaredNorm());
    }
  }
  return std::sqrt(least);
}

bool IsOfOnePass(const GraphId& a, const GraphId& b,
                 const LoosePlaceOptions& options) {
  return a.trajectory_id == b.trajectory_id &&
         std::abs(a.index - b.index) < options.min_node_gap;
}

// What is not known of a place.
struct LoosePair {
  size_t other;     // place
  double sigma;     // metres
  double distance;  // metres
  double apart;     // distance beyond that of two visits, in sigmas
};

// Places without which no pair is left, as few as can be had by leaving out the
// one in most pairs again and again; in order.
std::vector<size_t> PlacesToLeaveOut(
    const std::vector<std::vector<LoosePair>>& pairs) {
  std::vector<int> counts;
  for (const auto& own : pairs) counts.push_back(static_cast<int>(own.size()));
  std::vector<size_t> left_out;
  while (true) {
    const auto most = std::max_element(counts.begin(), counts.end());
    if (most == counts.end() || *most <= 0) break;
    const size_t place = most - counts.begin();
    left_out.push_back(place);
    *most = 0;
    for (const LoosePair& pair : pairs[place]) --counts[pair.other];
  }
  std::sort(left_out.begin(), left_out.end());
  return left_out;
}

}  // namespace

std::string DescribeLooseShare(const double share) {
  return absl::StrFormat(
      "%.1f %% of the path may lie elsewhere without contradicting anything",
      100. * share);
}

LoosePlaces FindLoosePlaces(const MapGraph& graph,
                            const std::vector<RevisitTie>& ties,
                            const LoosePlaceOptions& options) {
  LoosePlaces result;
  if (graph.nodes.empty()) return result;
  const PathTies path(graph, ties, options);
  const std::vector<int> places = path.Places();
  const std::vector<BlockLdlt::Columns> covariances = path.Covariances(places);
  if (covariances.empty()) return result;
  result.looked_at = static_cast<int>(places.size());
  const double spacing =
      std::max(options.min_spacing, path.Spacing() / kMaxStretchPoints);
  const auto stretches = path.Stretches(places, spacing);
  // A visit may be half a spacing from the point that stands for it.
  const double visit = options.visit_distance + 0.5 * spacing;
  std::vector<std::vector<LoosePair>> pairs(places.size());
  for (size_t i = 0; i < places.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      if (IsOfOnePass(path.id(places[i]), path.id(places[k]), options)) {
        continue;
      }
      const double sigma = Sigma(path, places, covariances, i, k);
      if (sigma <= options.limit) continue;
      const double distance = LeastDistance(stretches[i], stretches[k]);
      const double apart = (distance - visit) / sigma;
      if (apart >= options.sigmas) continue;
      pairs[i].push_back({k, sigma, distance, apart});
      pairs[k].push_back({i, sigma, distance, apart});
    }
  }
  for (const size_t i : PlacesToLeaveOut(pairs)) {
    const LoosePair& nearest =
        *std::min_element(pairs[i].begin(), pairs[i].end(),
                          [](const LoosePair& a, const LoosePair& b) {
                            return a.apart < b.apart;
                          });
    result.places.push_back({path.id(places[i]), path.id(places[nearest.other]),
                             nearest.sigma, nearest.distance});
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
