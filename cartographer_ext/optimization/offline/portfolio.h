// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The search used by `auto`: many solvers from many initial guesses, each
// solution polished by alternately deciding and solving; the lowest truncated
// cost wins. As a polish never raises that cost, the winner is never above any
// participating solver.
//
//   Quick   dcs, gm and acs from the given poses, none and huber where few
//           loops are wrong. Where these agree up to decisions near the gate,
//           no single decision can be improved, the rejected loops contradict
//           the map beyond its uncertainty and none of the largest groups of
//           them is right (as long as these can be tried), nor graduated
//           non-convexity finds another map (where that costs little), the
//           search of a large graph ends here: other starts end in the same
//           optimum. Not where they have agreed on a map that rejects most
//           loops, softer kernels have left it, and wrong loops are to be
//           expected in force in what these have found.
//   Starts  chained odometry, chordal relaxation, a spanning tree of short
//           paths and an incremental replay (R-iSAM) as starts of the same
//           kernels; graduated non-convexity.
//   Groups  where the rejected loops are within the uncertainty of the map or
//           the kernels disagree: growth by groups of loops (loop_growth.h),
//           and by certain ones and groups in turn (certain_growth.h), also from
//           other windings of what that has grown (windings.h), a
//           spanning tree over the loops in force, groups forced in one by one
//           (decision_moves.h), in turn with chordal relaxations of what is in
//           force, as long as that finds loops; then growth from the best
//           map, with and without the groups that it relies on. The last also
//           where the kernels agree on a small graph.
//
// From the best of these, non-convexity is graduated once more, with the loops
// near the map only: that finds what many decisions at once would gain, and
// does not fill the factor.
//
// A large graph is first solved with the loops that agree with others over
// short stretches, where those do not fill the factor; if the kernels agree
// from there and hardly any of these loops is rejected, the search ends.
//
// What is too large for the search by groups is compared, after the quick
// solvers, with a map from the supported loops, and where wrong ones among them
// spoil that, with a short replay (of epochs alone, each of a tenth of the poses
// so far), and where that does not lead there, with a whole one: where the quick
// solvers agree but reject loops that agree with each other, and where they do
// not agree. The search ends where the kernels agree from there, with each other
// or each with what it has found from the given poses, unless all cost far more than
// the best map: that they reject nearly all loops alike settles nothing. Where a
// search has lost nearly all loops that agree and none is certain, that by groups
// follows. A part of the path that a
// replay has lost (lost_part.h) is replayed with the rest held (part_replay.h).
// Where kernels from there do not agree, those from the best of them have to, and
// before, if that has lost a part, a narrower gate and groups forced in are tried
// until a map has lost none. Otherwise starts that lead to a folded map are given
// up after one kernel. With other information matrices the quick solvers alone are
// added to what is known.
//
// A graph of tens of thousands of poses is grown by the loops that are certain
// (certain_growth.h) and polished, and that is all. Where a smaller one has too
// many poses and loops for the search by groups, this takes its place.
//
// Solvers that keep all loops in their equations are used only where that is
// affordable; the fill caused by thousands of wrong loops is not.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_PORTFOLIO_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_PORTFOLIO_H_

#include <string>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/offline/loop_support.h"
#include "cartographer_ext/optimization/solvers/incremental_smoother.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Limits of the search.
struct PortfolioOptions {
  int max_iterations = 200;  // of one solution
  // Poses times loops of a graph that is called large below.
  double large_search = 1e8;
  SmootherOptions smoother;
};

// The search over solvers and initial guesses, see above. Not thread-safe.
class Portfolio {
 public:
  struct Member {
    std::string name;
    std::vector<Pose2> poses;
    double cost = 0.;  // truncated, after the polish
  };

  Portfolio(PoseGraph graph, const PortfolioOptions& options);

  // Adds poses found elsewhere.
  void Add(const std::string& name, std::vector<Pose2> poses);

  void Run();
  // The same from members of a search of the graph with other information
  // matrices. What keeps all loops in its equations has had its part there.
  void Continue(const std::vector<Member>& known);
  // Solves the best member with softer kernels, changes single decisions if
  // that lowers its cost, and solves to convergence.
  void Improve();
  // Takes over what the solvers of a search with other information matrices
  // have found by themselves: what costs less here than the best member becomes
  // one, and lowest_of_solvers() is that of both.
  void AddSolversOf(const Portfolio& other);

