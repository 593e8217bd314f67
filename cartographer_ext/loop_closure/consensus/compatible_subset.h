// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The largest set of loops that can be true together (paper G, improved graph
// optimisation 2024, section 3.4, eq. 20 and 21), updated incrementally as
// loops are added.
//
//   clusters   Loops of neighbouring nodes with neighbouring submaps are one
//              piece of evidence. A loop joins the first cluster whose leader
//              (its first loop) is near along the trajectory on both sides and
//              closes a cycle with it, otherwise it leads a new cluster.
//   relations  Leaders are tested in pairs by the cycle of eq. 20. A closed
//              cycle supports only when it could well have failed: where the
//              path between the loops is so uncertain that anything closes,
//              the pair is merely not in contradiction. A pair contradicts if
//              the cycle fails from both ends: to the first order errors of
//              large angles are not the same from both.
//   subset     The maximum clique of the graph without the contradictions
//              (eq. 21), every cluster counting once, those accepted before a
//              little more. Where scores are probabilities, a cluster counts
//              by the best one of its loops. An unlikely one with the odds o
//              supports others by max(0, 1 + ln o / ln r), with r the factor on
//              the odds for each revisit that agrees: what its agreement says
//              for it, less what its score says against it. Where both were
//              predicted ten times worse than the cycle leaves open, r is one
//              over the share of wrong places that look alike.
//   paths      Where scores are probabilities, so does what the path says
//              (path_agreement.h). Evidence is counted in revisits that agree: odds
//              of the path are worth ln odds / ln r of them. A cluster loses in the
//              clique what its path says against it, shared with those that have
//              the same path and support it, as they have its error in common; and
//              a rival has as many supporters more or less as the paths of both
//              differ. How much better than assumed long paths are is learnt from
//              the clusters that others confirm, and holds for the relations, too.
//   verdicts   A cluster is accepted when it is in the clique, has support from
//              enough others, and no rival has as much. A rival is a cluster
//              that contradicts it, unless more clusters of the subset
//              contradict the rival than support it. A single strong loop
//              without support is accepted by stricter rules of its own. What
//              is neither stays buffered and is tested again when new evidence
//              comes; `Flush` ends that. Where scores are probabilities, an
//              accepted cluster that is no longer in the clique and contradicts
//              it is withdrawn: its loops wait again. At the end of a run, when
//              no more can come, a loop of the subset without rivals is accepted if it is
//              probable, whatever support it lacks: a robot that comes back to
//              its start and stops there leaves no second revisit. If no match of
//              the run was wrong, places do not look alike: then two revisits
//              are enough in a weak prior, too, and after some that were right,
//              or whose neighbours were found where they should be, a single
//              one.
//
// Pairwise tests of true loops fail occasionally; `tolerance` allows a small
// share of contradictions so that long runs do not lose true loops. Zero is the
// paper's rule.
//
// Between trajectories one scan matches each of the overlapping submaps at its
// place, which is no more evidence than one match. There support counts places
// along the run, `revisit_distance` apart, instead of clusters.
//
// Bounded: beyond `max_clusters` the oldest accepted cluster is dropped if more
// than half are accepted, otherwise the oldest undecided one is decided as in
// `Flush`. Not thread-safe; the result depends only on the order in which loops
// are added.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_COMPATIBLE_SUBSET_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_COMPATIBLE_SUBSET_H_

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/loop_closure/consensus/max_clique.h"
#include "cartographer_ext/loop_closure/consensus/path_agreement.h"
#include "cartographer_ext/uncertainty/cycle_consistency.h"
#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// A loop with its score and prior.
struct LoopEvidence {
  int64_t id = 0;  // of the caller, unique
  uncertainty::LoopEdge edge;
  // Vertex from which the distance of revisits is measured, the same for all
  // loops of a submap; empty: edge.a.
  absl::optional<uncertainty::VertexId> anchor;
  // The fused score, in [0, 1]; where the neighbours of the match were looked at,
  // with what they say.
  double score = 0.;
  // The calibrated probability that the loop is true; 0: unknown.
  double probability = 0.;
  // Standard deviation of the prediction before the search, metres; infinity
  // without a prediction.
  double prior_sigma = 0.;
  // Half width of the search, metres.
  double linear_window = std::numeric_limits<double>::infinity();
  // The factor on the odds by which they changed it; 1: not looked at.
  double odds_of_neighbours = 1.;
  bool was_accepted = false;  // and withdrawn since
  // Paths over other accepted loops contradict it; not to be accepted.
  bool is_refuted = false;
  // Of matches evenly spread over the search, per m^2 rad; 0: unknown.
  double search_density = 0.;

