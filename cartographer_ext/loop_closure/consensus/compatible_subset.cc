// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// In the subset, of a cluster about which next to nothing speaks.
constexpr double kLeastClusterWeight = 0.1;
// Of the best score of a cluster; rivals below are none.
constexpr double kRivalScore = 0.5;
// After a clique search that reached its limit, the next ones continue from its
// subset, to which little has been added, and get this part of the limit.
// Otherwise a building of equal places costs the whole limit for each revisit.
constexpr int64_t kContinuedPart = 10;

// Of the largest first, as many as `most` in all.
double SumOfBest(std::vector<std::pair<double, double>> shares,
                 const double most) {
  std::sort(shares.begin(), shares.end(),
            [](const std::pair<double, double>& a,
               const std::pair<double, double>& b) {
              return a.first != b.first ? a.first > b.first
                                        : a.second > b.second;
            });
  double sum = 0.;
  double left = most;
  for (const auto& share : shares) {
    sum += share.first * std::min(left, share.second);
    left = std::max(0., left - share.second);
  }
  return sum;
}

}  // namespace

constexpr double CompatibleSubset::kMostOddsPerFarRevisit;

CompatibleSubset::CompatibleSubset(
    const CompatibleSubsetOptions& options,
    const uncertainty::PathUncertainty* const paths)
    : options_(options), paths_(CHECK_NOTNULL(paths)) {
  CHECK_GT(options.max_clusters, 0);
  CHECK_GE(options.min_revisits, 1);
}

bool CompatibleSubset::SameRevisit(const LoopEvidence& u,
                                   const LoopEvidence& v) const {
  const absl::optional<double> a = paths_->Travelled(
      u.anchor.value_or(u.edge.a), v.anchor.value_or(v.edge.a));
  const absl::optional<double> b = paths_->Travelled(u.edge.b, v.edge.b);
  return a.has_value() && b.has_value() && *a <= options_.revisit_distance &&
         *b <= options_.revisit_distance;
}

void CompatibleSubset::Add(const LoopEvidence& loop) {
  changed_ = true;
  for (Cluster& cluster : clusters_) {
    if (!SameRevisit(cluster.leader, loop)) continue;
    const Relation relation = Relate(cluster.leader, loop);
    if (!IsSupport(relation) && relation != Relation::kVague) {
      continue;
    }
    cluster.undecided.push_back(loop);
    ++cluster.num_loops;
    cluster.best_score = std::max(cluster.best_score, loop.score);
    cluster.least_sigma = std::min(cluster.least_sigma, loop.prior_sigma);
    return;
  }
  MakeRoom();
  std::vector<Relation> relations;
  relations.reserve(clusters_.size());
  for (const Cluster& cluster : clusters_) {
    relations.push_back(Relate(cluster.leader, loop));
  }
  Cluster cluster;
  cluster.leader = loop;
  cluster.undecided.push_back(loop);
  cluster.num_loops = 1;
  cluster.best_score = loop.score;
  cluster.least_sigma = loop.prior_sigma;
  CompareWithPath(&cluster);
  clusters_.push_back(std::move(cluster));
  relations_.push_back(std::move(relations));
}

void CompatibleSubset::UpdateEvidence(const LoopEvidence& loop) {
  for (Cluster& cluster : clusters_) {
    for (LoopEvidence& undecided : cluster.undecided) {
      if (undecided.id != loop.id) continue;
      undecided.score = loop.score;
      undecided.probability = loop.probability;
      undecided.prior_sigma = loop.prior_sigma;
      undecided.odds_of_neighbours = loop.odds_of_neighbours;
      cluster.least_sigma = std::min(cluster.least_sigma, loop.prior_sigma);
      if (!cluster.accepted) cluster.best_score = 0.;
      for (const LoopEvidence& other : cluster.undecided) {
        cluster.best_score = std::max(cluster.best_score, other.score);
      }
      changed_ = true;
      return;
    }
  }
}

