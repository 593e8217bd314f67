// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the paths say in the compatible subset: the relations of its clusters, and
// how well each of them agrees with its own path.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Of the sigmas of both predictions: a cycle that closes within it would hardly
// do so by chance.
constexpr double kFarOffShare = 0.1;
// Change of the logarithm of the factor on the variances that is worth relating
// all clusters anew.
constexpr double kNoticeableChange = 0.3;

uncertainty::LoopEdge Reversed(const uncertainty::LoopEdge& edge) {
  uncertainty::LoopEdge reversed;
  reversed.a = edge.b;
  reversed.b = edge.a;
  reversed.pose = Invert(edge.pose);
  return reversed;
}

// With the factor of long paths.
absl::optional<uncertainty::UncertainPose> ScaledPath(
    const uncertainty::PathUncertainty& paths, const double path_factor,
    const uncertainty::VertexId& u, const uncertainty::VertexId& v) {
  absl::optional<uncertainty::UncertainPose> path = paths.Between(u, v);
  if (path.has_value() && path_factor != 1.) {
    path->covariance *= FactorOfPath(path_factor, *paths.Travelled(u, v));
  }
  return path;
}

// Seen from the first vertex of `u`. From that of the other loop it is the same
// up to the first order only: errors of half a radian, which a path of a
// kilometre explains, may look too large from one end of a long arm. Empty if
// no path connects the loops.
absl::optional<uncertainty::CycleResult> TestCycle(
    const uncertainty::CycleConsistencyOptions& options,
    const uncertainty::PathUncertainty& paths, const double path_factor,
    const uncertainty::LoopEdge& u, const uncertainty::LoopEdge& v) {
  const absl::optional<uncertainty::UncertainPose> path_b =
      ScaledPath(paths, path_factor, u.b, v.b);
  const absl::optional<uncertainty::UncertainPose> path_a =
      ScaledPath(paths, path_factor, v.a, u.a);
  if (!path_a.has_value() || !path_b.has_value()) return absl::nullopt;
  return uncertainty::TestCycle(options, u.pose, *path_b, v.pose, *path_a);
}

// The nodes of the path that a loop closes.
std::pair<int, int> NodesOf(const uncertainty::LoopEdge& edge) {
  return std::minmax({edge.a.index(), edge.b.index()});
}

}  // namespace

CompatibleSubset::Relation CompatibleSubset::Relate(
    const LoopEvidence& u, const LoopEvidence& v) const {
  uncertainty::LoopEdge other = v.edge;
  if (!u.edge.a.InSequenceWith(other.a)) other = Reversed(other);
  const bool is_within = u.is_within_trajectory() && v.is_within_trajectory();
  const double path_factor =
      is_within ? PathFactor(u.edge.b.trajectory_id()) : 1.;
  absl::optional<uncertainty::CycleResult> cycle =
      TestCycle(options_.cycle, *paths_, path_factor, u.edge, other);
  if (!cycle.has_value()) return Relation::kUntestable;
  if (!cycle->compatible) {
    cycle = TestCycle(options_.cycle, *paths_, path_factor, other, u.edge);
    if (!cycle->compatible) return Relation::kContradicts;
  }
  const double sigma = uncertainty::WorstTranslationSigma(cycle->covariance);
  if (sigma > InformativeSigma(std::min(u.linear_window, v.linear_window))) {
    return Relation::kVague;
  }
  const double prior_sigma = std::min(u.prior_sigma, v.prior_sigma);
  return is_within && prior_sigma > options_.weak_prior_sigma &&
                 sigma <= kFarOffShare * prior_sigma
             ? Relation::kSupportsFarOff
             : Relation::kSupports;
}

void CompatibleSubset::RelateAll() {
  changed_ = true;
  for (int i = 0; i < num_clusters(); ++i) {
    CompareWithPath(&clusters_[i]);
    for (int j = 0; j < i; ++j) {
      relations_[i][j] = Relate(clusters_[j].leader, clusters_[i].leader);
    }
  }
}

void CompatibleSubset::CompareWithPath(Cluster* const cluster) const {
  if (!options_.scores_are_probabilities ||
      !cluster->leader.is_within_trajectory()) {
    return;
  }
  cluster->path = AgreementWithPath(*paths_, cluster->leader.edge,
                                    cluster->leader.search_density);
  cluster->path_odds =
      cluster->path.is_known()
          ? OddsByPath(cluster->path,
                       PathFactor(cluster->leader.edge.b.trajectory_id()))
          : 1.;
}

double CompatibleSubset::PathFactor(const int trajectory_id) const {
  const auto found = path_factors_.find(trajectory_id);
  return found == path_factors_.end() ? 1. : found->second;
}

double CompatibleSubset::AsRevisits(const double odds) const {
  if (!options_.scores_are_probabilities) return 0.;
  return std::log(odds) / std::log(OddsPerRevisit(Relation::kSupports));
}

double CompatibleSubset::ShareOfPath(const int index) const {
  if (!clusters_[index].path.is_known()) return 1.;
  const std::pair<int, int> nodes = NodesOf(clusters_[index].leader.edge);
  const int length = nodes.second - nodes.first;
  if (length == 0) return 1.;
  double sum = length;
  for (int j = 0; j < num_clusters(); ++j) {
    if (j == index || !clusters_[j].path.is_known() ||
        !IsSupport(RelationOf(index, j))) {
      continue;
    }
    const std::pair<int, int> other = NodesOf(clusters_[j].leader.edge);
    sum += std::max(0, std::min(nodes.second, other.second) -
                           std::max(nodes.first, other.first));
  }
  return length / sum;
}

bool CompatibleSubset::LearnPaths() {
  if (!options_.scores_are_probabilities) return false;
  std::map<int, std::vector<PathSample>> samples;  // by trajectory
  for (const Cluster& cluster : clusters_) {
    if (!cluster.path.is_known() || cluster.path.length <= kLongPath ||
        cluster.total_support < 1.) {
      continue;
    }
    PathSample sample;
    sample.agreement = cluster.path;
    sample.probability = cluster.best_score * (1. - share_wrong_);
    sample.share = cluster.path_share;
    samples[cluster.leader.edge.b.trajectory_id()].push_back(sample);
  }
  bool any = false;
  for (const auto& entry : samples) {
    const double factor = LearnPathFactor(entry.second);
    if (std::abs(std::log(factor / PathFactor(entry.first))) <
        kNoticeableChange) {
      continue;
    }
    path_factors_[entry.first] = factor;
    any = true;
  }
  if (any) RelateAll();
  return any;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