  bool is_within_trajectory() const {
    return edge.a.trajectory_id() == edge.b.trajectory_id();
  }
  bool is_verified = false;  // its own scores are rather those of a true match
};

// Least best score of a cluster that may confirm others: rather true than
// false.
constexpr double kConfirmingScore = 0.5;

// What is known of the run when loops are decided.
enum class RunState {
  kGoesOn,       // more loops may come
  kEnds,         // none will come for now
  kEndsUnalike,  // the same, and no place of it was taken for another one
};

// Options of clusters, relations and verdicts, see above.
struct CompatibleSubsetOptions {
  // If false, every candidate that reaches this stage is accepted.
  bool enabled = true;
  uncertainty::CycleConsistencyOptions cycle;
  // Loops nearer than this along the trajectory, on both sides, are one
  // revisit.
  double revisit_distance = 5.;  // metres, >= 0
  // A cycle supports only if the sigma of its translation is at most this and,
  // where scores are probabilities, small enough for the windows searched.
  double informative_sigma = 1.;  // metres, > 0
  int min_revisits = 2;           // that agree, including the loop itself, >= 1
  // Tolerated share of contradictions among the informative relations to the
  // clique, in [0, 1).
  double tolerance = 0.04;
  // The same for clusters at their predicted place (within the single strong
  // sigma), since look-alike places are elsewhere.
  double predicted_tolerance = 0.2;
  // Both apply only to clusters with a loop of at least this score; without
  // evidence, all relations must be compatible.
  double forgiven_score = 0.6;
  // Scores are probabilities that the loop is true, and count as such: in the
  // clique, among rivals, and for the loop itself, which needs the more support
  // the less likely it is. Otherwise all loops count alike.
  bool scores_are_probabilities = false;
  // Factor on the odds of a loop for each of the first revisits that support
  // it, > 1; a loop needs at least these odds. Further revisits are not
  // independent.
  double odds_per_revisit = 3.;
  int max_revisits_for_odds = 3;
  double accepted_weight = 1.5;  // of a cluster accepted before, >= 1
  // Single strong loop: best score and number of loops in its cluster.
  bool single_strong_enabled = true;
  double single_strong_score = 0.8;
  int single_strong_loops = 3;
  // It must agree with its prediction: a match in a wide search may be a
  // look-alike place.
  double single_strong_sigma = 0.5;  // metres
  // A loop without enough support is accepted at the end of a run with at least
  // this probability, given its neighbours, if single_strong_enabled.
  double probability_at_end = 0.9;
  // If the sigma of the prediction exceeds this, more revisits must agree.
  double weak_prior_sigma = 1.;  // metres
  int weak_prior_revisits = 3;   // including the loop itself, >= 1
  // The same without a prediction, as for a run in the map of another one.
  int unpredicted_revisits = 3;
  int max_clusters = 400;  // > 0
  MaxCliqueOptions clique;
};

// Reason of a decision.
enum class SubsetReason {
  kSupported,      // accepted with its cluster
  kSingleStrong,   // accepted by the rule for single strong loops
  kJoinsAccepted,  // accepted, its cluster was accepted before
  kLikelyAtEnd,    // accepted at the end of the run, as it is probable
  kContradicted,   // rejected, contradicts the compatible subset
  kRival,          // rejected, a contradicting cluster has as much support
  kUnsupported,    // rejected, not confirmed until the end
  kOverturned,     // was accepted, contradicts the subset since
};

// The decision on one loop.
struct SubsetDecision {
  int64_t id = 0;
  bool accepted = false;
  // A loop that was accepted is undecided again.
  bool withdrawn = false;
  SubsetReason reason = SubsetReason::kUnsupported;
  int support = 0;         // clusters in the subset that support its cluster
  int contradictions = 0;  // clusters in the subset that contradict it
  int subset_size = 0;     // clusters in the subset
};

// The compatible subset, see above.
class CompatibleSubset {
 public:
  // `paths` must outlive this object and contain the nodes of all added loops.
  CompatibleSubset(const CompatibleSubsetOptions& options,
                   const uncertainty::PathUncertainty* paths);

  void Add(const LoopEvidence& loop);

