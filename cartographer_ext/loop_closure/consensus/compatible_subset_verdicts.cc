// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The verdicts of the compatible subset: what support is worth, and which loops
// may be accepted.
#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Odds of a loop that is accepted at the end of a run where nothing looks
// alike, and how many of them must have been right before one is accepted
// without support.
constexpr double kSureOdds = 19.;
constexpr int kEnoughRight = 3;
// By how much wrong matches take from the odds of agreement.
constexpr double kAgreementOfWrong = 3.;
// Or how much its neighbours must say for it.
constexpr double kOddsOfFollowed = 5.;

bool FindsNeighbours(const std::vector<LoopEvidence>& undecided) {
  return std::any_of(undecided.begin(), undecided.end(),
                     [](const LoopEvidence& loop) {
                       return loop.odds_of_neighbours >= kOddsOfFollowed;
                     });
}

// Removes the loops that fulfil the condition and returns them, both in order.
template <typename Condition>
std::vector<LoopEvidence> TakeIf(const Condition& condition,
                                 std::vector<LoopEvidence>* const loops) {
  const auto rest =
      std::stable_partition(loops->begin(), loops->end(), condition);
  std::vector<LoopEvidence> taken(loops->begin(), rest);
  loops->erase(loops->begin(), rest);
  return taken;
}

}  // namespace

double CompatibleSubset::InformativeSigma(const double linear_window) const {
  if (!options_.scores_are_probabilities) return options_.informative_sigma;
  // The odds that a closed cycle gives: its density, 1 / (2 pi sigma^2), against
  // that of a wrong match, which lies anywhere in the window.
  const double window_sigma =
      linear_window * std::sqrt(2. / (kPi * options_.odds_per_revisit));
  return std::min(options_.informative_sigma, window_sigma);
}

double CompatibleSubset::OddsPerRevisit(const Relation relation) const {
  const double odds =
      relation == Relation::kSupportsFarOff
          ? std::max(options_.odds_per_revisit, odds_per_far_revisit_)
          : options_.odds_per_revisit;
  return 1. + (odds - 1.) / (1. + kAgreementOfWrong * share_wrong_);
}

double CompatibleSubset::ShareOfSupport(const Cluster& cluster,
                                        const double odds_per_revisit) const {
  if (!options_.scores_are_probabilities) return 1.;
  const double score = cluster.best_score;
  if (score >= kConfirmingScore) return 1.;
  // Between trajectories an unlikely match confirms nobody.
  if (score <= 0. || !cluster.leader.is_within_trajectory()) return 0.;
  return std::max(
      0., 1. + std::log(score / (1. - score)) / std::log(odds_per_revisit));
}

bool CompatibleSubset::MayAccept(const Cluster& cluster,
                                 SubsetReason* const reason) const {
  if (!cluster.in_subset) {
    // A few failed tests among many that agree are forgiven.
    const double tolerance =
        cluster.least_sigma <= options_.single_strong_sigma
            ? std::max(options_.tolerance, options_.predicted_tolerance)
            : options_.tolerance;
    if (cluster.best_score < options_.forgiven_score ||
        cluster.contradictions >
            tolerance * (cluster.support + cluster.contradictions)) {
      *reason = SubsetReason::kContradicted;
      return false;
    }
  } else if (cluster.rival_support >= cluster.support && !cluster.accepted) {
    *reason = cluster.support < 1. ? SubsetReason::kUnsupported
                                   : SubsetReason::kRival;
    return false;
  }
  if (cluster.accepted) {
    *reason = SubsetReason::kJoinsAccepted;
    return true;
  }
  int needed = options_.min_revisits;
  if (cluster.least_sigma > options_.weak_prior_sigma) {
    needed = std::max(needed, options_.weak_prior_revisits);
  }
  // What matches wherever the robot went is worth another revisit.
  if (FindsNeighbours(cluster.undecided)) {
    needed = std::max(options_.min_revisits, needed - 1);
  }
  if (std::isinf(cluster.least_sigma)) {
    needed = std::max(needed, options_.unpredicted_revisits);
  }
  if (cluster.support + 1 >= needed) {
    *reason = SubsetReason::kSupported;
    return true;
  }
  if (options_.single_strong_enabled && cluster.rival_support < 0 &&
      cluster.least_sigma <= options_.single_strong_sigma &&
      cluster.best_score >= options_.single_strong_score &&
      cluster.num_loops >= options_.single_strong_loops) {
    *reason = SubsetReason::kSingleStrong;
    return true;
  }
  *reason = SubsetReason::kUnsupported;
  return false;
}

bool CompatibleSubset::MayAcceptLoop(const Cluster& cluster,
                                     const LoopEvidence& loop) const {
  if (loop.is_refuted) return false;
  if (!options_.scores_are_probabilities) return true;
  return loop.score * std::exp(cluster.log_odds) >=
         (1. - loop.score) * options_.odds_per_revisit;
}

std::vector<LoopEvidence> CompatibleSubset::TakeLikely(
    Cluster* const cluster) const {
  return TakeIf(
      [&](const LoopEvidence& loop) { return MayAcceptLoop(*cluster, loop); },
      &cluster->undecided);
}

absl::optional<int> CompatibleSubset::NumRightFarOff(
    const RunState state) const {
  if (state != RunState::kEndsUnalike || !options_.scores_are_probabilities) {
    return absl::nullopt;
  }
  int num_right = 0;
  for (const Cluster& cluster : clusters_) {
    if (!cluster.in_subset && cluster.best_score >= kConfirmingScore) {
      return absl::nullopt;
    }
    num_right +=
        cluster.accepted && cluster.least_sigma > options_.weak_prior_sigma;
  }
  return num_right;
}

bool CompatibleSubset::IsSureFarOff(const Cluster& cluster,
                                    const LoopEvidence& loop,
                                    const int num_right) const {
  if (cluster.support + 1 < options_.min_revisits && num_right < kEnoughRight &&
      loop.odds_of_neighbours < kOddsOfFollowed) {
    return false;
  }
  // The rule of succession: the odds that the next one is right, too.
  return loop.score * std::exp(cluster.log_odds) * (num_right + 1) >=
         (1. - loop.score) * kSureOdds;
}

std::vector<LoopEvidence> CompatibleSubset::TakeProbable(
    const absl::optional<int>& num_right, Cluster* const cluster) const {
  if (!options_.single_strong_enabled || !cluster->in_subset ||
      cluster->rival_support >= 0 || std::isinf(cluster->least_sigma)) {
    return {};
  }
  SubsetReason reason;
  const bool lacks_support = !MayAccept(*cluster, &reason);
  return TakeIf(
      [&](const LoopEvidence& loop) {
        return !loop.is_refuted &&
               (loop.probability >= options_.probability_at_end ||
                (lacks_support && num_right.has_value() &&
                 IsSureFarOff(*cluster, loop, *num_right)));
      },
      &cluster->undecided);
}

SubsetReason CompatibleSubset::WhyNot(const Cluster& cluster) const {
  SubsetReason reason;
  // Of a cluster that may be accepted, the unlikely loops wait.
  return MayAccept(cluster, &reason) ? SubsetReason::kUnsupported : reason;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