void CompatibleSubset::SetOddsPerFarRevisit(const double odds) {
  odds_per_far_revisit_ = std::min(kMostOddsPerFarRevisit, odds);
  changed_ = true;
}

void CompatibleSubset::SetShareWrong(const double share_wrong) {
  share_wrong_ = share_wrong;
  changed_ = true;
}

double CompatibleSubset::Support(const int index, const bool of_subset,
                                 double* const log_odds) const {
  const uncertainty::LoopEdge& edge = clusters_[index].leader.edge;
  std::vector<uncertainty::VertexId> vertices;
  // Logarithm of the factor on the odds, share.
  std::vector<std::pair<double, double>> shares;
  double sum = 0.;
  for (int j = 0; j < num_clusters(); ++j) {
    if (j == index || (of_subset && !clusters_[j].in_subset)) continue;
    const Relation relation = RelationOf(index, j);
    if (!IsSupport(relation)) continue;
    const double odds = OddsPerRevisit(relation);
    const double share = ShareOfSupport(clusters_[j], odds);
    if (share <= 0.) continue;
    sum += share;
    shares.emplace_back(std::log(odds), share);
    // The end in the same run.
    const uncertainty::LoopEdge& other = clusters_[j].leader.edge;
    vertices.push_back(other.b.InSequenceWith(edge.b) ? other.b : other.a);
  }
  if (clusters_[index].leader.is_within_trajectory()) {
    if (log_odds != nullptr) {
      *log_odds = SumOfBest(std::move(shares), options_.max_revisits_for_odds);
    }
    return sum;
  }
  std::sort(vertices.begin(), vertices.end());
  std::vector<uncertainty::VertexId> places = {edge.b};
  for (const uncertainty::VertexId& vertex : vertices) {
    const bool is_near = std::any_of(
        places.begin(), places.end(), [&](const uncertainty::VertexId& place) {
          const absl::optional<double> distance =
              paths_->Travelled(place, vertex);
          return distance.has_value() && *distance <= options_.revisit_distance;
        });
    if (!is_near) places.push_back(vertex);
  }
  const double num_places = static_cast<double>(places.size() - 1);
  if (log_odds != nullptr) {
    *log_odds = std::min<double>(num_places, options_.max_revisits_for_odds) *
                std::log(options_.odds_per_revisit);
  }
  return num_places;
}

double CompatibleSubset::Weight(const Cluster& cluster) const {
  double weight = 1.;
  if (options_.scores_are_probabilities) {
    weight = std::min(1., std::max(kLeastClusterWeight, cluster.best_score));
  }
  if (cluster.accepted) weight *= options_.accepted_weight;
  if (!cluster.path.is_known()) return weight;
  PathAgreement best = cluster.path;
  best.chi_square = 0.;
  const double factor = PathFactor(cluster.leader.edge.b.trajectory_id());
  const double against = OddsByPath(best, factor) / cluster.path_odds;
  return std::max(kLeastClusterWeight,
                  weight - cluster.path_share * AsRevisits(against));
}

void CompatibleSubset::FindSubset() {
  const int n = num_clusters();
  CompatibilityGraph graph(n);
  std::vector<double> weights(n);
  for (int i = 0; i < n; ++i) {
    clusters_[i].path_share = ShareOfPath(i);
    weights[i] = Weight(clusters_[i]);
    for (int j = 0; j < i; ++j) {
      if (relations_[i][j] != Relation::kContradicts) graph.AddEdge(i, j);
    }
  }
  MaxCliqueOptions limits = options_.clique;
  std::vector<int> start;
  if (!exact_) {
    limits.max_steps /= kContinuedPart;
    for (int i = 0; i < n; ++i) {
      if (clusters_[i].in_subset) start.push_back(i);
    }
  }
  const MaxCliqueResult clique = MaxWeightClique(graph, weights, limits, start);
  exact_ = clique.exact;
  num_clique_steps_ += clique.steps;
  subset_size_ = static_cast<int>(clique.vertices.size());
  for (Cluster& cluster : clusters_) cluster.in_subset = false;
  for (const int v : clique.vertices) clusters_[v].in_subset = true;
}