  // Returns the decisions that can be made now, in the order of adding, those
  // that withdraw accepted loops first. Cheap
  // if nothing was added since the last call. After the end of a run further
  // loops may be added.
  std::vector<SubsetDecision> Decide(RunState state = RunState::kGoesOn);
  // Decides, then rejects everything undecided with its reason. Accepted
  // clusters are kept.
  std::vector<SubsetDecision> Flush();

  // Takes the score, the probability, the prior and what the neighbours say of an
  // undecided loop, known by its id, from `loop`, where they have become better
  // known.
  void UpdateEvidence(const LoopEvidence& loop);

  // The factor on the odds for a revisit that agrees where both were searched
  // far off: wrong ones agree as often as places look alike. At least
  // `odds_per_revisit` and at most kMostOddsPerFarRevisit are used.
  void SetOddsPerFarRevisit(double odds);

  // The share of wrong ones among the verified matches of the run, in [0, 1). The
  // more there are, the more often they agree with each other: places that look
  // alike follow one another.
  void SetShareWrong(double share_wrong);

  // Repeats all pairwise tests, after a change of the drift of the paths.
  void RelateAll();

  // Removes undecided loops, such as those of submaps or nodes that are
  // deleted; returns their ids in the order of adding.
  std::vector<int64_t> Remove(
      const std::function<bool(const LoopEvidence&)>& condition);

  // Withdraws accepted loops, known by their ascending ids, and does not accept
  // them again. Returns the decisions in the order of their clusters.
  std::vector<SubsetDecision> Refute(const std::vector<int64_t>& ids);

  // Drops accepted loops that can no longer be withdrawn, such as those of
  // submaps that are deleted.
  void ForgetAcceptedLoops(
      const std::function<bool(const LoopEvidence&)>& condition);
  // The accepted loops that may still be withdrawn, ascending.
  std::vector<int64_t> AcceptedLoops() const;
  int num_accepted_loops() const { return num_accepted_loops_; }

  // Drops accepted revisits whose first loop fulfils the condition.
  void ForgetAccepted(
      const std::function<bool(const LoopEvidence&)>& condition);

  // The undecided loops with their reasons, as of the last `Decide`, in the
  // order of adding.
  std::vector<SubsetDecision> Undecided() const;
  int num_undecided() const;
  // Verified loops within one trajectory: accepted ones, and those that
  // contradict the subset or did so when they were rejected.
  int num_right() const { return num_right_; }
  int NumWrong() const;
  int num_clusters() const { return static_cast<int>(clusters_.size()); }
  // Number of accepted clusters outside the subset at the last `Decide`,
  // contradicted by later evidence.
  int num_overturned() const { return num_overturned_; }
  // Whether the last clique search was exact.
  bool exact() const { return exact_; }
  // Steps of all clique searches, MaxCliqueResult.
  int64_t num_clique_steps() const { return num_clique_steps_; }
  // Factor on the variances of long paths of a trajectory, as learnt at the last
  // `Decide`.
  double PathFactor(int trajectory_id) const;

 private:
  // That are kept in case they are withdrawn.
  static constexpr int kMostAcceptedLoops = 5000;
  // Of places of which a tenth look alike.
  static constexpr double kMostOddsPerFarRevisit = 10.;

  enum class Relation : char {
    kUntestable,  // no path between the loops
    kVague,       // closes, but is not informative
    kSupports,
    kSupportsFarOff,  // as both were searched in far more than it leaves open
    kContradicts,
  };
  static bool IsSupport(const Relation relation) {
    return relation == Relation::kSupports ||
           relation == Relation::kSupportsFarOff;
  }
  struct Cluster {
    LoopEvidence leader;
    std::vector<LoopEvidence> undecided;
    std::vector<LoopEvidence> accepted_loops;  // that may be withdrawn
    int num_loops = 0;                         // ever
    double best_score = 0.;
    double least_sigma = 0.;  // of its loops
    bool accepted = false;
    PathAgreement path;     // of the leader
    double path_odds = 1.;  // as odds, for the factor in force
    // Of the last `Solve`.
    bool in_subset = false;
    double path_share = 1.;  // ShareOfPath
    double support = 0.;
    double total_support = 0.;  // by all clusters
    double log_odds = 0.;       // that the support adds
    int contradictions = 0;
    double rival_support = -1.;  // of the strongest rival, -1 without one
  };