  const PoseGraph& graph() const { return graph_; }
  const std::vector<Member>& members() const { return members_; }
  const Member& best() const { return members_[best_]; }
  // What groups that were forced in and given up led to.
  const std::vector<Alternative>& alternatives() const { return alternatives_; }
  // The lowest truncated cost of a solver before any polish, from a start that
  // it would have alone.
  double lowest_of_solvers() const { return lowest_of_solvers_; }
  // Whether every solver has run from every initial guess, in the other search
  // of AddSolversOf(), too.
  bool ran_all_solvers() const { return ran_all_solvers_; }
  // Whether groups of loops were searched, too: no map was settled on.
  bool searched_groups() const { return !starts_alone_; }
  const std::vector<WhitenedEdge>& edges() const { return edges_; }
  RobustSolver* solver() { return &solver_; }
  int iterations() const { return iterations_; }
  bool converged() const { return converged_; }
  const LoopSupport& support();
  // Whether solutions with all loops in the equations are affordable.
  bool CanKeepAllLoops();
  // Poses times loops.
  double Size() const;

 private:
  // Poses of a graph on which each solution counts.
  static constexpr size_t kLargeGraph = 30000;
  // Gates up to which loops count where non-convexity is graduated from a map.
  static constexpr double kNear = 10.;
  static constexpr double kFar = 100.;
  // Loops that agree with one that is relied on without regard to the rest.
  static constexpr size_t kSupported = 2;
  // Share of rejected loops from which kernels that agree are doubted: where
  // more loops are wrong than right, a rough start may fold them all in the same
  // way.
  static constexpr double kMostlyWrong = 0.6;
  // Gates that a folded map costs more than the best: the loops that it loses.
  static constexpr double kFolded = 20.;
  // Share of the loops that others agree with which a folded map keeps at most.
  static constexpr double kHardlyAny = 0.1;
  // Kernels that have to agree.
  static constexpr size_t kQuickKernels = 3;
  // Multiplications of one factorisation that are worth it while the search is
  // open.
  static constexpr double kAffordableWork = 6e7;

