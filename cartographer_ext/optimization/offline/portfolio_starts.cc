// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The parts of the search that start anew: incremental replays, other initial
// poses, and groups of loops.
#include <algorithm>
#include <utility>

#include "Eigen/Cholesky"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/optimization/offline/certain_growth.h"
#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/parts/lost_part.h"
#include "cartographer_ext/optimization/offline/parts/part_replay.h"
#include "cartographer_ext/optimization/offline/portfolio.h"
#include "cartographer_ext/optimization/offline/readmission.h"
#include "cartographer_ext/optimization/offline/starts/joined_trajectories.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Share of the supported loops that a map in which they agree keeps.
constexpr double kNearlyAll = 0.98;
// Of a solver that is near the optimum.
constexpr int kFewIterations = 15;
// chi2 of an odometry edge that the digits of a file leave.
constexpr double kRounding = 1e-3;
// Poses times loops up to which groups are forced in more than once: at the end
// of a replay, and from chordal relaxations.
constexpr double kMaxRepeatedWork = 2e6;
// Poses of an epoch of a short replay, up to ten times as many in all.
constexpr int kShortEpoch = 50;
// Poses times loops of a graph on which a move costs next to nothing.
constexpr double kCheapMoves = 5e5;
// Groups that are forced into a large graph, and the work after which no other one
// is: each may take ten seconds.
constexpr int kMaxTrialsOnLargeGraph = 4;
constexpr double kMaxWorkOfTrials = 5e9;
// How often growth by certain loops goes on where softer kernels open a fold.
constexpr int kMaxCertainRounds = 3;
// Rounds of the search by groups, as long as each finds a loop.
constexpr int kMaxGroupRounds = 4;

// Whether the poses differ from chained odometry by rounding only.
bool AreChained(const std::vector<WhitenedEdge>& edges,
                const std::vector<Pose2>& poses) {
  for (const WhitenedEdge& edge : edges) {
    if (!edge.is_loop &&
        !(Chi2(edge, poses[edge.from], poses[edge.to]) < kRounding)) {
      return false;
    }
  }
  return true;
}

}  // namespace

void Portfolio::AddSolversOf(const Portfolio& other) {
  for (const std::vector<Pose2>& poses : other.results_of_solvers_) {
    const double cost = TruncatedCost(edges_, poses);
    lowest_of_solvers_ = std::min(lowest_of_solvers_, cost);
    if (cost < best().cost) Add("noise", poses);
    results_of_solvers_.push_back(poses);
  }
  ran_all_solvers_ = ran_all_solvers_ && other.ran_all_solvers_;
}

bool Portfolio::AddReplay(ReplayResult* const replay) {
  if (!Replay(graph_, options_.smoother, replay).ok()) return false;
  replayed_ = true;
  NoteSolver(replay->poses);
  Add("r_isam", replay->poses);
  AddLostParts(replay);
  if (Size() <= kMaxRepeatedWork &&
      ReadmitGroups(graph_, &edges_, &solver_, replay)) {
    NoteSolver(replay->poses);
    Add("r_isam, readmitted", replay->poses);
  }
  return true;
}

bool Portfolio::AddShortReplay(ReplayResult* const replay) {
  // The batch at the end of an epoch weighs all of its loops anyway.
  SmootherOptions options = options_.smoother;
  options.max_loops_per_step = 0;
  options.epoch_poses = kShortEpoch;
  options.large_map = 10 * kShortEpoch;
  options.polish_at_end = false;
  if (!Replay(graph_, options, replay).ok()) return false;
  shortly_replayed_ = true;
  NoteSolver(replay->poses);
  Add("r_isam, short", replay->poses);
  replay->poses = members_.back().poses;
  AddLostParts(replay);
  return true;
}

void Portfolio::AddLostParts(ReplayResult* const replay) {
  if (!ReplayLostParts(graph_, options_.smoother, &solver_, replay)) return;
  NoteSolver(replay->poses);
  Add(absl::StrCat(members_.back().name, ", parts"), replay->poses);
}

std::vector<double> Portfolio::SupportedLoops() {
  std::vector<double> result(edges_.size(), 1.);
  for (size_t i = 0; i != edges_.size(); ++i) {
    if (!edges_[i].is_loop) continue;
    result[i] = support().agreeing[i].size() >= kSupported ? 1. : 0.;
  }
  return result;
}

void Portfolio::DropContradicted(const std::vector<Pose2>& chained,
                                 std::vector<double>* const weights) const {
  const std::vector<Eigen::Matrix3d> covariances =
      PredictAlongChain(graph_, edges_, chained);
  for (size_t i = 0; i != covariances.size(); ++i) {
    const WhitenedEdge& edge = edges_[i];
    if (!edge.is_loop || (*weights)[i] == 0.) continue;
    const Eigen::Vector3d residual =
        Residual(edge, chained[edge.from], chained[edge.to]);
    if (residual.dot(covariances[i].llt().solve(residual)) >= kChi2Gate) {
      (*weights)[i] = 0.;
    }
  }
}