  // A cycle supports only if the sigma of its translation is at most this, metres.
  double InformativeSigma(double linear_window) const;
  Relation Relate(const LoopEvidence& u, const LoopEvidence& v) const;
  Relation RelationOf(const int i, const int j) const {
    return relations_[std::max(i, j)][std::min(i, j)];
  }
  bool SameRevisit(const LoopEvidence& u, const LoopEvidence& v) const;
  // Factor on the odds of a cluster that another one supports.
  double OddsPerRevisit(Relation relation) const;
  // Of how many likely clusters a cluster counts as support, in [0, 1].
  double ShareOfSupport(const Cluster& cluster, double odds_per_revisit) const;
  // How many clusters support one of them, all or those of the subset.
  // `log_odds`, unless null, receives by how much they raise its odds.
  double Support(int index, bool of_subset, double* log_odds) const;
  // Weight of a cluster in the clique, by the best score of its loops and its
  // path.
  double Weight(const Cluster& cluster) const;
  // How many revisits that agree are worth these odds.
  double AsRevisits(double odds) const;
  // Sets what the path says about the cluster, for the drift in force.
  void CompareWithPath(Cluster* cluster) const;
  // The share of its path that a cluster does not have in common with those that
  // support it, of the paths of all of them: 1 / n where n have the same one.
  double ShareOfPath(int index) const;
  // Returns whether a factor, and all relations with it, has changed.
  bool LearnPaths();
  void FindSubset();
  void FindSupport();
  void FindRivals();
  void Solve();
  bool MayAccept(const Cluster& cluster, SubsetReason* reason) const;
  // Whether a loop of an accepted cluster may be accepted itself.
  bool MayAcceptLoop(const Cluster& cluster, const LoopEvidence& loop) const;
  // Removes the loops that may be accepted from the undecided ones of an
  // accepted cluster and returns them.
  std::vector<LoopEvidence> TakeLikely(Cluster* cluster) const;
  // The same of the loops that are accepted at the end of a run, if nothing
  // contradicts the cluster. `num_right`: see NumRightFarOff.
  std::vector<LoopEvidence> TakeProbable(const absl::optional<int>& num_right,
                                         Cluster* cluster) const;
  // Of the clusters in a weak prior, how many were right. Empty if another one
  // was wrong, or the run goes on.
  absl::optional<int> NumRightFarOff(RunState state) const;
  // Whether a loop in a weak prior is accepted after so many right ones.
  bool IsSureFarOff(const Cluster& cluster, const LoopEvidence& loop,
                    int num_right) const;
  // Why the undecided loops of a cluster are not accepted.
  SubsetReason WhyNot(const Cluster& cluster) const;
  void Emit(const Cluster& cluster, const std::vector<LoopEvidence>& loops,
            bool accepted, SubsetReason reason,
            std::vector<SubsetDecision>* decisions) const;
  // Emits and keeps them.
  void Accept(const std::vector<LoopEvidence>& loops, SubsetReason reason,
              Cluster* cluster, std::vector<SubsetDecision>* decisions);
  // Makes loops that were accepted, and are no longer kept, undecided again.
  void WithdrawLoops(std::vector<LoopEvidence> loops, Cluster* cluster,
                     std::vector<SubsetDecision>* decisions);
  static int NumVerified(const std::vector<LoopEvidence>& loops);
  // Withdraws accepted clusters that contradict the subset.
  void Withdraw(std::vector<SubsetDecision>* decisions);
  // Forgets the oldest accepted loops beyond kMostAcceptedLoops.
  void BoundAcceptedLoops();
  void Erase(int index);
  void MakeRoom();

  const CompatibleSubsetOptions options_;
  const uncertainty::PathUncertainty* const paths_;
  std::vector<Cluster> clusters_;  // in the order of their leaders
  // relations_[i][j] for j < i.
  std::vector<std::vector<Relation>> relations_;
  std::vector<SubsetDecision> overflow_;  // decided by MakeRoom
  double share_wrong_ = 0.;
  std::map<int, double> path_factors_;  // by trajectory
  double odds_per_far_revisit_ = kMostOddsPerFarRevisit;
  bool changed_ = false;
  bool exact_ = true;
  int64_t num_clique_steps_ = 0;
  int subset_size_ = 0;
  int num_accepted_loops_ = 0;  // kept
  int num_right_ = 0;
  int num_wrong_ = 0;  // rejected
  int num_overturned_ = 0;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_COMPATIBLE_SUBSET_H_