  // Returns the first of the members that have to agree.
  size_t RunQuick();
  // Whether each of the kernels ends, from `first` on, where it has ended from
  // the given poses, up to a few loops near the gate.
  bool EndsAsFromGivenPoses(size_t first) const;
  // Whether each of them is a folded map compared with the best.
  bool AllAreFolded(size_t first) const;
  // Whether the quick members, from `first` on, agree with each other or, one by
  // one, with those from the given poses, and do not cost far more than the best.
  bool IsSettled(size_t first);
  // Whether they differ from the best in loops near the gate only.
  bool DecideAlike(size_t first) const;
  // How many wrong loops are to be expected in force in the best map.
  double WrongByChance();
  // How many of the rejected loops would fit into the best map if they led
  // anywhere in it: where that are many, so may other maps fit them.
  double FitsByChance() const;
  // Whether the best map keeps no more loops than would fit by chance.
  bool ExplainsNothing() const;
  // Whether hardly any of the loops that others agree with is in force.
  bool HasLostNearlyAll();
  // Whether one of the largest groups of rejected loops that agree with each
  // other, forced in, leads to a map that costs less; of all, or of those that lead
  // out of a part of the path.
  bool FindsLostGroup(const absl::optional<PartOfPath>& part);
  // The part of the path that the best map has lost.
  absl::optional<PartOfPath> LostPart() const;
  // Brings parts back that the best map has lost, as long as groups of rejected
  // loops that lead out of them lower the cost. Whether none is lost then.
  bool RecoversParts();
  // Whether graduated non-convexity, where it costs little, ends on another map
  // that costs less.
  bool GncFindsAnother();
  // Whether more loops that agree with each other are rejected than wrong ones
  // agree by chance.
  bool RejectsAGroup();
  // Whether, where a group of loops is rejected, a start from the supported
  // loops ends lower, or where these are no start, a replay, and nothing is
  // settled by it.
  bool OtherStartIsLower();
  // Whether the rejected loops lie beyond the uncertainty of the best map.
  bool RejectedContradict();
  void RunStarts(bool with_full_kernels);
  void RunGroups();
  // From the best, moves by growth.
  void Regrow();
  FlipOptions flip_options() const;
  void Count(const SolverSummary& summary);
  // A solver's own result.
  void NoteSolver(const std::vector<Pose2>& poses);
  void AddKernel(const std::string& start_name, KernelType type,
                 const std::vector<Pose2>& start);
  // Returns the first member, which kQuickKernels begin with.
  size_t AddKernels(const std::string& start_name,
                    const std::vector<Pose2>& start, bool with_full_kernels);
  void AddOtherKernels(const std::string& start_name,
                       const std::vector<Pose2>& start, bool with_full_kernels);
  // All, from a start that on a large graph is given up if it leads to a folded
  // map.
  void AddSolvers(const std::string& start_name,
                  const std::vector<Pose2>& start, bool with_full_kernels);
  // Those that keep all loops.
  void AddFullKernels(const std::string& start_name,
                      const std::vector<Pose2>& start);
  void AddGnc(const std::string& start_name, const std::vector<Pose2>& start);
  // The incremental replay itself; false where it is not possible.
  bool AddReplay(ReplayResult* replay);
  // The same by its epochs alone.
  bool AddShortReplay(ReplayResult* replay);
  // Parts that a replay has lost, replayed.
  void AddLostParts(ReplayResult* replay);
  void AddReplays();
  // From the best, kernels as wide as the gate.
  void Soften();
  // From the best, graduated non-convexity in which what is more than `reach`
  // gates off takes no part, so that it does not fill the factor.
  void Graduate(double reach);
  // From the best, groups forced in; false where none was kept.
  bool AddForced(const std::string& start_name, const ForceOptions& options);
  // False where no loop is certain.
  bool AddCertain();
  // 1 for the loops that several others agree with, and for odometry.
  std::vector<double> SupportedLoops();
  // Takes weight from loops that chained odometry contradicts, as far as it is
  // a chain.
  void DropContradicted(const std::vector<Pose2>& chained,
                        std::vector<double>* weights) const;
  // Of the loops with weight, the share that the best map keeps.
  double ShareInForce(const std::vector<double>& weights) const;
  // A chordal relaxation of the supported loops, once. If there are members, it
  // is solved for a few steps. False where it is not possible, where these loops
  // fill the factor, or where it leads to a folded map compared with the best.
  bool StartFromSupport(std::vector<double>* supported,
                        std::vector<Pose2>* start);
  // Whether the supported loops alone lead to a map that ends the search.
  bool SettleBySupport();
  // The same for the incremental replay: a short one, or else a whole one.
  bool SettleByReplay();
  // Whether kernels from a start settle the search, or those from the best of what
  // they lead to. If that has lost a part of the path, from a map that has lost none,
  // of what a narrower gate and groups forced in lead to.
  bool SettlesFrom(const std::string& start_name,
                   const std::vector<Pose2>& start);
  // Adds what a narrower gate leads to from the quick members, from `first` on, up to
  // the first map that has lost no part of the path.
  void Tighten(size_t first);
  // Growth by groups, and by certain loops and groups in turn.
  void AddGrowth();
  // A grown map, and what it leads to.
  void AddGrown(const std::string& name, std::vector<Pose2> poses);
  // Work of one factorisation with these edges and with all, in
  // multiplications.
  double WorkOf(const std::vector<double>& weights) const;
  double FullWork();
  int CountRejected() const;
  bool MostAreRejected() const {
    return CountRejected() > kMostlyWrong * num_loops_;
  }

  const PoseGraph graph_;
  const PortfolioOptions options_;
  std::vector<WhitenedEdge> edges_;
  RobustSolver solver_;
  size_t num_loops_ = 0;
  std::vector<Member> members_;
  size_t best_ = 0;
  double lowest_of_solvers_;
  std::vector<std::vector<Pose2>> results_of_solvers_;
  std::vector<Alternative> alternatives_;
  absl::optional<size_t> quick_;  // first member from the given poses
  absl::optional<double> full_work_;
  absl::optional<LoopSupport> support_;
  int iterations_ = 0;
  bool converged_ = true;
  bool continued_ = false;
  bool ran_full_kernels_ = false;
  bool ran_gnc_ = false;  // from the given poses
  bool ran_all_solvers_ = false;
  bool replayed_ = false;  // as a whole
  bool shortly_replayed_ = false;
  bool tried_support_ = false;
  bool starts_alone_ = true;  // from starts that no search has found
};

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_PORTFOLIO_H_