void CompatibleSubset::FindSupport() {
  const int n = num_clusters();
  num_overturned_ = 0;
  for (int i = 0; i < n; ++i) {
    Cluster& cluster = clusters_[i];
    cluster.support = Support(i, true, &cluster.log_odds);
    cluster.total_support = Support(i, false, nullptr);
    cluster.contradictions = 0;
    for (int j = 0; j < n; ++j) {
      if (j == i || !clusters_[j].in_subset) continue;
      cluster.contradictions += RelationOf(i, j) == Relation::kContradicts;
    }
    if (cluster.accepted && !cluster.in_subset) ++num_overturned_;
  }
}

void CompatibleSubset::FindRivals() {
  const int n = num_clusters();
  for (int i = 0; i < n; ++i) {
    Cluster& cluster = clusters_[i];
    cluster.rival_support = -1.;
    for (int j = 0; j < n; ++j) {
      const Cluster& rival = clusters_[j];
      // A rival whose camp the subset outnumbers is beaten, and so is one that
      // scores far worse.
      if (j != i && RelationOf(i, j) == Relation::kContradicts &&
          (!options_.scores_are_probabilities ||
           rival.best_score >= kRivalScore * cluster.best_score) &&
          rival.contradictions <= rival.total_support + 1) {
        cluster.rival_support =
            std::max(cluster.rival_support,
                     rival.total_support +
                         AsRevisits(rival.path_odds / cluster.path_odds));
      }
    }
  }
}

void CompatibleSubset::Solve() {
  FindSubset();
  FindSupport();
  if (LearnPaths()) {
    FindSubset();
    FindSupport();
  }
  FindRivals();
}

void CompatibleSubset::Emit(
    const Cluster& cluster, const std::vector<LoopEvidence>& loops,
    const bool accepted, const SubsetReason reason,
    std::vector<SubsetDecision>* const decisions) const {
  for (const LoopEvidence& loop : loops) {
    SubsetDecision decision;
    decision.id = loop.id;
    decision.accepted = accepted;
    decision.reason =
        loop.was_accepted &&
                (loop.is_refuted || reason == SubsetReason::kContradicted)
            ? SubsetReason::kOverturned
            : reason;
    decision.support = static_cast<int>(cluster.support);
    decision.contradictions = cluster.contradictions;
    decision.subset_size = subset_size_;
    decisions->push_back(decision);
  }
}

std::vector<SubsetDecision> CompatibleSubset::Decide(const RunState state) {
  std::vector<SubsetDecision> decisions = std::move(overflow_);
  overflow_.clear();
  if (changed_) {
    changed_ = false;
    Solve();
    Withdraw(&decisions);
    for (Cluster& cluster : clusters_) {
      SubsetReason reason;
      if (cluster.undecided.empty() || !MayAccept(cluster, &reason)) continue;
      const std::vector<LoopEvidence> likely = TakeLikely(&cluster);
      if (likely.empty()) continue;
      Accept(likely, reason, &cluster, &decisions);
    }
  }
  const absl::optional<int> num_right = NumRightFarOff(state);
  for (int i = 0; state != RunState::kGoesOn && i < num_clusters(); ++i) {
    Cluster& cluster = clusters_[i];
    const std::vector<LoopEvidence> probable =
        TakeProbable(num_right, &cluster);
    if (probable.empty()) continue;
    Accept(probable, SubsetReason::kLikelyAtEnd, &cluster, &decisions);
    changed_ = true;
  }
  BoundAcceptedLoops();
  std::stable_sort(decisions.begin(), decisions.end(),
                   [](const SubsetDecision& a, const SubsetDecision& b) {
                     return a.withdrawn != b.withdrawn ? a.withdrawn
                                                       : a.id < b.id;
                   });
  return decisions;
}