bool Portfolio::StartFromSupport(std::vector<double>* const supported,
                                 std::vector<Pose2>* const start) {
  if (tried_support_) return false;
  tried_support_ = true;
  *supported = SupportedLoops();
  std::vector<Pose2> poses = ChainOdometry(graph_);
  // Wrong loops that agree with each other fill the factor, for the quick
  // solvers, too, and are many among few.
  if (Size() <= options_.large_search || WorkOf(*supported) > kAffordableWork) {
    DropContradicted(poses, supported);
    if (WorkOf(*supported) > kAffordableWork) return false;
  }
  if (!ChordalPoses(edges_, *supported, &poses)) return false;
  if (!members_.empty()) {
    // From a start without wrong loops few steps lead near the optimum, from one
    // with many nowhere.
    SolverOptions options;
    options.kernel = DefaultKernel(KernelType::kDcs);
    options.max_iterations = kFewIterations;
    Count(solver_.Solve(options, &poses));
    if (TruncatedCost(edges_, poses) > best().cost + kFolded * kChi2Gate) {
      return false;
    }
  }
  *start = std::move(poses);
  return true;
}

double Portfolio::ShareInForce(const std::vector<double>& weights) const {
  const std::vector<double> decisions =
      DecideLoops(edges_, best().poses, kChi2Gate);
  double loops = 0., in_force = 0.;
  for (size_t i = 0; i != edges_.size(); ++i) {
    if (!edges_[i].is_loop || weights[i] == 0.) continue;
    ++loops;
    in_force += decisions[i];
  }
  return loops == 0. ? 1. : in_force / loops;
}

bool Portfolio::SettleBySupport() {
  std::vector<double> supported;
  std::vector<Pose2> poses;
  // A replay lets few of the loops in that fill the factor.
  if (!StartFromSupport(&supported, &poses)) return SettleByReplay();
  const size_t first = AddKernels("supported, ", poses, false);
  return IsSettled(first) &&
         (EndsAsFromGivenPoses(first) || ShareInForce(supported) >= kNearlyAll);
}

bool Portfolio::SettleByReplay() {
  ReplayResult replay;
  if (!shortly_replayed_ && !replayed_ && AddShortReplay(&replay) &&
      SettlesFrom("r_isam, short, ", replay.poses)) {
    return true;
  }
  return !replayed_ && AddReplay(&replay) &&
         SettlesFrom("r_isam, ", replay.poses);
}

void Portfolio::Tighten(const size_t first) {
  for (size_t m = first; m != first + kQuickKernels; ++m) {
    std::vector<Pose2> poses = members_[m].poses;
    Count(PolishAdapted(kFullPolishRounds, &solver_, &poses, nullptr));
    Add(absl::StrCat(members_[m].name, ", tightened"), std::move(poses));
    if (!LostPart().has_value()) return;
  }
}

bool Portfolio::SettlesFrom(const std::string& start_name,
                            const std::vector<Pose2>& start) {
  const size_t first = AddKernels(start_name, start, false);
  if (IsSettled(first)) return true;
  if (LostPart().has_value()) {
    Tighten(first);
    Soften();
    if (!RecoversParts()) return false;
  }
  // One of them may have opened what the start has left folded.
  return IsSettled(AddKernels(absl::StrCat(best().name, ", "),
                              std::vector<Pose2>(best().poses), false));
}

absl::optional<PartOfPath> Portfolio::LostPart() const {
  return FindLostPart(edges_, DecideLoops(edges_, best().poses, kChi2Gate));
}

bool Portfolio::RecoversParts() {
  absl::optional<PartOfPath> part = LostPart();
  while (part.has_value() && FindsLostGroup(part)) {
    Improve();
    part = LostPart();
  }
  return !part.has_value();
}

void Portfolio::AddReplays() {
  ReplayResult replay;
  const bool again = replayed_;
  if (again || AddReplay(&replay)) {
    if (!again) AddKernel("r_isam, ", KernelType::kDcs, replay.poses);
    if (graph_.poses.size() > kLargeGraph) return;
    // The failures of a softer and of a harder epoch kernel differ.
    SmootherOptions softer = options_.smoother;
    softer.epoch_kernel.parameter *= 4.;
    if (Replay(graph_, softer, &replay).ok()) Add("r_isam, soft", replay.poses);
  } else if (JoinTrajectories(graph_, options_.smoother, &replay.poses)) {
    Add("joined", replay.poses);
    if (Size() <= kMaxGrowthWork &&
        GrowTrajectories(graph_, options_.smoother, support(), &replay.poses)) {
      Add("grown", replay.poses);
    }
  }
}