std::vector<SubsetDecision> CompatibleSubset::Flush() {
  std::vector<SubsetDecision> decisions = Decide();
  for (int i = num_clusters() - 1; i >= 0; --i) {
    Cluster& cluster = clusters_[i];
    if (!cluster.undecided.empty()) {
      Emit(cluster, cluster.undecided, false, WhyNot(cluster), &decisions);
      cluster.undecided.clear();
    }
    if (!cluster.accepted) Erase(i);
  }
  std::stable_sort(decisions.begin(), decisions.end(),
                   [](const SubsetDecision& a, const SubsetDecision& b) {
                     return a.id < b.id;
                   });
  return decisions;
}

std::vector<int64_t> CompatibleSubset::Remove(
    const std::function<bool(const LoopEvidence&)>& condition) {
  std::vector<int64_t> ids;
  for (int i = num_clusters() - 1; i >= 0; --i) {
    Cluster& cluster = clusters_[i];
    const size_t before = cluster.undecided.size();
    const auto kept = std::stable_partition(
        cluster.undecided.begin(), cluster.undecided.end(),
        [&](const LoopEvidence& loop) { return !condition(loop); });
    for (auto it = kept; it != cluster.undecided.end(); ++it) {
      ids.push_back(it->id);
    }
    cluster.undecided.erase(kept, cluster.undecided.end());
    cluster.num_loops -= static_cast<int>(before - cluster.undecided.size());
    if (cluster.undecided.empty() && !cluster.accepted) Erase(i);
  }
  if (!ids.empty()) changed_ = true;
  std::sort(ids.begin(), ids.end());
  return ids;
}

void CompatibleSubset::Erase(const int index) {
  num_accepted_loops_ -=
      static_cast<int>(clusters_[index].accepted_loops.size());
  clusters_.erase(clusters_.begin() + index);
  relations_.erase(relations_.begin() + index);
  for (size_t i = static_cast<size_t>(index); i < relations_.size(); ++i) {
    relations_[i].erase(relations_[i].begin() + index);
  }
}

void CompatibleSubset::MakeRoom() {
  if (num_clusters() < options_.max_clusters) return;
  const auto num_accepted =
      std::count_if(clusters_.begin(), clusters_.end(),
                    [](const Cluster& cluster) { return cluster.accepted; });
  const bool forget_accepted = 2 * num_accepted > num_clusters();
  int oldest = 0;
  while (clusters_[oldest].accepted != forget_accepted) ++oldest;
  Cluster& cluster = clusters_[oldest];
  if (!cluster.undecided.empty()) {
    Solve();
    SubsetReason reason;
    if (MayAccept(cluster, &reason)) {
      const std::vector<LoopEvidence> likely = TakeLikely(&cluster);
      if (!likely.empty()) Accept(likely, reason, &cluster, &overflow_);
    }
    const SubsetReason why_not = WhyNot(cluster);
    Emit(cluster, cluster.undecided, false, why_not, &overflow_);
    if (why_not == SubsetReason::kContradicted &&
        cluster.leader.is_within_trajectory()) {
      num_wrong_ += NumVerified(cluster.undecided);
    }
  }
  Erase(oldest);
}

std::vector<SubsetDecision> CompatibleSubset::Undecided() const {
  std::vector<SubsetDecision> decisions;
  for (const Cluster& cluster : clusters_) {
    Emit(cluster, cluster.undecided, false, WhyNot(cluster), &decisions);
  }
  std::stable_sort(decisions.begin(), decisions.end(),
                   [](const SubsetDecision& a, const SubsetDecision& b) {
                     return a.id < b.id;
                   });
  return decisions;
}

int CompatibleSubset::num_undecided() const {
  int count = 0;
  for (const Cluster& cluster : clusters_) {
    count += static_cast<int>(cluster.undecided.size());
  }
  return count;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