bool Portfolio::AddCertain() {
  std::vector<Pose2> poses = ChainOdometry(graph_);
  std::vector<double> weights;
  if (GrowCertainLoops(graph_, CertainGrowthOptions(), &solver_, &poses,
                       &weights) == 0) {
    return false;
  }
  Add("certain", std::move(poses));
  for (int round = 0; round != kMaxCertainRounds; ++round) {
    if (RejectedContradict()) return true;
    // Softer kernels open what it has left folded, and then other loops are
    // certain.
    const double before = best().cost;
    Soften();
    if (best().cost > before - kFolded * kChi2Gate) break;
    poses = best().poses;
    weights = DecideLoops(edges_, poses, kChi2Gate);
    GrowMoreCertainLoops(graph_, CertainGrowthOptions(), &solver_, &poses,
                         &weights);
    Add("certain", std::move(poses));
  }
  // Right groups may be kept out by one wrong loop.
  ForceOptions force;
  force.max_trials = kMaxTrialsOnLargeGraph;
  force.min_members = kSupported + 1;
  force.relax = false;  // two more factorisations a trial
  force.max_work = kMaxWorkOfTrials;
  AddForced("certain", force);
  return true;
}

void Portfolio::AddGrowth() {
  const std::vector<Pose2> chained = ChainOdometry(graph_);
  std::vector<Pose2> poses = chained;
  std::vector<double> weights;
  if (GrowLoops(support(), GrowthOptions(), &solver_, &poses, &weights)) {
    AddGrown("growth", std::move(poses));
  }
  poses = chained;
  if (GrowCertainLoopsAndGroups(graph_, support(), &solver_, &poses,
                                &weights)) {
    AddGrown("certain growth", std::move(poses));
  }
}

void Portfolio::AddGrown(const std::string& name, std::vector<Pose2> poses) {
  const size_t grown = members_.size();
  Add(name, poses);
  AddKernel(absl::StrCat(name, ", "), KernelType::kDcs, poses);
  // What has come in first may have wound the path the wrong way round.
  RegrowOptions windings;
  windings.windings_alone = true;
  poses = members_[grown].poses;
  if (RegrowGroups(support(), windings, &solver_, &poses, &alternatives_) > 0) {
    Add(absl::StrCat(name, ", wound"), std::move(poses));
  }
}

void Portfolio::AddSolvers(const std::string& start_name,
                           const std::vector<Pose2>& start,
                           const bool with_full_kernels) {
  AddKernel(start_name, KernelType::kDcs, start);
  if (Size() > kMaxGrowthWork &&
      members_.back().cost > best().cost + kFolded * kChi2Gate) {
    ran_all_solvers_ = false;
    return;
  }
  AddOtherKernels(start_name, start, with_full_kernels);
  AddGnc(start_name, start);
}

void Portfolio::RunStarts(const bool with_full_kernels) {
  if (with_full_kernels && !ran_full_kernels_) {
    AddFullKernels("", graph_.poses);
  }
  AddReplays();
  const std::vector<Pose2> chained = ChainOdometry(graph_);
  const bool same = AreChained(edges_, graph_.poses);
  if (!same) AddKernels("odometry, ", chained, with_full_kernels);
  if (!CanKeepAllLoops()) return;
  if (!ran_gnc_) AddGnc("", graph_.poses);
  if (!same) AddGnc("odometry, ", chained);
  if (continued_) return;
  std::vector<Pose2> chordal = chained;
  // R-iSAM alone readmits groups in larger graphs than here.
  ran_all_solvers_ = Size() <= kMaxRepeatedWork || Size() > kMaxGrowthWork;
  if (RobustChordalPoses(edges_, &chordal)) {
    AddSolvers("chordal, ", chordal, with_full_kernels);
  }
  AddSolvers("tree of all, ",
             SpanningTree(graph_, std::vector<double>(edges_.size(), 1.)),
             with_full_kernels);
}

void Portfolio::RunGroups() {
  starts_alone_ = false;
  AddGrowth();
  AddKernel("tree, ", KernelType::kGemanMcClure,
            SpanningTree(graph_, DecideLoops(edges_, best().poses, kChi2Gate)));
  const std::vector<double> supported = SupportedLoops();
  for (int round = 0; round != kMaxGroupRounds; ++round) {
    const double before = best().cost;
    const std::vector<double> in_force =
        DecideLoops(edges_, best().poses, kChi2Gate);
    for (const auto* const weights : {&in_force, &supported}) {
      std::vector<Pose2> poses = best().poses;
      if (!ChordalPoses(edges_, *weights, &poses)) continue;
      AddKernel("relaxed, ", KernelType::kDcs, poses);
      AddKernel("relaxed, ", KernelType::kAcs, poses);
      if (CanKeepAllLoops()) AddGnc("relaxed, ", poses);
    }
    ForceOptions force;
    force.relax = Size() <= kMaxRepeatedWork;
    AddForced(best().name, force);
    Graduate(kNear);
    Graduate(kFar);
    if (best().cost > before - kChi2Gate) break;
  }
  Regrow();
}

void Portfolio::Regrow() {
  std::vector<Pose2> poses = best().poses;
  RegrowOptions regrow;
  if (Size() < kCheapMoves) {
    regrow.max_near = 20;
    regrow.max_forced = 5;
    regrow.max_starts = 30;
    regrow.max_trials = 300;
  }
  if (RegrowGroups(support(), regrow, &solver_, &poses, &alternatives_) > 0) {
    Add(absl::StrCat(best().name, ", regrown"), std::move(poses));
  }
}

}  // namespace optimization
}  // namespace cartographer_ext
